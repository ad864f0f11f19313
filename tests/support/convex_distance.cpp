#include "tests/support/convex_distance.h"

#include "rt_core/surface/triangle.h"
#include "rt_core/tool/shapes.h"
#include "tests/support/simplex.h"

namespace palpate::test {

namespace {

// The bracket, relative to the distance, at which the search ends early.
constexpr Real kRelativeBracket = 1e-12;
// Cores nearer than this overlap as far as the search can tell.
constexpr Real kOverlap_m = 1e-12;

Vec3 triangle_support(const Vec3 (&t)[3], Vec3 direction) PALPATE_RT {
  const Real a = dot(t[0], direction), b = dot(t[1], direction), c = dot(t[2], direction);
  return a >= b && a >= c ? t[0] : b >= c ? t[1] : t[2];
}

SupportPoint support(const ToolPiece& piece, std::span<const Vec3> hull, const Vec3 (&t)[3],
                     Vec3 direction) PALPATE_RT {
  SupportPoint s;
  s.on_a = core_support(piece, hull, direction);
  s.on_b = triangle_support(t, -direction);
  s.difference = s.on_a - s.on_b;
  return s;
}

// GJK in the piece frame.
ConvexDistance search(const ToolPiece& piece, std::span<const Vec3> hull, const Vec3 (&t)[3]) PALPATE_RT {
  ConvexDistance result;
  Simplex simplex;
  simplex.point[0] = support(piece, hull, t, (1.0 / 3.0) * (t[0] + t[1] + t[2]));
  simplex.count = 1;
  reduce(simplex);
  for (result.iterations = 0; result.iterations < kClosestPointIterations; ++result.iterations) {
    const Vec3 v = simplex.nearest();
    const Real distance = norm(v);
    if (!(distance > kOverlap_m)) {
      result.overlap = true;
      break;
    }
    const SupportPoint w = support(piece, hull, t, -v);
    result.lower_bound_m = max_of(result.lower_bound_m, dot(v, w.difference) / distance);
    if (distance - result.lower_bound_m <= kRelativeBracket * distance || simplex.holds(w.difference)) break;
    Simplex next = simplex;
    next.point[next.count++] = w;
    if (reduce(next)) {
      result.overlap = true;
      break;
    }
    if (!(squared_norm(next.nearest()) < squared_norm(v))) break;  // rounding: no further progress
    simplex = next;
  }
  result.on_piece = simplex.on_a();
  result.on_triangle = simplex.on_b();
  result.distance_m = result.overlap ? 0.0 : norm(simplex.nearest());
  result.lower_bound_m = result.overlap ? 0.0 : min_of(result.lower_bound_m, result.distance_m);
  return result;
}

ConvexDistance point_to_triangle(const Vec3 (&t)[3]) PALPATE_RT {
  ConvexDistance result;
  result.on_triangle = closest_on_triangle({}, t[0], t[1], t[2]).point;
  result.distance_m = result.lower_bound_m = norm(result.on_triangle);
  result.overlap = !(result.distance_m > kOverlap_m);
  return result;
}

}  // namespace

ConvexDistance distance_piece_triangle(const Model& model, const ToolPiece& piece, const Pose& piece_pose,
                                       const Vec3 (&triangle)[3]) PALPATE_RT {
  ConvexDistance result;
  result.distance_m = result.lower_bound_m = kHuge;
  Vec3 local[3];
  for (int k = 0; k < 3; ++k) {  // bound: 3
    local[k] = inverse_transform(piece_pose, triangle[k]);
    if (!is_finite(local[k])) return result;
  }
  result = piece.shape == PieceShape::kSphere ? point_to_triangle(local) : search(piece, hull_of(model, piece), local);
  result.on_piece = transform(piece_pose, result.on_piece);
  result.on_triangle = transform(piece_pose, result.on_triangle);
  return result;
}

}  // namespace palpate::test
