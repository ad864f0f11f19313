#include "tests/support/simplex.h"

#include "rt_core/surface/triangle.h"

namespace palpate::test {

namespace {

Simplex subset(const Simplex& from, const std::int32_t* index, const Real* weight, std::int32_t count) PALPATE_RT {
  Simplex to;
  for (std::int32_t i = 0; i < count; ++i) {  // bound: 4; zero weights drop their point
    if (!(weight[i] > 0)) continue;
    to.point[to.count] = from.point[index[i]];
    to.weight[to.count] = weight[i];
    to.count += 1;
  }
  if (to.count == 0) {
    to.point[0] = from.point[index[0]];
    to.weight[0] = 1;
    to.count = 1;
  }
  return to;
}

Simplex nearest_on_segment(const Simplex& s, std::int32_t i, std::int32_t j) PALPATE_RT {
  const Vec3 a = s.point[i].difference, ab = s.point[j].difference - a;
  const Real length2 = squared_norm(ab);
  const Real t = length2 > 0 ? clamp_to(-dot(a, ab) / length2, 0, 1) : 0.0;
  const std::int32_t index[2] = {i, j};
  const Real weight[2] = {1 - t, t};
  return subset(s, index, weight, 2);
}

Simplex nearest_on_face(const Simplex& s, std::int32_t i, std::int32_t j, std::int32_t k) PALPATE_RT {
  const Vec3 a = s.point[i].difference, b = s.point[j].difference, c = s.point[k].difference;
  const std::int32_t index[3] = {i, j, k};
  switch (closest_on_triangle({}, a, b, c).feature) {
    case Feature::kVertex0: {
      const Real weight[3] = {1, 0, 0};
      return subset(s, index, weight, 3);
    }
    case Feature::kVertex1: {
      const Real weight[3] = {0, 1, 0};
      return subset(s, index, weight, 3);
    }
    case Feature::kVertex2: {
      const Real weight[3] = {0, 0, 1};
      return subset(s, index, weight, 3);
    }
    case Feature::kEdge0:
      return nearest_on_segment(s, i, j);
    case Feature::kEdge1:
      return nearest_on_segment(s, j, k);
    case Feature::kEdge2:
      return nearest_on_segment(s, k, i);
    case Feature::kFace:
      break;
  }
  // Barycentric coordinates of the origin's projection; a face region has a usable normal.
  const Vec3 n = cross(b - a, c - a);
  const Real n2 = squared_norm(n);
  if (!(n2 > 0)) return nearest_on_segment(s, i, j);
  const Real u = max_of(dot(cross(b, c), n) / n2, 0.0), v = max_of(dot(cross(c, a), n) / n2, 0.0);
  const Real weight[3] = {u, v, max_of(1 - u - v, 0.0)};
  return subset(s, index, weight, 3);
}

// The faces of a tetrahedron and, last, the corner opposite each.
constexpr std::int32_t kFace[4][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}};

// Sine of the angle between a face and the opposite corner below which a tetrahedron counts as flat.
constexpr Real kFlatSine = 1e-8;

bool reduce_tetrahedron(Simplex& s) PALPATE_RT {
  Simplex best;
  Real best_distance2 = -1;
  bool inside = true;
  for (const auto& f : kFace) {  // bound: 4
    const Vec3 a = s.point[f[0]].difference;
    const Vec3 n = cross(s.point[f[1]].difference - a, s.point[f[2]].difference - a);
    const Vec3 rise = s.point[f[3]].difference - a;
    const Real apex = dot(rise, n), origin = -dot(a, n);
    // Inside this face, unless the tetrahedron is so flat that rounding decides the side.
    const bool flat = !(apex * apex > kFlatSine * kFlatSine * squared_norm(n) * squared_norm(rise));
    if (!flat && apex * origin > 0) continue;
    inside = false;
    const Simplex candidate = nearest_on_face(s, f[0], f[1], f[2]);
    const Real distance2 = squared_norm(candidate.nearest());
    if (best_distance2 < 0 || distance2 < best_distance2) {
      best = candidate;
      best_distance2 = distance2;
    }
  }
  if (!inside) s = best;
  return inside;
}

}  // namespace

Vec3 Simplex::nearest() const PALPATE_RT {
  Vec3 sum{};
  for (std::int32_t i = 0; i < count; ++i) sum += weight[i] * point[i].difference;  // bound: 4
  return sum;
}
Vec3 Simplex::on_a() const PALPATE_RT {
  Vec3 sum{};
  for (std::int32_t i = 0; i < count; ++i) sum += weight[i] * point[i].on_a;  // bound: 4
  return sum;
}
Vec3 Simplex::on_b() const PALPATE_RT {
  Vec3 sum{};
  for (std::int32_t i = 0; i < count; ++i) sum += weight[i] * point[i].on_b;  // bound: 4
  return sum;
}
bool Simplex::holds(Vec3 difference) const PALPATE_RT {
  for (std::int32_t i = 0; i < count; ++i) {  // bound: 4
    if (point[i].difference == difference) return true;
  }
  return false;
}

bool reduce(Simplex& simplex) PALPATE_RT {
  switch (simplex.count) {
    case 1:
      simplex.weight[0] = 1;
      return false;
    case 2:
      simplex = nearest_on_segment(simplex, 0, 1);
      return false;
    case 3:
      simplex = nearest_on_face(simplex, 0, 1, 2);
      return false;
    default:
      return reduce_tetrahedron(simplex);
  }
}

}  // namespace palpate::test
