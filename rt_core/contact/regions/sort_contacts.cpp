#include "rt_core/contact/regions/sort_contacts.h"

#include "rt_core/contact/regions/contact_order.h"

namespace palpate {

namespace {

Real size_of(Vec3 v) PALPATE_RT { return abs_of(v.x) + abs_of(v.y) + abs_of(v.z); }

// One sum that is NaN or beyond kHuge if any of its terms is.
bool usable(const State& state, const Contact& contact) PALPATE_RT {
  const std::int32_t slot = contact.region;
  if (slot < 0 || slot >= kMaxRegions || !is_in_contact(state.region[slot])) return false;
  const Real size = size_of(contact.position_w) + size_of(contact.normal_w) + abs_of(contact.weight);
  return contact.depth_m > 0 && contact.depth_m + size <= kHuge;
}

}  // namespace

void sort_contacts(const State& state, Scratch& scratch, SortedContacts& sorted) PALPATE_RT {
  const std::int32_t contacts = scratch.contact_count < kMaxContacts ? scratch.contact_count : kMaxContacts;
  std::int32_t region_of[kMaxContacts];
  std::int32_t count_in[kMaxRegions] = {};
  for (std::int32_t i = 0; i < contacts; ++i) {  // bound: kMaxContacts
    const bool use = usable(state, scratch.contact[i]);
    region_of[i] = use ? scratch.contact[i].region : -1;
    if (use) count_in[region_of[i]] += 1;
  }
  std::int32_t order[kMaxRegions];
  const std::int32_t in_contact = contact_order(state, order);
  sorted.region_count = 0;
  for (std::int32_t i = 0; i < in_contact; ++i) {  // bound: kMaxRegions
    if (count_in[order[i]] > 0) sorted.slot[sorted.region_count++] = order[i];
  }
  std::int32_t next_in[kMaxRegions] = {};
  std::int32_t first = 0;
  for (std::int32_t r = 0; r < sorted.region_count; ++r) {  // bound: kMaxRegions
    const std::int32_t slot = sorted.slot[r];
    sorted.contacts[r] = {scratch.contact, sorted.index + first, count_in[slot]};
    next_in[slot] = first;
    first += count_in[slot];
  }
  for (std::int32_t i = 0; i < contacts; ++i) {  // bound: kMaxContacts
    if (region_of[i] >= 0) sorted.index[next_in[region_of[i]]++] = i;
  }
}

}  // namespace palpate
