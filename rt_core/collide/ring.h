// The triangles around one triangle, walked by adjacency.
#pragma once

#include <cstdint>

#include "rt_core/model.h"

namespace palpate {

// Triangles around one vertex that a walk visits at most; meshes with more there are searched through the hierarchy.
inline constexpr std::int32_t kMaxFan = 24;

// Calls visit(index, newest) once for every triangle reached by turning about the three vertices of `triangle`, itself
// left out; `newest` is the vertex the turn reaches with that triangle, and over all calls every vertex of the ring
// that is not a corner of `triangle`. False when the surface is open there or a fan has more than kMaxFan triangles:
// some were left out then. Bound: 3 kMaxFan.
template <class Visit>
inline bool for_each_in_ring(const Triangle* triangles, std::int32_t triangle, Visit&& visit) PALPATE_RT {
  for (int corner = 0; corner < 3; ++corner) {  // bound: 3
    const std::int32_t vertex = triangles[triangle].vertex[corner];
    std::int32_t at = triangles[triangle].adjacent[corner];
    std::int32_t steps = 0;
    for (; steps < kMaxFan; ++steps) {  // bound: kMaxFan
      if (at < 0) return false;
      const Triangle& t = triangles[at];
      const int k = t.vertex[0] == vertex ? 0 : t.vertex[1] == vertex ? 1 : 2;
      if (t.adjacent[k] == triangle) break;  // the last of this fan is the first of another corner's
      visit(at, t.vertex[k == 2 ? 0 : k + 1]);
      at = t.adjacent[k];
    }
    if (steps == kMaxFan) return false;
  }
  return true;
}

}  // namespace palpate
