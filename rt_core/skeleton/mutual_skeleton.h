// The skeleton of one contact among others: beams to the anchors and to the other contacts, as printed in Luo & Xiao
// 2006, section VI, for CouplingLaw::kMutualPaper.
#pragma once

#include <span>

#include "rt_core/skeleton/skeleton.h"
#include "rt_core/state.h"

namespace palpate {

// Which beam of the skeleton of slot[from] ends at slot[to]: after those to the anchors come the other contacts in the
// order of `slot`. from != to.
inline std::int32_t mutual_beam(const Model& model, std::int32_t from, std::int32_t to) PALPATE_RT {
  return static_cast<std::int32_t>(model.anchor.size()) + (to < from ? to : to - 1);
}

// Builds the skeleton of slot[from] and shares `force_on_body_w` by the model's law. The centres of the other regions
// are "fixed beam ends that do not move"; their beams have the anchors' section, which is one for a body. False as
// solve_skeleton, and where two contacts are so near that the law has no share for the beam between them.
// The model has at most kMaxMutualAnchors anchors (baker and image check see to it), `slot` at most kMaxRegions
// entries.
bool solve_mutual_skeleton(const Model& model, const State& state, std::span<const std::int32_t> slot,
                           std::int32_t from, Vec3 force_on_body_w, Skeleton& skeleton) PALPATE_RT;

}  // namespace palpate
