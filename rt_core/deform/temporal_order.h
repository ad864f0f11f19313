// The order in which regions came into contact, and what earlier ones did to the anchors.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

inline bool is_in_contact(const Region& region) PALPATE_RT { return region.id != 0 && region.lost_ticks == 0; }

inline bool is_born_before(const Region& a, const Region& b) PALPATE_RT {
  return a.born_tick != b.born_tick ? a.born_tick < b.born_tick : a.id < b.id;
}

inline bool uses_temporal_order(const Model& model) PALPATE_RT {
  return model.params.coupling_law == static_cast<std::int32_t>(CouplingLaw::kTemporal);
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

// Where the anchors stand for the skeleton of region `slot`, relative to rest: moved by the regions born before it
// (CouplingLaw::kTemporal), or empty, meaning at rest. Uses `storage` and State::anchor_by_region.
inline std::span<const Vec3> earlier_displacements(const Model& model, const State& state, std::int32_t slot,
                                                   Vec3 (&storage)[kMaxAnchors]) PALPATE_RT {
  if (!uses_temporal_order(model)) return {};
  for (Vec3& sum : storage) sum = {};
  for (std::int32_t other = 0; other < kMaxRegions; ++other) {
    if (!is_in_contact(state.region[other]) || !is_born_before(state.region[other], state.region[slot])) continue;
    for (std::int32_t a = 0; a < kMaxAnchors; ++a) storage[a] += state.anchor_by_region[other][a];
  }
  return storage;
}

}  // namespace palpate
