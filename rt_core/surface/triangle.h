// Closest point of one triangle, with the feature it lies on.
#pragma once

#include <cstdint>

#include "rt_core/vec.h"

namespace palpate {

enum class Feature : std::int32_t {
  kFace = 0,
  kEdge0 = 1,  // edge (vertex 0, vertex 1)
  kEdge1 = 2,  // edge (vertex 1, vertex 2)
  kEdge2 = 3,  // edge (vertex 2, vertex 0)
  kVertex0 = 4,
  kVertex1 = 5,
  kVertex2 = 6,
};

struct TrianglePoint {
  Vec3 point;
  Feature feature = Feature::kFace;
  Real inset = 0;  // smallest barycentric weight of the feature's vertices: 0 at its border, 1/3 or 1/2 in its middle
};

// Closest point of triangle abc to p by Voronoi regions (Ericson 2005, section 5.1.5). A degenerate triangle gives a
// point of one of its edges: every division is guarded by the region test before it, where the divisor is positive.
inline TrianglePoint closest_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) PALPATE_RT {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Real d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {a, Feature::kVertex0, 0};
  const Vec3 bp = p - b;
  const Real d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {b, Feature::kVertex1, 0};
  const Real vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 - d3 > 0) {
    const Real t = d1 / (d1 - d3);
    return {a + t * ab, Feature::kEdge0, min_of(t, 1 - t)};
  }
  const Vec3 cp = p - c;
  const Real d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {c, Feature::kVertex2, 0};
  const Real vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 - d6 > 0) {
    const Real t = d2 / (d2 - d6);
    return {a + t * ac, Feature::kEdge2, min_of(t, 1 - t)};
  }
  const Real va = d3 * d6 - d5 * d4;
  const Real along = d4 - d3, back = d5 - d6;
  if (va <= 0 && along >= 0 && back >= 0 && along + back > 0) {
    const Real t = along / (along + back);
    return {b + t * (c - b), Feature::kEdge1, min_of(t, 1 - t)};
  }
  const Real sum = va + vb + vc;
  if (!(sum > 0)) return {a, Feature::kVertex0, 0};
  const Real scale = 1.0 / sum;
  return {a + (vb * scale) * ab + (vc * scale) * ac, Feature::kFace, scale * min_of(min_of(va, vb), vc)};
}

}  // namespace palpate
