// What regions that came into contact earlier did to the anchors.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/contact/regions/contact_order.h"
#include "rt_core/model.h"

namespace palpate {

inline bool uses_temporal_order(const Model& model) PALPATE_RT {
  return model.params.coupling_law == static_cast<std::int32_t>(CouplingLaw::kTemporal);
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
