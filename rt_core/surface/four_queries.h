// Four closest points at a time, for the queries that need no search.
#pragma once

#include <cstdint>

#include "rt_core/lanes.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

// Queries of a tool's points, together: most are over the triangle that was nearest a tick ago, or over its border, and
// its certificate (Triangle::clear_*) proves it. Unused ones at the end repeat another.
struct FourQueries {
  Vec3 p[4];
  std::int32_t warm_triangle[4] = {-1, -1, -1, -1};
};

// What was found of them: outside the body over their triangle, one of its edges or the triangle across that, with
// proof.
struct FourSettled {
  std::uint32_t settled = 0;             // which of them, as bits; of the others nothing is told
  std::uint32_t on_edge = 0, again = 0;  // measured across an edge, and on this side once more
  std::uint32_t edge[3] = {};
  std::int32_t triangle[4];
  Vec3x4 closest_w, normal_w;
  Double4 distance_m;
};

// The first `count` of them. On grasp_cylinder_5 a query takes 600 instructions alone, 250 here (2026-11-26).
FourSettled settle_four(const Model& model, const FourQueries& query, std::int32_t count) PALPATE_RT;

// Triangles looked at for one that is settled, as closest_surface_point() counts them.
inline std::int32_t looked_at(const FourSettled& four, std::uint32_t k) PALPATE_RT {
  return 1 + static_cast<std::int32_t>(four.on_edge >> k & 1) + static_cast<std::int32_t>(four.again >> k & 1);
}
// closest_surface_point() of it, to the bit.
inline SurfacePoint settled_point(const FourSettled& four, std::uint32_t k) PALPATE_RT {
  SurfacePoint point;
  point.closest_w = four.closest_w[k];
  point.normal_w = four.normal_w[k];
  point.signed_distance_m = point.lower_bound_m = four.distance_m[k];
  point.triangle = four.triangle[k];
  point.feature =
      static_cast<Feature>((four.edge[0] >> k & 1) + 2 * (four.edge[1] >> k & 1) + 3 * (four.edge[2] >> k & 1));
  point.looked = looked_at(four, k);
  point.found = true;
  return point;
}

}  // namespace palpate
