// Whether a surface goes through itself. Such a body has no inside to press: the sign of a depth, and with it the
// force, depends on which sheet is met first.
#pragma once

#include <cstdint>

#include "config/body/mesh.h"

namespace palpate {

struct SelfIntersections {
  std::int64_t pairs = 0;   // triangles that cross; counted up to kMostCounted
  std::int32_t first = -1;  // a triangle of the first such pair
  Vec3 where_m;             // a point of it
  bool complete = true;     // false: the budget of pairs was spent before every pair had been looked at
};

// Pairs of triangles looked at, at most: a million triangles of an ordinary surface take 2e7. A mesh that needs more
// (long slivers, each beside thousands of others) is reported as looked at in part.
inline constexpr std::int64_t kPairBudget = 400'000'000;
inline constexpr std::int64_t kMostCounted = 1000;

// Crossing of triangles that share no edge; a corner or edge that rests on a facet, and sheets that lie in one another,
// do not count.
SelfIntersections find_self_intersections(const SurfaceMesh& mesh, std::int64_t pair_budget = kPairBudget);

}  // namespace palpate
