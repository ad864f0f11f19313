// Distance between the core of a tool piece and a triangle, by closed form where there is one and GJK otherwise: what
// the overlap test and the closed-form gaps of the core are checked against.
#pragma once

#include <cstdint>

#include "rt_core/model.h"

namespace palpate::test {

// Convex pairs here converge in fewer than 20.
inline constexpr std::int32_t kClosestPointIterations = 32;

struct ConvexDistance {
  double distance_m = 0;     // between the cores; 0 when they overlap
  double lower_bound_m = 0;  // proven: the true distance lies in [lower_bound_m, distance_m]
  Vec3 on_piece;             // nearest points, in the frame the triangle was given in
  Vec3 on_triangle;
  std::int32_t iterations = 0;
  bool overlap = false;
};

// Distance from the core of `piece` (frame `piece_pose`, its margin not included) to the triangle: subtract
// piece.margin_m for the gap of the rounded piece. Spheres are closed form; the others run GJK (Gilbert, Johnson &
// Keerthi 1988) for at most kClosestPointIterations steps, ended earlier once the bracket is below 1e-12 relative.
// Polyhedral cores end exactly; curved ones with a bracket below 1e-6 of the distance. A degenerate triangle (segment,
// point) is allowed; input that is not finite gives distance kHuge and no overlap.
ConvexDistance distance_piece_triangle(const Model& model, const ToolPiece& piece, const Pose& piece_pose,
                                       const Vec3 (&triangle)[3]) PALPATE_RT;

}  // namespace palpate::test
