#include "rt_core/force/sort_contacts.h"

namespace palpate {

namespace {

bool born_before(const Region& a, const Region& b) PALPATE_RT {
  return a.born_tick != b.born_tick ? a.born_tick < b.born_tick : a.id < b.id;
}

Real size_of(Vec3 v) PALPATE_RT { return abs_of(v.x) + abs_of(v.y) + abs_of(v.z); }

// One sum that is NaN or beyond kHuge if any of its terms is.
bool usable(const State& state, const Contact& contact) PALPATE_RT {
  const std::int32_t slot = contact.region;
  if (slot < 0 || slot >= kMaxRegions || state.region[slot].id == 0 || state.region[slot].lost_ticks != 0) return false;
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
  sorted.region_count = 0;
  for (std::int32_t s = 0; s < kMaxRegions; ++s) {  // insertion sort, bound: kMaxRegions^2 / 2
    if (count_in[s] == 0) continue;
    std::int32_t place = sorted.region_count++;
    for (; place > 0 && born_before(state.region[s], state.region[sorted.slot[place - 1]]); --place) {
      sorted.slot[place] = sorted.slot[place - 1];
    }
    sorted.slot[place] = s;
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
