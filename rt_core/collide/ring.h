// The triangles around one triangle, walked by adjacency.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/model.h"

namespace palpate {

// Triangles around one vertex that a walk visits at most; meshes with more there are searched through the hierarchy.
inline constexpr std::int32_t kMaxFan = 24;

// Calls visit(index) for every triangle reached by turning about the three vertices of `triangle`, itself left out (its
// edge neighbours are visited twice). False when the surface is open there or a fan has more than kMaxFan triangles:
// some were left out then. Bound: 3 kMaxFan.
template <class Visit>
inline bool for_each_in_ring(std::span<const Triangle> triangles, std::int32_t triangle, Visit&& visit) PALPATE_RT {
  for (int corner = 0; corner < 3; ++corner) {  // bound: 3
    const std::int32_t vertex = triangles[static_cast<std::size_t>(triangle)].vertex[corner];
    std::int32_t at = triangle;
    std::int32_t steps = 0;
    for (; steps < kMaxFan; ++steps) {  // bound: kMaxFan
      const Triangle& t = triangles[static_cast<std::size_t>(at)];
      at = t.vertex[0] == vertex ? t.adjacent[0] : t.vertex[1] == vertex ? t.adjacent[1] : t.adjacent[2];
      if (at < 0) return false;
      if (at == triangle) break;
      visit(at);
    }
    if (steps == kMaxFan) return false;
  }
  return true;
}

}  // namespace palpate
