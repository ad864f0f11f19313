// The paper's mutual contribution between contact regions.
#pragma once

#include <cstdint>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Force (N, world frame, on the tool's side) that region `from_slot` adds at region `to_slot`, through the skeleton
// (Luo & Xiao 2006, section VI): sum_a w_a(p_to) K_a K^-1 F_from, where K_a are the beams from the centre of `from` to
// the anchors, w_a the surface interpolation's weights at the centre of `to`, and F_from = normal_force_N * normal_w +
// friction_force_w, the force of the body on the tool.
//
// Sign: the same as F_from, because the weights sum to one: two regions pushed in side by side (equal normals) give a
// positive component along normal_w of `to`, hence more force on the tool there; opposed regions give a negative one.
// The caller adds only the component along normal_w of `to`, and clamps the normal force at zero.
//
// Reads centre_w, normal_w, normal_force_N and friction_force_w of both slots as they are at the call, and, with
// CouplingLaw::kTemporal, last tick's anchor_by_region of the regions born before `from` (its skeleton stands on
// anchors already displaced by them). Zero when from == to, when either slot is not in contact, when there is no
// skeleton or interpolation, or when the skeleton is degenerate. Not reciprocal: the law as a whole is not
// conservative. Bound: n_anchor beams and one n_rbf x n_anchor product.
Vec3 transferred_force_w(const Model& model, const State& state, std::int32_t from_slot,
                         std::int32_t to_slot) PALPATE_RT;

// The same for all pairs of regions slot[0..count), first born first: adds to added_N[i] the component along normal_w
// of slot[i] of what every later slot[j] carries over, in the order of j, bit for bit as transferred_force_w gives it.
// One skeleton and one set of weights per region instead of one per pair: with 15 regions 105 skeletons were 0.6
// million instructions. Bound: kMaxRegions skeletons and kMaxRegions^2 / 2 sums over the anchors.
void add_transferred_forces(const Model& model, const State& state, const std::int32_t* slot, std::int32_t count,
                            Real* added_N) PALPATE_RT;

}  // namespace palpate
