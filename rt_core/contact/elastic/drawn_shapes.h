// What is drawn of an elastic body under its tips beyond its soft modes: fields of the whole surface that finite
// elements gave for a press at any place, as sums of a few shapes. The tick reads none of it.
//   u(x) = sum_k shape_k(x) (F first_k(x0) + F^2 second_k(x0)),   F the force along the inward normal at x0;
// first: the answer to a unit press, narrowed to no width, less that of the soft modes and less that of half a space
// under the same press, near() of it; second: what F^2 adds, less what the soft modes have of it. The drawing adds half
// a space again, under the contact's own pressure (sim_host/view/elastic_surface.h). In the image five floats of every
// vertex for each shape: shape (no unit), first (m/N), second (m/N^2).
#pragma once

#include "rt_core/contact/elastic/elastic_layout.h"

namespace palpate::drawn_shapes {

inline std::int32_t count(const Model& model) { return static_cast<std::int32_t>(elastic_layout::drawn_count(model)); }
// Five floats of each shape.
inline const float* at(const Model& model, std::int32_t vertex) {
  const std::int64_t each = elastic_layout::kDrawnFloats * elastic_layout::drawn_count(model);
  return model.elastic_vertex.data() + elastic_layout::all_vertex_floats(model) + 1 + each * vertex;
}

// Of a vertex; `amplitude_m`: of every shape.
template <class Amplitudes>
Vec3 displacement_m(const Model& model, std::int32_t vertex, const Amplitudes& amplitude_m) {
  const float* of = at(model, vertex);
  Vec3 sum;
  for (const Real amplitude : amplitude_m) {
    sum += amplitude * Vec3{static_cast<Real>(of[0]), static_cast<Real>(of[1]), static_cast<Real>(of[2])};
    of += elastic_layout::kDrawnFloats;
  }
  return sum;
}

// How much of half a space is taken off and added again: all where the surface looks towards the press, nothing where
// it looks away, and less from half of `reach_m` on.
inline Real outlook(Vec3 normal, Vec3 inward) { return clamp_to(-2 * dot(normal, inward), 0.0, 1.0); }
inline Real near(Real distance_m, Real reach_m) {
  const Real s = clamp_to(2 * distance_m / reach_m - 1, 0.0, 1.0);
  return (1 - s) * (1 - s) * (1 + 2 * s);
}
// The body's longest way, by the box about its vertices at rest.
template <class Vertices>
Real reach_m(const Vertices& vertex_m) {
  Vec3 lower{kHuge, kHuge, kHuge}, upper{-kHuge, -kHuge, -kHuge};
  for (const Vec3& p : vertex_m) {
    lower = {min_of(lower.x, p.x), min_of(lower.y, p.y), min_of(lower.z, p.z)};
    upper = {max_of(upper.x, p.x), max_of(upper.y, p.y), max_of(upper.z, p.z)};
  }
  return norm(upper - lower);
}

}  // namespace palpate::drawn_shapes
