// The order in which regions came into contact.
#pragma once

#include <cstdint>

#include "rt_core/state.h"

namespace palpate {

inline bool is_in_contact(const Region& region) PALPATE_RT { return region.id != 0 && region.lost_ticks == 0; }

inline bool is_born_before(const Region& a, const Region& b) PALPATE_RT {
  return a.born_tick != b.born_tick ? a.born_tick < b.born_tick : a.id < b.id;
}

// Slots of the regions in contact, first born first. Returns how many. Bound: kMaxRegions^2 / 2 comparisons.
inline std::int32_t contact_order(const State& state, std::int32_t (&order)[kMaxRegions]) PALPATE_RT {
  std::int32_t count = 0;
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) {
    if (!is_in_contact(state.region[slot])) continue;
    std::int32_t at = count++;
    for (; at > 0 && is_born_before(state.region[slot], state.region[order[at - 1]]); --at) order[at] = order[at - 1];
    order[at] = slot;
  }
  return count;
}

}  // namespace palpate
