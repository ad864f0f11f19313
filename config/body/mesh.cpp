#include "config/body/mesh.h"

#include <algorithm>
#include <cmath>

#include "config/index.h"
#include "rt_core/model.h"

namespace palpate {

namespace {

// One side of a triangle: the edge's end vertices in increasing order, and where it comes from.
struct Side {
  std::int32_t low, high, triangle, corner;
};

std::vector<Side> sorted_sides(const SurfaceMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangle.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (std::int32_t k = 0; k < 3; ++k) {
      const std::int32_t a = mesh.triangle[t][at(k)], b = mesh.triangle[t][at((k + 1) % 3)];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), k});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.triangle < b.triangle;
  });
  return sides;
}

}  // namespace

std::vector<Corners> triangle_adjacency(const SurfaceMesh& mesh) {
  std::vector<Corners> adjacent(mesh.triangle.size(), Corners{-1, -1, -1});
  const std::vector<Side> sides = sorted_sides(mesh);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &a = sides[i], &b = sides[i + 1];
    if (a.low != b.low || a.high != b.high) continue;
    adjacent[at(a.triangle)][at(a.corner)] = b.triangle;
    adjacent[at(b.triangle)][at(b.corner)] = a.triangle;
    ++i;
  }
  return adjacent;
}

std::vector<Triangle> linked_triangles(const SurfaceMesh& mesh) {
  const std::vector<Corners> adjacent = triangle_adjacency(mesh);
  std::vector<Triangle> triangle(mesh.triangle.size());
  for (std::size_t t = 0; t < triangle.size(); ++t) {
    std::ranges::copy(mesh.triangle[t], triangle[t].vertex);
    std::ranges::copy(adjacent[t], triangle[t].adjacent);
  }
  return triangle;
}

Vec3 triangle_cross(const SurfaceMesh& mesh, std::size_t triangle) {
  const Corners& c = mesh.triangle[triangle];
  const Vec3 a = mesh.vertex_m[at(c[0])];
  return cross(mesh.vertex_m[at(c[1])] - a, mesh.vertex_m[at(c[2])] - a);
}

std::vector<Vec3> vertex_normals(const SurfaceMesh& mesh) {
  std::vector<Vec3> normal(mesh.vertex_m.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Vec3 n = unit_or(triangle_cross(mesh, t), {});
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t i = mesh.triangle[t][k];
      const Vec3 p = mesh.vertex_m[at(i)];
      const Vec3 u = mesh.vertex_m[at(mesh.triangle[t][(k + 1) % 3])] - p;
      const Vec3 v = mesh.vertex_m[at(mesh.triangle[t][(k + 2) % 3])] - p;
      normal[at(i)] += std::atan2(norm(cross(u, v)), dot(u, v)) * n;
    }
  }
  for (Vec3& n : normal) n = unit_or(n, {0, 1, 0});
  return normal;
}

double signed_volume_m3(const SurfaceMesh& mesh) {
  if (mesh.vertex_m.empty()) return 0;
  const Vec3 o = mesh.vertex_m[0];  // near the surface: less cancellation than the world origin
  double six_volume = 0;
  for (const Corners& c : mesh.triangle)
    six_volume += dot(mesh.vertex_m[at(c[0])] - o, cross(mesh.vertex_m[at(c[1])] - o, mesh.vertex_m[at(c[2])] - o));
  return six_volume / 6.0;
}

double surface_area_m2(const SurfaceMesh& mesh) {
  double twice_area = 0;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) twice_area += norm(triangle_cross(mesh, t));
  return 0.5 * twice_area;
}

Vec3 volume_centre_m(const SurfaceMesh& mesh) {
  const Bounds box = bounds_of(mesh);
  const Vec3 o = 0.5 * (box.lower_m + box.upper_m);
  double six_volume = 0;
  Vec3 moment;
  for (const Corners& c : mesh.triangle) {
    const Vec3 a = mesh.vertex_m[at(c[0])] - o, b = mesh.vertex_m[at(c[1])] - o, d = mesh.vertex_m[at(c[2])] - o;
    const double v = dot(a, cross(b, d));
    six_volume += v;
    moment += (v / 4.0) * (a + b + d);
  }
  const double size = box.largest_m();
  return std::abs(six_volume) > 1e-12 * size * size * size ? o + (1.0 / six_volume) * moment : o;
}

double Bounds::largest_m() const {
  const Vec3 s = size_m();
  return std::max({s.x, s.y, s.z});
}

Bounds bounds_of(const SurfaceMesh& mesh) { return bounds_of(mesh.vertex_m); }

Bounds bounds_of(std::span<const Vec3> point_m) {
  Bounds box;
  if (point_m.empty()) return box;
  box.lower_m = box.upper_m = point_m[0];
  for (const Vec3& p : point_m) {
    box.lower_m = {std::min(box.lower_m.x, p.x), std::min(box.lower_m.y, p.y), std::min(box.lower_m.z, p.z)};
    box.upper_m = {std::max(box.upper_m.x, p.x), std::max(box.upper_m.y, p.y), std::max(box.upper_m.z, p.z)};
  }
  return box;
}

std::int32_t component_count(const SurfaceMesh& mesh) {
  const std::vector<Corners> adjacent = triangle_adjacency(mesh);
  std::vector<char> seen(mesh.triangle.size(), 0);
  std::vector<std::int32_t> open;
  std::int32_t count = 0;
  for (std::size_t start = 0; start < seen.size(); ++start) {
    if (seen[start]) continue;
    ++count;
    seen[start] = 1;
    open.push_back(static_cast<std::int32_t>(start));
    while (!open.empty()) {
      const std::size_t t = at(open.back());
      open.pop_back();
      for (const std::int32_t other : adjacent[t])
        if (other >= 0 && !seen[at(other)]) {
          seen[at(other)] = 1;
          open.push_back(other);
        }
    }
  }
  return count;
}

void orient_mesh(SurfaceMesh& mesh) {
  const std::vector<Corners> adjacent = triangle_adjacency(mesh);
  const auto runs = [&](std::size_t t, std::int32_t from, std::int32_t to) {
    for (std::size_t k = 0; k < 3; ++k)
      if (mesh.triangle[t][k] == from && mesh.triangle[t][(k + 1) % 3] == to) return true;
    return false;
  };
  std::vector<char> seen(mesh.triangle.size(), 0);
  std::vector<std::size_t> open;
  for (std::size_t start = 0; start < seen.size(); ++start) {
    if (seen[start]) continue;
    seen[start] = 1;
    open.push_back(start);
    while (!open.empty()) {
      const std::size_t t = open.back();
      open.pop_back();
      for (const std::int32_t other : adjacent[t]) {
        if (other < 0 || seen[at(other)]) continue;
        seen[at(other)] = 1;
        // Neighbours agree when they run along the shared edge in opposite directions.
        for (std::size_t k = 0; k < 3; ++k)
          if (runs(at(other), mesh.triangle[t][k], mesh.triangle[t][(k + 1) % 3])) {
            std::swap(mesh.triangle[at(other)][1], mesh.triangle[at(other)][2]);
            break;
          }
        open.push_back(at(other));
      }
    }
  }
  if (signed_volume_m3(mesh) < 0)
    for (Corners& c : mesh.triangle) std::swap(c[1], c[2]);
}

}  // namespace palpate
