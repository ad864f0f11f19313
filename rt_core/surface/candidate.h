// The nearest triangle a query has met so far, and how another is compared with it.
#pragma once

#include <cstdint>

#include "rt_core/model.h"
#include "rt_core/surface/triangle.h"

namespace palpate {

// The surface a query runs over, as plain pointers: the compiler need not reload them.
struct Surface {
  const Triangle* triangle;
  const Vec3* vertex;
};

// Starts as "nothing within the search radius".
struct Candidate {
  double distance2 = 0;
  std::int32_t triangle = INT32_MAX;
  TrianglePoint at;
  // Dismissal of triangles without measuring them: see raise_ceiling.
  Vec3 outward{};
  double ceiling = -1;
  std::int32_t shared[2] = {-1, -1};  // vertices of the edge or vertex the closest point lies on
  std::int32_t looked = 0;            // boxes and triangles looked at

  // Single-precision bound no admissible box may exceed: 2^-20 covers the rounding of box_distance2 and of this
  // conversion, the constant (0.1 nm squared) the rounding of the exact distances themselves for bodies up to 100 m.
  float bound() const PALPATE_RT { return static_cast<float>(distance2 * (1 + 0x1p-20) + 1e-20); }
};

// What rounding can do to a squared distance from a point of the surface: differences below this are ties.
inline double distance2_rounding(const Candidate& best) PALPATE_RT {
  const double distance = square_root(best.distance2);
  return 1e-14 * distance * (norm(best.at.point) + distance);
}

// Prepares dismissal by the plane through the closest point c of `best` with normal n = p - c: a triangle with no
// corner above it is no nearer than c, and on a convex surface that is every triangle but the nearest. The plane is
// raised by distance2_rounding, so that coplanar neighbours go too. A triangle can tie only by holding c: those that
// share its edge or vertex are always measured, and where c is so near the border of its feature that rounding could
// move it to the next one nothing is dismissed.
void raise_ceiling(const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT;

// Measures one triangle and keeps it when it is nearer, or as near with a lower index. Returns whether it was kept; the
// ceiling is then out of date.
inline bool keep_nearer(const Surface& surface, const Vec3& p, std::int32_t index, Candidate& best) PALPATE_RT {
  best.looked += 1;
  const Triangle& t = surface.triangle[index];
  const Vec3* vertex = surface.vertex;
  const TrianglePoint at = closest_on_triangle(p, vertex[t.vertex[0]], vertex[t.vertex[1]], vertex[t.vertex[2]]);
  const double distance2 = squared_norm(p - at.point);
  if (!(distance2 < best.distance2 || (distance2 == best.distance2 && index < best.triangle))) return false;
  best.distance2 = distance2;
  best.triangle = index;
  best.at = at;
  return true;
}

// As keep_nearer, keeping the ceiling up to date.
void measure(const Surface& surface, const Vec3& p, std::int32_t index, Candidate& best) PALPATE_RT;

inline bool has_vertex(const Triangle& t, std::int32_t v) PALPATE_RT {
  return (t.vertex[0] == v) | (t.vertex[1] == v) | (t.vertex[2] == v);
}

// Measures the triangle unless the ceiling dismisses it.
inline void consider(const Surface& surface, const Vec3& p, std::int32_t index, Candidate& best) PALPATE_RT {
  const Triangle& t = surface.triangle[index];
  const Vec3 n = best.outward;
  const double ceiling = best.ceiling;
  if (dot(surface.vertex[t.vertex[0]], n) <= ceiling && dot(surface.vertex[t.vertex[1]], n) <= ceiling &&
      dot(surface.vertex[t.vertex[2]], n) <= ceiling &&
      !(has_vertex(t, best.shared[0]) && has_vertex(t, best.shared[1]))) {
    best.looked += 1;
    return;
  }
  measure(surface, p, index, best);
}

// Descent of the surface hierarchy (descent.cpp).
struct DescentResult {
  std::int32_t nodes = 0;             // opened
  std::int32_t stack_high_water = 0;  // traversal stack entries used
  double lower_bound_m = 0;           // no surface point is nearer than this
  bool truncated = false;             // a cap was hit and a nearer triangle may have been missed
};

// Goes straight down to one leaf near p and measures it: a start for a walk. Returns whether `best` improved; its
// ceiling is out of date then. Bound: kMaxTraversalStack nodes.
bool land(const Model& model, const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT;

// Improves `best`, whose distance2 bounds the search and whose ceiling is up to date, until no triangle is nearer.
// Bound: `most` nodes of four children, as many triangles and one node's, kMaxTraversalStack pending nodes.
DescentResult descend(const Model& model, const Surface& surface, Vec3 p, std::int32_t most,
                      Candidate& best) PALPATE_RT;

}  // namespace palpate
