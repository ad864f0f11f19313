// The triangles around one triangle, walked by adjacency.
#pragma once

#include <cstdint>

#include "rt_core/model.h"

namespace palpate {

// Triangles around one vertex that a walk visits at most; meshes with more there are searched through the hierarchy.
inline constexpr std::int32_t kMaxFan = 24;

// Which corner of a triangle a vertex of it is.
inline int corner_at(const Triangle& t, std::int32_t vertex) PALPATE_RT {
  return t.vertex[0] == vertex ? 0 : t.vertex[1] == vertex ? 1 : 2;
}

// Turns about one corner of `triangle` and calls visit(index, newest) for each triangle met, up to but without the one
// that closes the fan (which is the first of another corner's); `newest` is the vertex the turn reaches with it. False
// when the surface is open there or more than kMaxFan triangles meet. Bound: kMaxFan.
template <class Visit>
inline bool for_each_in_fan(const Triangle* triangles, std::int32_t triangle, int corner, Visit&& visit) PALPATE_RT {
  const std::int32_t vertex = triangles[triangle].vertex[corner];
  std::int32_t at = triangles[triangle].adjacent[corner];
  for (std::int32_t steps = 0; steps < kMaxFan; ++steps) {  // bound: kMaxFan
    if (at < 0) return false;
    const Triangle& t = triangles[at];
    const int k = corner_at(t, vertex);
    if (t.adjacent[k] == triangle) return true;
    visit(at, t.vertex[k == 2 ? 0 : k + 1]);
    at = t.adjacent[k];
  }
  return false;
}

// The same about all three corners: visits every triangle that shares a vertex with `triangle` once, itself left out,
// and as `newest` every vertex of that ring that is not a corner of `triangle`. Bound: 3 kMaxFan.
template <class Visit>
inline bool for_each_in_ring(const Triangle* triangles, std::int32_t triangle, Visit&& visit) PALPATE_RT {
  for (int corner = 0; corner < 3; ++corner) {  // bound: 3
    if (!for_each_in_fan(triangles, triangle, corner, visit)) return false;
  }
  return true;
}

}  // namespace palpate
