#include "sim_host/deformed_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "rt_core/deform/surface.h"
#include "rt_core/nodal/nodal.h"
#include "sim_host/imprint.h"

namespace palpate {

namespace {

using Corners = std::array<std::int32_t, 3>;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

// Angle-weighted vertex normals, as the rest surface's are (Baerentzen & Aanaes 2005).
std::vector<Vec3> mesh_normals(const std::vector<Vec3>& position, const std::vector<Corners>& triangles) {
  std::vector<Vec3> normal(position.size());
  for (const Corners& t : triangles) {
    const Vec3 p[3] = {position[at(t[0])], position[at(t[1])], position[at(t[2])]};
    const Vec3 n = unit_or(cross(p[1] - p[0], p[2] - p[0]), {});
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = unit_or(p[(k + 1) % 3] - p[k], {}), b = unit_or(p[(k + 2) % 3] - p[k], {});
      normal[at(t[k])] += std::acos(std::clamp(dot(a, b), -1.0, 1.0)) * n;
    }
  }
  for (Vec3& n : normal) n = unit_or(n, {0, 0, 1});
  return normal;
}

DeformedSurface rest_surface(const Model& model) {
  DeformedSurface surface;
  surface.rest_m.assign(model.vertex_m.begin(), model.vertex_m.end());
  for (const Triangle& t : model.triangle) surface.triangle.push_back({t.vertex[0], t.vertex[1], t.vertex[2]});
  return surface;
}

void finish_positions(DeformedSurface& surface) {
  surface.position_m.clear();
  for (std::size_t i = 0; i < surface.rest_m.size(); ++i) {
    surface.position_m.push_back(surface.rest_m[i] + surface.displacement_m[i]);
  }
}

// Fills the rest from rest_m, triangle and displacement_m.
void finish(DeformedSurface& surface) {
  finish_positions(surface);
  surface.normal = mesh_normals(surface.position_m, surface.triangle);
}

template <class Number>
std::vector<Vec3> response_m(const Model& model, const State& state, std::span<const Number> compliance) {
  std::vector<double> u(static_cast<std::size_t>(3 * model.sizes.n_vertex));
  for (std::int32_t i = 0; i < state.nodal.count; ++i) {
    const NodalContact& contact = state.nodal.contact[i];
    const double force[3] = {contact.force_w.x, contact.force_w.y, contact.force_w.z};
    for (std::size_t a = 0; a < 3; ++a) {
      if (force[a] == 0) continue;
      const Number* row = compliance.data() + (3 * at(contact.vertex) + a) * u.size();
      for (std::size_t k = 0; k < u.size(); ++k) u[k] += static_cast<double>(row[k]) * force[a];
    }
  }
  std::vector<Vec3> displacement;
  for (std::size_t v = 0; v < u.size(); v += 3) displacement.push_back({u[v], u[v + 1], u[v + 2]});
  return displacement;
}

// Displacement of the vertices of a finite-element body under its contact forces: u = C f.
std::vector<Vec3> nodal_displacement_m(const Model& model, const State& state) {
  return model.compliance_f64.empty() ? response_m(model, state, model.compliance_f32)
                                      : response_m(model, state, model.compliance_f64);
}

void displace(const Model& model, const State& state, DeformedSurface& surface) {
  if (is_nodal(model)) {
    surface.displacement_m = nodal_displacement_m(model, state);
    return;
  }
  ShapeField field;
  prepare_shape(model, state, field);
  for (std::size_t i = 0; i < surface.rest_m.size(); ++i) {
    const std::int32_t vertex = i < model.vertex_m.size() ? static_cast<std::int32_t>(i) : -1;
    surface.displacement_m.push_back(displacement_at(model, field, surface.rest_m[i], vertex));
  }
  if (static_cast<Articulation>(model.params.articulation) != Articulation::kHand) return;
  finish_positions(surface);
  imprint(model, state, surface.position_m);
  for (std::size_t i = 0; i < surface.rest_m.size(); ++i)
    surface.displacement_m[i] = surface.position_m[i] - surface.rest_m[i];
}

// Halves every edge; `normal` grows with the vertices.
void refine(DeformedSurface& surface, std::vector<Vec3>& normal) {
  constexpr double kCrease = 0.8;  // cosine of the normals' angle beyond which an edge stays straight
  constexpr double kRounding = 0.75;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [entry, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(surface.rest_m.size()));
    if (is_new) {
      const Vec3 p = 0.5 * (surface.rest_m[at(a)] + surface.rest_m[at(b)]), na = normal[at(a)], nb = normal[at(b)];
      const Vec3 lift = dot(surface.rest_m[at(a)] - p, na) * na + dot(surface.rest_m[at(b)] - p, nb) * nb;
      surface.rest_m.push_back(dot(na, nb) > kCrease ? p + (0.5 * kRounding) * lift : p);
      normal.push_back(unit_or(na + nb, na));
    }
    return entry->second;
  };
  std::vector<Corners> finer;
  finer.reserve(4 * surface.triangle.size());
  for (const auto& [a, b, c] : surface.triangle) {
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  surface.triangle = std::move(finer);
}

}  // namespace

DeformedSurface deformed_surface(const Model& model, std::vector<Vec3> displacement_m) {
  DeformedSurface surface = rest_surface(model);
  surface.displacement_m = std::move(displacement_m);
  finish(surface);
  return surface;
}

DeformedSurface deformed_surface(const Model& model, const State& state) {
  DeformedSurface surface = rest_surface(model);
  displace(model, state, surface);
  finish(surface);
  return surface;
}

DeformedSurface refined_surface(const Model& model, const State& state, std::size_t most_triangles) {
  DeformedSurface surface = rest_surface(model);
  std::vector<Vec3> normal(model.vertex_normal.begin(), model.vertex_normal.end());
  const bool everywhere =
      !is_nodal(model) && static_cast<ShapeLaw>(model.params.shape_law) != ShapeLaw::kDisplacementAngle;
  while (everywhere && 4 * surface.triangle.size() <= most_triangles) refine(surface, normal);
  displace(model, state, surface);
  finish(surface);
  // Rounded points are not quite smooth across the old edges. So only the turn of the normal by the deformation is
  // taken from the points, and the normal at rest from the interpolation, except at creases.
  const std::vector<Vec3> at_rest = mesh_normals(surface.rest_m, surface.triangle);
  for (std::size_t i = 0; i < normal.size(); ++i) {
    if (dot(normal[i], at_rest[i]) < 0.97) continue;
    surface.normal[i] = unit_or(normal[i] + surface.normal[i] - at_rest[i], surface.normal[i]);
  }
  return surface;
}

}  // namespace palpate
