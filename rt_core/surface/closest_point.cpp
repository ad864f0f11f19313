#include "rt_core/surface/closest_point.h"

#include "rt_core/surface/candidate.h"
#include "rt_core/surface/descent.h"
#include "rt_core/surface/walk.h"

namespace palpate {

namespace {

constexpr double kUnlimited_m = 1e9;

Vec3 face_normal(const Model& model, std::int32_t triangle) PALPATE_RT {
  const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
  const Vec3 a = model.vertex_m[static_cast<std::size_t>(t.vertex[0])];
  const Vec3 b = model.vertex_m[static_cast<std::size_t>(t.vertex[1])];
  const Vec3 c = model.vertex_m[static_cast<std::size_t>(t.vertex[2])];
  return cross(b - a, c - a);
}

// Fills the answer from the nearest triangle; `outside` when the side is already known.
void report(const Model& model, Vec3 p, const Candidate& best, bool outside, SurfacePoint& result) PALPATE_RT {
  result.found = true;
  result.triangle = best.triangle;
  result.feature = best.at.feature;
  result.closest_w = best.at.point;
  const Vec3 offset = p - best.at.point;
  const double distance = square_root(best.distance2);
  if (outside) {
    result.signed_distance_m = distance;
    result.normal_w = (1.0 / distance) * offset;
    return;
  }
  const Vec3 pseudo = pseudo_normal(model, best.triangle, best.at.feature);
  const double side = dot(offset, pseudo) < 0 ? -1.0 : 1.0;
  result.signed_distance_m = side * distance;
  result.normal_w = distance > kDirectionFloor_m ? (side / distance) * offset : unit_or(pseudo, {0, 0, 1});
}

}  // namespace

Vec3 pseudo_normal(const Model& model, std::int32_t triangle, Feature feature) PALPATE_RT {
  const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
  const Vec3 face = face_normal(model, triangle);
  if (feature == Feature::kFace) return face;
  const auto code = static_cast<std::size_t>(feature);
  if (feature >= Feature::kVertex0) return model.vertex_normal[static_cast<std::size_t>(t.vertex[code - 4])];
  const std::int32_t other = t.adjacent[code - 1];
  const Vec3 unit = unit_or(face, {});
  return other < 0 ? unit : unit + unit_or(face_normal(model, other), {});
}

SurfacePoint closest_surface_point(const Model& model, Vec3 p, double search_radius_m,
                                   std::int32_t warm_triangle) PALPATE_RT {
  SurfacePoint result;
  if (!is_finite(p)) return result;
  Candidate best;
  const double radius = search_radius_m < kUnlimited_m ? max_of(search_radius_m, 0.0) : 2 * kHuge;
  best.distance2 = radius * radius;
  const Surface surface{model.triangle.data(), model.vertex_m.data()};
  const auto triangles = static_cast<std::int32_t>(model.triangle.size());
  Proof proof = Proof::kNone;
  if (warm_triangle >= 0 && warm_triangle < triangles && keep_nearer(surface, p, warm_triangle, best)) {
    proof = walk(surface, p, best);
  }
  if (proof == Proof::kNone && land(model, surface, p, best)) proof = walk(surface, p, best);
  if (proof == Proof::kNone) {
    const DescentResult descent = descend(model, surface, p, best);
    result.nodes = descent.nodes;
    result.stack_high_water = descent.stack_high_water;
    result.lower_bound_m = descent.lower_bound_m;
    result.truncated = descent.truncated;
  } else {
    result.lower_bound_m = square_root(best.distance2);
  }
  if (best.triangle != INT32_MAX) report(model, p, best, proof == Proof::kOutside, result);
  return result;
}

}  // namespace palpate
