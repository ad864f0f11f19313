// The checks of check_mesh, from the cheapest to the one that needs all others to hold.
#include <algorithm>
#include <cstdio>

#include "config/body/mesh.h"
#include "config/index.h"
#include "config/scene/config_error.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

std::string text_of(Vec3 p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g) mm", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z);
  return text;
}

void check_elements(const SurfaceMesh& mesh, const std::string& label) {
  if (mesh.vertex_m.empty() || mesh.triangle.empty())
    throw ConfigError(label + ": the mesh is empty; it needs at least 4 triangles");
  for (std::size_t i = 0; i < mesh.vertex_m.size(); ++i)
    if (!is_finite(mesh.vertex_m[i]))
      throw ConfigError(label + ": vertex " + std::to_string(i) + " is not a finite number; export the mesh again");
  const auto count = static_cast<std::int32_t>(mesh.vertex_m.size());
  std::vector<char> used(mesh.vertex_m.size(), 0);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (const std::int32_t i : mesh.triangle[t]) {
      if (i < 0 || i >= count)
        throw ConfigError(label + ": triangle " + std::to_string(t) + " refers to vertex " + std::to_string(i) +
                          "; allowed 0 to " + std::to_string(count - 1));
      used[at(i)] = 1;
    }
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!used[i])
      throw ConfigError(label + ": vertex " + std::to_string(i) + " belongs to no triangle; remove loose vertices");
}

void check_scale(const SurfaceMesh& mesh, const std::string& label) {
  const double size = bounds_of(mesh).largest_m();
  if (size >= kSmallestBody_m && size <= kLargestBody_m) return;
  char text[160];
  std::snprintf(text, sizeof text,
                ": the mesh is %.4g m across; allowed 0.001 to 10 m. Set body.scale (0.001 if the file is in mm)",
                size);
  throw ConfigError(label + text);
}

// Below 1e-14 of the squared size, rounding of the coordinates decides the direction of the normal.
void check_areas(const SurfaceMesh& mesh, const std::string& label) {
  const double size = bounds_of(mesh).largest_m();
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    if (!(0.5 * norm(triangle_cross(mesh, t)) > 1e-14 * size * size))
      throw ConfigError(label + ": triangle " + std::to_string(t) + " has zero area, at " +
                        text_of(mesh.vertex_m[at(mesh.triangle[t][0])]) +
                        "; merge or delete degenerate faces in the modelling program");
}

struct Edge {
  std::int32_t low, high;
  bool forward;  // runs low -> high in its triangle
};

std::vector<Edge> sorted_edges(const SurfaceMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangle.size());
  for (const Corners& c : mesh.triangle)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = c[k], b = c[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.forward < b.forward;
  });
  return edges;
}

// Faults of one kind: how many edges, and where the first lies.
struct Faults {
  std::size_t count = 0;
  Vec3 where_m;
  void add(Vec3 p) {
    if (count++ == 0) where_m = p;
  }
  std::string text() const { return std::to_string(count) + " edge" + (count == 1 ? "" : "s"); }
};

void check_edges(const SurfaceMesh& mesh, const std::string& label) {
  const std::vector<Edge> edges = sorted_edges(mesh);
  Faults open, crowded, turned;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    const Vec3 middle = 0.5 * (mesh.vertex_m[at(edges[i].low)] + mesh.vertex_m[at(edges[i].high)]);
    if (end - i == 1) open.add(middle);
    if (end - i > 2) crowded.add(middle);
    if (end - i == 2 && edges[i].forward == edges[i + 1].forward) turned.add(middle);
    i = end;
  }
  if (crowded.count > 0)
    throw ConfigError(label + ": " + crowded.text() + " shared by more than two triangles, the first at " +
                      text_of(crowded.where_m) + "; the surface must be manifold");
  if (open.count > 0)
    throw ConfigError(label + ": the surface is open: " + open.text() + " on a boundary, the first at " +
                      text_of(open.where_m) + "; close the holes (the file may be truncated)");
  if (turned.count > 0)
    throw ConfigError(label + ": triangles disagree about which side is outside along " + turned.text() +
                      ", the first at " + text_of(turned.where_m) + "; set body.fix_orientation = true");
}

// A vertex where two sheets touch has more than one fan of triangles around it.
void check_fans(const SurfaceMesh& mesh, const std::string& label) {
  const std::vector<Corners> adjacent = triangle_adjacency(mesh);
  std::vector<std::int32_t> degree(mesh.vertex_m.size(), 0), first(mesh.vertex_m.size(), -1);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (const std::int32_t i : mesh.triangle[t]) {
      ++degree[at(i)];
      if (first[at(i)] < 0) first[at(i)] = static_cast<std::int32_t>(t);
    }
  for (std::size_t i = 0; i < degree.size(); ++i) {
    if (degree[i] > kMaxVertexTriangles)
      throw ConfigError(label + ": " + std::to_string(degree[i]) + " triangles meet in vertex " + std::to_string(i) +
                        ", at " + text_of(mesh.vertex_m[i]) + "; allowed " + std::to_string(kMaxVertexTriangles) +
                        ", as many as one tick's query may look at. Make them fewer, or put rings of larger triangles "
                        "around the vertex");
    std::int32_t t = first[i], steps = 0;
    do {
      const Corners& c = mesh.triangle[at(t)];
      const std::size_t k = at(c[0]) == i ? 0 : at(c[1]) == i ? 1 : 2;
      t = adjacent[at(t)][k];
      ++steps;
    } while (t != first[i] && steps <= degree[i]);
    if (steps != degree[i])
      throw ConfigError(label + ": two sheets of the surface touch at vertex " + std::to_string(i) + ", at " +
                        text_of(mesh.vertex_m[i]) + "; separate them");
  }
}

}  // namespace

void check_mesh(const SurfaceMesh& mesh, const std::string& label) {
  check_elements(mesh, label);
  check_scale(mesh, label);
  check_areas(mesh, label);
  check_edges(mesh, label);
  check_fans(mesh, label);
  if (const std::int32_t components = component_count(mesh); components != 1)
    throw ConfigError(label + ": the mesh has " + std::to_string(components) +
                      " separate pieces; allowed 1 (an inner shell counts as a piece). Keep one closed solid");
  const double size = bounds_of(mesh).largest_m();
  const double volume = signed_volume_m3(mesh);
  if (volume < 0)
    throw ConfigError(label + ": the mesh is inside out (volume " + std::to_string(1e6 * volume) +
                      " cm3); set body.fix_orientation = true");
  if (!(volume > 1e-9 * size * size * size))
    throw ConfigError(label + ": the mesh encloses no volume; it must be a solid");
}

}  // namespace palpate
