// Cutting edges of a surface: each triangle at the edge becomes two, so that the surface stays closed.
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "config/body/mesh.h"

namespace palpate {

using MeshEdge = std::pair<std::int32_t, std::int32_t>;  // corners, the lower first

inline std::map<MeshEdge, std::vector<std::size_t>> triangles_at_edges(const SurfaceMesh& mesh) {
  std::map<MeshEdge, std::vector<std::size_t>> sides;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      sides[std::minmax(mesh.triangle[t][k], mesh.triangle[t][(k + 1) % 3])].push_back(t);
  return sides;
}

// Puts a corner on the edge; `triangles` are all those at it.
inline void cut_edge(SurfaceMesh& mesh, MeshEdge edge, const std::vector<std::size_t>& triangles, Vec3 corner_m) {
  const auto middle = static_cast<std::int32_t>(mesh.vertex_m.size());
  mesh.vertex_m.push_back(corner_m);
  for (const std::size_t t : triangles) {
    Corners half = mesh.triangle[t];
    std::replace(half.begin(), half.end(), edge.first, middle);
    std::replace(mesh.triangle[t].begin(), mesh.triangle[t].end(), edge.second, middle);
    mesh.triangle.push_back(half);
  }
}

}  // namespace palpate
