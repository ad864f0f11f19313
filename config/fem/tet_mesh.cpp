#include "config/fem/tet_mesh.h"

#include <algorithm>
#include <map>
#include <utility>

#include "config/index.h"

namespace palpate {

namespace {

using EdgeKey = std::pair<std::int32_t, std::int32_t>;
EdgeKey key_of(std::int32_t a, std::int32_t b) { return {std::min(a, b), std::max(a, b)}; }

EdgeKey key_of(const Tet& tet, std::size_t edge) {
  return key_of(tet.node[at(kTetEdge[edge][0])], tet.node[at(kTetEdge[edge][1])]);
}

struct Face {
  Corners sorted;
  std::int32_t tet, face;
};

// Faces that belong to one element only, in the order of elements.
std::vector<Face> boundary_faces(const TetMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tet.size());
  for (std::size_t t = 0; t < mesh.tet.size(); ++t)
    for (std::size_t f = 0; f < 4; ++f) {
      Corners c;
      for (std::size_t k = 0; k < 3; ++k) c[k] = mesh.tet[t].node[at(kTetFace[f][k])];
      std::sort(c.begin(), c.end());
      faces.push_back({c, static_cast<std::int32_t>(t), static_cast<std::int32_t>(f)});
    }
  std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.sorted < b.sorted; });
  std::vector<Face> boundary;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].sorted == faces[i].sorted) ++end;
    if (end == i + 1) boundary.push_back(faces[i]);
    i = end;
  }
  std::sort(boundary.begin(), boundary.end(),
            [](const Face& a, const Face& b) { return std::pair(a.tet, a.face) < std::pair(b.tet, b.face); });
  return boundary;
}

// The flat triangles of one boundary face; `mid[k]` is the middle node of the side from corner k to corner k + 1.
void split_face(Corners corner, Corners mid, std::vector<Corners>& triangles) {
  const std::ptrdiff_t count = std::count_if(mid.begin(), mid.end(), [](std::int32_t m) { return m >= 0; });
  // Turn the face so that a lone middle node, or the first of two neighbouring ones, lies on side 0.
  const auto turn = [&] {
    std::rotate(corner.begin(), corner.begin() + 1, corner.end());
    std::rotate(mid.begin(), mid.begin() + 1, mid.end());
  };
  while ((count == 1 && mid[0] < 0) || (count == 2 && mid[2] >= 0)) turn();
  const auto [a, b, c] = corner;
  const auto [ab, bc, ca] = mid;
  switch (count) {
    case 0:
      triangles.push_back({a, b, c});
      break;
    case 1:
      triangles.push_back({a, ab, c});
      triangles.push_back({ab, b, c});
      break;
    case 2:
      triangles.push_back({ab, b, bc});
      triangles.push_back({a, ab, bc});
      triangles.push_back({a, bc, c});
      break;
    default:
      triangles.push_back({a, ab, ca});
      triangles.push_back({ab, b, bc});
      triangles.push_back({ca, bc, c});
      triangles.push_back({ab, bc, ca});
  }
}

}  // namespace

std::size_t tet_edge(std::size_t corner_a, std::size_t corner_b) {
  for (std::size_t e = 0; e < 6; ++e)
    if ((at(kTetEdge[e][0]) == corner_a && at(kTetEdge[e][1]) == corner_b) ||
        (at(kTetEdge[e][0]) == corner_b && at(kTetEdge[e][1]) == corner_a))
      return e;
  return 0;
}

bool Tet::is_quadratic() const {
  return std::all_of(node.begin() + 4, node.end(), [](std::int32_t i) { return i >= 0; });
}

double corner_volume_m3(const TetMesh& mesh, const Tet& tet) {
  const Vec3 o = mesh.node_m[at(tet.node[0])];
  const auto side = [&](std::size_t k) { return mesh.node_m[at(tet.node[k])] - o; };
  return dot(cross(side(1), side(2)), side(3)) / 6.0;
}

void add_middle_nodes(TetMesh& mesh, const std::vector<char>& wanted, const EdgeProjection& project) {
  std::map<EdgeKey, std::int32_t> middle;  // -1: to be made
  for (std::size_t t = 0; t < mesh.tet.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const std::int32_t existing = mesh.tet[t].node[4 + e];
      if (existing >= 0)
        middle[key_of(mesh.tet[t], e)] = existing;
      else if (wanted.empty() || wanted[t])
        middle.try_emplace(key_of(mesh.tet[t], e), -1);
    }
  std::map<EdgeKey, bool> on_boundary;
  if (project)
    for (const Face& f : boundary_faces(mesh))
      for (std::size_t k = 0; k < 3; ++k) on_boundary[key_of(f.sorted[k], f.sorted[(k + 1) % 3])] = true;
  for (auto& [edge, node] : middle) {
    if (node >= 0) continue;
    node = static_cast<std::int32_t>(mesh.node_m.size());
    const Vec3 chord_m = 0.5 * (mesh.node_m[at(edge.first)] + mesh.node_m[at(edge.second)]);
    mesh.node_m.push_back(on_boundary.contains(edge) ? project(chord_m, edge.first, edge.second) : chord_m);
  }
  for (Tet& tet : mesh.tet)
    for (std::size_t e = 0; e < 6; ++e)
      if (const auto found = middle.find(key_of(tet, e)); found != middle.end()) tet.node[4 + e] = found->second;
}

void keep_middle_nodes(TetMesh& mesh, const std::vector<char>& wanted) {
  std::vector<std::int32_t> number(mesh.node_m.size(), -1);
  for (std::size_t t = 0; t < mesh.tet.size(); ++t)
    for (std::size_t k = 0; k < (wanted[t] ? 10 : 4); ++k)
      if (mesh.tet[t].node[k] >= 0) number[at(mesh.tet[t].node[k])] = 0;
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<std::int32_t>(kept.size());
    kept.push_back(mesh.node_m[i]);
  }
  mesh.node_m = std::move(kept);
  for (Tet& tet : mesh.tet)
    for (std::int32_t& i : tet.node)
      if (i >= 0) i = number[at(i)];
}

std::vector<char> elements_near(const TetMesh& mesh, const std::function<bool(Vec3)>& inside, std::int32_t layers) {
  std::vector<char> node_in(mesh.node_m.size(), 0), element(mesh.tet.size(), 0);
  for (std::size_t i = 0; i < node_in.size(); ++i) node_in[i] = inside(mesh.node_m[i]);
  for (std::int32_t layer = 0; layer < std::max(1, layers); ++layer) {
    for (std::size_t t = 0; t < mesh.tet.size(); ++t)
      for (std::size_t k = 0; k < 4; ++k)
        if (node_in[at(mesh.tet[t].node[k])]) element[t] = 1;
    for (std::size_t t = 0; t < mesh.tet.size(); ++t)
      if (element[t])
        for (std::size_t k = 0; k < 4; ++k) node_in[at(mesh.tet[t].node[k])] = 1;
  }
  return element;
}

TetSurface surface_of(const TetMesh& mesh) {
  TetSurface surface;
  std::vector<Corners> triangles;
  for (const Face& f : boundary_faces(mesh)) {
    const Tet& tet = mesh.tet[at(f.tet)];
    Corners corner, mid;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = at(kTetFace[at(f.face)][k]), b = at(kTetFace[at(f.face)][(k + 1) % 3]);
      corner[k] = tet.node[a];
      mid[k] = tet.node[4 + tet_edge(a, b)];
    }
    split_face(corner, mid, triangles);
  }
  std::vector<std::int32_t> vertex(mesh.node_m.size(), -1);
  for (const Corners& c : triangles)
    for (const std::int32_t i : c) vertex[at(i)] = 0;
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    if (vertex[i] < 0) continue;
    vertex[i] = static_cast<std::int32_t>(surface.node.size());
    surface.node.push_back(static_cast<std::int32_t>(i));
    surface.mesh.vertex_m.push_back(mesh.node_m[i]);
  }
  for (Corners c : triangles) {
    for (std::int32_t& i : c) i = vertex[at(i)];
    surface.mesh.triangle.push_back(c);
  }
  return surface;
}

}  // namespace palpate
