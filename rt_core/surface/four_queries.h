// Four closest points at a time, for the queries that need no search.
#pragma once

#include <cstdint>

#include "rt_core/surface/closest_point.h"

namespace palpate {

// Queries of a tool's points, together: most are over the triangle that was nearest a tick ago, or over its border, and
// its certificate (Triangle::clear_*) proves it. Unused ones at the end repeat another.
struct FourQueries {
  Vec3 p[4];
  std::int32_t warm_triangle[4] = {-1, -1, -1, -1};
};

// closest_surface_point() of those of the first `count` that lie outside the body over their triangle or one of its
// edges, with proof; the same to the bit. `answer` as constructed. Returns which, as bits; the others are left. On
// grasp_cylinder_5 a query takes 600 instructions alone, 210 here (2026-11-26).
std::uint32_t settle_four(const Model& model, const FourQueries& query, std::int32_t count,
                          SurfacePoint (&answer)[4]) PALPATE_RT;

}  // namespace palpate
