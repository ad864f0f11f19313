#include "sim_host/deformed_surface.h"

#include <algorithm>
#include <cmath>

#include "rt_core/deform/surface.h"

namespace palpate {

namespace {

// Angle-weighted vertex normals of the moved triangles, as the rest surface's are (Baerentzen & Aanaes 2005).
std::vector<Vec3> moved_normals(const Model& model, const std::vector<Vec3>& position) {
  std::vector<Vec3> normal(position.size());
  for (const Triangle& t : model.triangle) {
    Vec3 p[3];
    for (int k = 0; k < 3; ++k) p[k] = position[static_cast<std::size_t>(t.vertex[k])];
    const Vec3 n = unit_or(cross(p[1] - p[0], p[2] - p[0]), {});
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = unit_or(p[(k + 1) % 3] - p[k], {}), b = unit_or(p[(k + 2) % 3] - p[k], {});
      normal[static_cast<std::size_t>(t.vertex[k])] += std::acos(std::clamp(dot(a, b), -1.0, 1.0)) * n;
    }
  }
  for (std::size_t i = 0; i < normal.size(); ++i) normal[i] = unit_or(normal[i], model.vertex_normal[i]);
  return normal;
}

}  // namespace

DeformedSurface deformed_surface(const Model& model, std::vector<Vec3> displacement_m) {
  DeformedSurface surface;
  surface.displacement_m = std::move(displacement_m);
  surface.position_m.reserve(model.vertex_m.size());
  for (std::size_t i = 0; i < model.vertex_m.size(); ++i) {
    surface.position_m.push_back(model.vertex_m[i] + surface.displacement_m[i]);
  }
  surface.normal = moved_normals(model, surface.position_m);
  return surface;
}

DeformedSurface deformed_surface(const Model& model, const State& state) {
  ShapeField field;
  prepare_shape(model, state, field);
  std::vector<Vec3> displacement;
  displacement.reserve(model.vertex_m.size());
  for (std::size_t i = 0; i < model.vertex_m.size(); ++i) {
    displacement.push_back(displacement_at(model, field, model.vertex_m[i], static_cast<std::int32_t>(i)));
  }
  return deformed_surface(model, std::move(displacement));
}

}  // namespace palpate
