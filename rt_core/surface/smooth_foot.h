// Foot of a point on the smooth surface that the facets approximate: continuous across edges, where the nearest facet
// point is not.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"
#include "rt_core/vec.h"

namespace palpate {

// Below this share of its value at the surface the projection's Jacobian counts as lost: (1 - t/R1)(1 - t/R2) at depth
// t under principal radii R1, R2, so 0.8 R under a cylinder. Beyond lies the focal surface, where a foot has no
// meaning.
inline constexpr Real kLeastJacobian = 0.2;

enum class FootState : std::int32_t {
  kFound = 0,
  kFocal = 1,  // below the focal surface, or not converged
  kEdge = 2,   // beyond a sharp edge
  kFar = 3,    // not within kFootWalk triangles
};

struct SmoothFoot {
  FootState state = FootState::kFocal;
  std::int32_t triangle = -1;
  Real weight[3] = {};     // area coordinates of the foot
  Vec3 gradient_per_m[3];  // of the area coordinates when the point moves
  Vec3 foot_w;             // on the smooth surface
  Vec3 normal_w;           // unit
  Real height_m = 0;       // of the point above the smooth surface, along normal_w; < 0 inside
  std::int32_t steps = 0;  // of the search
};

// With corners V_i, corner normals U_i and area coordinates n_i: the n_i and t with sum n_i V_i - t sum n_i U_i = p, by
// Newton's method from `triangle`, over neighbouring triangles but never across a sharp edge. The height is
// -(t |N| + sum n_i (V_i - X) . U_i / 2): the last term, half the sag of the facet under the smooth surface, removes
// the ripple of flat facets to second order (measured on a circle at a tenth of its radius, 7.5 degrees per edge: 2.3 %
// of the force without, 0.002 % with it).  Bound: kFootNewtonSteps steps, kFootWalk neighbours. Needs
// model.corner_normal.
SmoothFoot smooth_foot(const Model& model, Vec3 p, std::int32_t triangle) PALPATE_RT;

// Area coordinates of the point of a triangle's plane nearest to `at`, brought into [0, 1].
void facet_weights(const Model& model, std::int32_t triangle, Vec3 at, Real (&weight)[3]) PALPATE_RT;

}  // namespace palpate
