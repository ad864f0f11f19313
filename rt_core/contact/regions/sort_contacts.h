// The tick's contacts by region, regions in the order they were born.
#pragma once

#include "rt_core/contact/points/region_load.h"
#include "rt_core/limits.h"
#include "rt_core/state.h"

namespace palpate {

struct SortedContacts {
  std::int32_t region_count = 0;
  std::int32_t slot[kMaxRegions];  // in State::region, by born_tick, then id
  RegionContacts contacts[kMaxRegions];
  std::int32_t index[kMaxContacts];  // what contacts[] point into
};

// Takes every contact whose numbers are finite and whose region exists and is in contact; the others are left out.
// Regions without such a contact are left out too. `sorted` points into itself and into `scratch`: do not copy it.
// Bound: contacts + regions^2 / 2.
void sort_contacts(const State& state, Scratch& scratch, SortedContacts& sorted) PALPATE_RT;

}  // namespace palpate
