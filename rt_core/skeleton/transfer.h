// The paper's mutual contribution between contact regions (Luo & Xiao 2006, section VI), read by
// CouplingLaw::kTemporal.
#pragma once

#include <cstdint>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// For the regions slot[0..count), first born first: adds to added_N[i] the component along normal_w of slot[i] of what
// every later slot[j] carries over to it through its skeleton: sum_a w_a(p_i) K_a K^-1 F_j, where K_a are the beams
// from the centre of j to the anchors, w_a the surface interpolation's weights at the centre of i, and
// F_j = normal_force_N * normal_w + friction_force_w, the force of the body on the tool. The skeleton of j stands on
// the anchors as the regions before it displaced them; baked beams stand on the anchors at rest.
//
// Sign: the same as F_j, because the weights sum to one: two regions pushed in side by side (equal normals) give a
// positive component, hence more force on the tool there; opposed regions give a negative one. The caller clamps the
// normal force at zero. Not reciprocal: the law as a whole is not conservative.
//
// Reads centre_w, normal_w, normal_force_N and friction_force_w of all slots as they are at the call. Nothing is added
// where there is no interpolation, or a number is not finite. False when some region's skeleton was degenerate: it
// carries nothing over. Bound: kMaxRegions skeletons and kMaxRegions^2 / 2 sums over the anchors.
bool add_transferred_forces(const Model& model, const State& state, const std::int32_t* slot, std::int32_t count,
                            Real* added_N) PALPATE_RT;

}  // namespace palpate
