// Small closed test surfaces, their hierarchy and a Model over them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "config/bake/bvh_build.h"
#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate::test {

struct Mesh {
  std::vector<Vec3> vertex;
  std::vector<Triangle> triangle;
};

// Owns what a Model's views point into.
struct Body {
  Mesh mesh;
  std::vector<Vec3> normal;
  BvhBuild bvh;
  std::vector<ToolPiece> piece;
  std::vector<ToolPoint> tool_point;
  std::vector<Vec3> hull;
  Model model;

  void bind() {
    model.vertex_m = mesh.vertex;
    model.vertex_normal = normal;
    model.triangle = bvh.triangle;
    model.bvh = bvh.node;
    model.piece = piece;
    model.tool_point = tool_point;
    model.hull_vertex_m = hull;
    model.params.surface_size_m = 0.1;
    model.params.cluster_distance_m = 5e-3;
    model.params.coupling_law = CouplingLaw::kCoupled;
  }
};

inline void link_adjacent(Mesh& mesh) {
  std::map<std::pair<int, int>, int> owner;
  const auto side = [](const Triangle& t, int k) { return std::pair{t.vertex[k], t.vertex[(k + 1) % 3]}; };
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (int k = 0; k < 3; ++k) owner[side(mesh.triangle[t], k)] = static_cast<int>(t);
  for (Triangle& t : mesh.triangle) {
    for (int k = 0; k < 3; ++k) {
      const auto it = owner.find({side(t, k).second, side(t, k).first});
      t.adjacent[k] = it == owner.end() ? -1 : it->second;
    }
  }
}

inline std::vector<Vec3> angle_weighted_normals(const Mesh& mesh) {
  std::vector<Vec3> sum(mesh.vertex.size());
  for (const Triangle& t : mesh.triangle) {
    const auto at = [&](int k) { return mesh.vertex[static_cast<std::size_t>(t.vertex[k % 3])]; };
    const Vec3 face = unit_or(cross(at(1) - at(0), at(2) - at(0)), {});
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = unit_or(at(k + 1) - at(k), {}), v = unit_or(at(k + 2) - at(k), {});
      sum[static_cast<std::size_t>(t.vertex[k])] += std::acos(clamp_to(dot(u, v), -1, 1)) * face;
    }
  }
  for (Vec3& n : sum) n = unit_or(n, {0, 0, 1});
  return sum;
}

// Octahedron with each face cut into n x n, pushed to the sphere and stretched: 8 n^2 triangles.
inline Mesh ellipsoid(Vec3 half, int n, Vec3 centre = {}) {
  Mesh mesh;
  std::map<std::array<int, 3>, int> index;  // keyed by integer lattice point, so seams are welded exactly
  const auto vertex = [&](std::array<int, 3> lattice) {
    const auto [it, added] = index.emplace(lattice, static_cast<int>(mesh.vertex.size()));
    if (added) {
      const Vec3 u = unit_or({double(lattice[0]), double(lattice[1]), double(lattice[2])}, {});
      mesh.vertex.push_back(centre + Vec3{half.x * u.x, half.y * u.y, half.z * u.z});
    }
    return it->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const int sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
    const bool flip = sx * sy * sz < 0;
    const auto add = [&](int a, int b, int c) {
      mesh.triangle.push_back({{a, flip ? c : b, flip ? b : c}, {-1, -1, -1}});
    };
    const auto at = [&](int i, int j) { return vertex({sx * (n - i - j), sy * i, sz * j}); };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        add(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < n) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  return mesh;
}

// Axis-aligned box, 12 triangles: every face diagonal is a flat edge, every corner a vertex shared by 3 to 6 triangles.
inline Mesh box(Vec3 half) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertex.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
  const int quad[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quad) {
    mesh.triangle.push_back({{q[0], q[1], q[2]}, {-1, -1, -1}});
    mesh.triangle.push_back({{q[0], q[2], q[3]}, {-1, -1, -1}});
  }
  return mesh;
}

// Torus about z: a non-convex body with saddle vertices. 2 nu nv triangles.
inline Mesh torus(double major, double minor, int nu, int nv) {
  Mesh mesh;
  constexpr double kTurn = 6.283185307179586;
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      const double u = kTurn * i / nu, v = kTurn * j / nv, r = major + minor * std::cos(v);
      mesh.vertex.push_back({r * std::cos(u), r * std::sin(u), minor * std::sin(v)});
    }
  }
  const auto at = [&](int i, int j) { return (i % nu) * nv + j % nv; };
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      mesh.triangle.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, {-1, -1, -1}});
      mesh.triangle.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, {-1, -1, -1}});
    }
  }
  return mesh;
}

inline Body make_body(Mesh mesh) {
  Body body;
  link_adjacent(mesh);
  body.mesh = std::move(mesh);
  body.normal = angle_weighted_normals(body.mesh);
  body.bvh = build_bvh(body.mesh.vertex, body.mesh.triangle);
  body.bind();
  return body;
}

inline Vec3 random_vec(std::mt19937_64& rng, double half) {
  std::uniform_real_distribution<double> u(-half, half);
  const double x = u(rng), y = u(rng), z = u(rng);
  return {x, y, z};
}
inline Vec3 random_unit(std::mt19937_64& rng) {
  for (;;) {
    const Vec3 v = random_vec(rng, 1);
    if (squared_norm(v) < 1 && squared_norm(v) > 1e-2) return unit_or(v, {});
  }
}
inline Quat random_rotation(std::mt19937_64& rng) {
  const Vec3 a = random_vec(rng, 1), b = random_vec(rng, 1);
  return normalised({a.x, a.y, a.z, b.x + 1e-3});
}

}  // namespace palpate::test
