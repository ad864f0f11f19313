#include "sim_host/view/deformed_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "config/index.h"
#include "rt_core/contact/contact.h"
#include "sim_host/view/elastic_surface.h"
#include "sim_host/view/imprint.h"
#include "sim_host/view/surface_shape.h"

namespace palpate {

namespace {

using Corners = std::array<std::int32_t, 3>;
using TriangleNormals = std::array<Vec3, 3>;
using Ends = std::pair<std::int32_t, std::int32_t>;

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

// What pushes each vertex inward, over a third of the areas of its triangles.
std::vector<double> nodal_pressure_Pa(const Model& model, const State& state, const std::vector<Vec3>& normal) {
  std::vector<double> pressure(normal.size());
  for (std::int32_t i = 0; i < state.nodal.count; ++i) {
    const NodalContact& contact = state.nodal.contact[i];
    const std::size_t v = at(contact.vertex);
    const double inward_N = -dot(contact.force_w, normal[v]);
    pressure[v] += state.live.stiffness * std::max(inward_N, 0.0) / model.nodal_vertex[v].area_m2;
  }
  return pressure;
}

// Modes at the vertices, straight between them; the dents at every point. `rest_normal` may be empty: then they are
// made.
void add_dents(const std::vector<TipDent>& dents, DeformedSurface& surface, std::span<const Vec3> rest_normal) {
  surface.pressure_Pa.assign(surface.rest_m.size(), 0);
  if (dents.empty()) return;
  std::vector<Vec3> made;
  if (rest_normal.empty()) made = mesh_normals(surface.rest_m, surface.triangle);
  const std::span<const Vec3> normal = made.empty() ? rest_normal : made;
  for (std::size_t i = 0; i < surface.rest_m.size(); ++i) {
    for (const TipDent& dent : dents) {
      surface.displacement_m[i] += dent.at(surface.rest_m[i], normal[i]);
      surface.pressure_Pa[i] += dent.pressure_Pa(surface.rest_m[i], normal[i]);
    }
  }
}

void displace(const Model& model, const State& state, DeformedSurface& surface, std::span<const Ends> parents = {},
              std::span<const Vec3> rest_normal = {}) {
  if (method_of(model) == Method::kNodes) {
    surface.displacement_m = nodal_displacement_m(model, state);
    surface.pressure_Pa = nodal_pressure_Pa(model, state, mesh_normals(surface.rest_m, surface.triangle));
    return;
  }
  if (method_of(model) == Method::kElastic) {
    const ElasticShape shape = elastic_shape(model, state);
    surface.displacement_m = mode_displacement_m(model, shape);
    for (const auto& [a, b] : parents)
      surface.displacement_m.push_back(0.5 * (surface.displacement_m[at(a)] + surface.displacement_m[at(b)]));
    add_dents(shape.dent, surface, rest_normal);
    return;
  }
  ShapeField field;
  prepare_shape(model, state, field);
  for (std::size_t i = 0; i < surface.rest_m.size(); ++i) {
    const std::int32_t vertex = i < model.vertex_m.size() ? static_cast<std::int32_t>(i) : -1;
    surface.displacement_m.push_back(displacement_at(model, field, surface.rest_m[i], vertex));
    if (method_of(model) == Method::kTips) surface.pressure_Pa.push_back(pressure_at(field, surface.rest_m[i]));
  }
  if (model.params.articulation != Articulation::kHand) return;
  finish_positions(surface);
  imprint(model, state, surface.position_m);
  for (std::size_t i = 0; i < surface.rest_m.size(); ++i)
    surface.displacement_m[i] = surface.position_m[i] - surface.rest_m[i];
}

// Cosine of the angle between two triangles beyond which their common corner is a crease: 40 degrees.
constexpr double kCrease = 0.766;

std::vector<Vec3> face_normals(const std::vector<Vec3>& position, const std::vector<Corners>& triangles) {
  std::vector<Vec3> normal;
  for (const Corners& t : triangles) normal.push_back(face_normal(position, t));
  return normal;
}

// Per corner of every triangle the angle-weighted mean over the triangles around it that do not lie beyond a crease.
std::vector<TriangleNormals> smooth_normals(const std::vector<Vec3>& position, const std::vector<Corners>& triangles) {
  const std::vector<Vec3> face = face_normals(position, triangles);
  std::vector<std::vector<std::pair<std::size_t, double>>> around(position.size());  // triangle, its angle here
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = position[at(triangles[t][k])];
      const Vec3 a = unit_or(position[at(triangles[t][(k + 1) % 3])] - p, {});
      const Vec3 b = unit_or(position[at(triangles[t][(k + 2) % 3])] - p, {});
      around[at(triangles[t][k])].push_back({t, std::acos(std::clamp(dot(a, b), -1.0, 1.0))});
    }
  }
  std::vector<TriangleNormals> normal(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 sum;
      for (const auto& [other, angle] : around[at(triangles[t][k])])
        if (dot(face[other], face[t]) > kCrease) sum += angle * face[other];
      normal[t][k] = unit_or(sum, face[t]);
    }
  }
  return normal;
}

// An edge while it is halved: the new point, how far the rounding lifts it off the chord, and the normals that say so.
struct HalvedEdge {
  std::int32_t middle;
  Vec3 lift, low_normal, high_normal;
};

}  // namespace

Vec3 face_normal(const std::vector<Vec3>& position, const Corners& t) {
  return unit_or(cross(position[at(t[1])] - position[at(t[0])], position[at(t[2])] - position[at(t[0])]), {});
}

std::vector<Vec3> mesh_normals(const std::vector<Vec3>& position, const std::vector<Corners>& triangles) {
  std::vector<Vec3> normal(position.size());
  for (const Corners& t : triangles) {
    const Vec3 p[3] = {position[at(t[0])], position[at(t[1])], position[at(t[2])]};
    const Vec3 n = face_normal(position, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = unit_or(p[(k + 1) % 3] - p[k], {}), b = unit_or(p[(k + 2) % 3] - p[k], {});
      normal[at(t[k])] += std::acos(std::clamp(dot(a, b), -1.0, 1.0)) * n;
    }
  }
  for (Vec3& n : normal) n = unit_or(n, {0, 0, 1});
  return normal;
}

void refine(std::vector<Vec3>& point, std::vector<Corners>& triangle, std::vector<TriangleNormals>& corner,
            std::vector<Ends>& parents) {
  constexpr double kRounding = 0.5;  // exact for a circle to second order
  std::map<std::pair<std::int32_t, std::int32_t>, HalvedEdge> edges;
  const auto same = [](Vec3 a, Vec3 b) { return squared_norm(a - b) < 1e-6; };
  for (std::size_t t = 0; t < corner.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      std::int32_t a = triangle[t][k], b = triangle[t][next];
      Vec3 na = corner[t][k], nb = corner[t][next];
      if (b < a) std::swap(a, b), std::swap(na, nb);
      const Vec3 pa = point[at(a)], pb = point[at(b)], p = 0.5 * (pa + pb);
      const Vec3 lift = dot(pa - p, na) * na + dot(pb - p, nb) * nb;
      const auto [entry, is_new] =
          edges.try_emplace({a, b}, HalvedEdge{static_cast<std::int32_t>(point.size()), lift, na, nb});
      HalvedEdge& edge = entry->second;
      if (is_new) {
        point.push_back(p);
        parents.emplace_back(a, b);
      }
      // On a crease each side lifts by its own curvature: at a cylinder's rim the wall does and the lid does not.
      else if (!same(edge.low_normal, na) || !same(edge.high_normal, nb))
        edge.lift += lift;
    }
  }
  for (const auto& [ends, edge] : edges) point[at(edge.middle)] += (0.5 * kRounding) * edge.lift;
  std::vector<Corners> finer;
  std::vector<TriangleNormals> finer_normal;
  finer.reserve(4 * corner.size());
  finer_normal.reserve(4 * corner.size());
  for (std::size_t t = 0; t < corner.size(); ++t) {
    const auto [a, b, c] = triangle[t];
    const auto [na, nb, nc] = corner[t];
    const std::int32_t ab = edges.at(std::minmax(a, b)).middle, bc = edges.at(std::minmax(b, c)).middle,
                       ca = edges.at(std::minmax(c, a)).middle;
    const Vec3 nab = unit_or(na + nb, na), nbc = unit_or(nb + nc, nb), nca = unit_or(nc + na, nc);
    finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    finer_normal.insert(finer_normal.end(), {{na, nab, nca}, {nb, nbc, nab}, {nc, nca, nbc}, {nab, nbc, nca}});
  }
  triangle = std::move(finer);
  corner = std::move(finer_normal);
}

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

RefinedBody::RefinedBody(const Model& model, std::size_t most_triangles) : model_(model) {
  DeformedSurface surface = rest_surface(model);
  corner_normal_ = smooth_normals(surface.rest_m, surface.triangle);
  const bool everywhere =
      method_of(model) != Method::kNodes && model.params.shape_law != ShapeLaw::kDisplacementAnglePaper;
  for (; everywhere && 4 * surface.triangle.size() <= most_triangles; ++halvings_)
    refine(surface.rest_m, surface.triangle, corner_normal_, parents_);
  rest_m_ = std::move(surface.rest_m);
  triangle_ = std::move(surface.triangle);
  normal_ = mesh_normals(rest_m_, triangle_);
  face_normal_ = face_normals(rest_m_, triangle_);
}

// Rounded points are not quite smooth across the old edges, so only the turn is taken from the points, and the normal
// at rest from the interpolation.
void RefinedBody::turn_normals(DeformedSurface& surface) const {
  const std::vector<Vec3> face = face_normals(surface.position_m, surface.triangle);
  for (std::size_t t = 0; t < surface.corner_normal.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3& n = surface.corner_normal[t][k];
      const std::size_t vertex = at(surface.triangle[t][k]);
      n = turns_with_point(n, normal_[vertex])
              ? unit_or(n + surface.normal[vertex] - normal_[vertex], surface.normal[vertex])
              : rotate(rotation_between(face_normal_[t], face[t]), n);
    }
  }
}

DeformedSurface RefinedBody::shape(const State& state) const {
  DeformedSurface surface;
  surface.rest_m = rest_m_;
  surface.triangle = triangle_;
  displace(model_, state, surface, parents_, normal_);
  finish(surface);
  surface.corner_normal = corner_normal_;
  turn_normals(surface);
  return surface;
}

DeformedSurface refined_surface(const Model& model, const State& state, std::size_t most_triangles) {
  return RefinedBody(model, most_triangles).shape(state);
}

}  // namespace palpate
