// The checks of check_tet_mesh, from the cheapest to the one that needs all others to hold.
#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

#include "config/fem/tet_element.h"
#include "config/fem/tet_mesh.h"
#include "config/index.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

// Below this share of the longest edge cubed the rounding of the coordinates decides the sign of the volume, and the
// element's stiffness swamps that of its neighbours (condition number ~ 1/ratio^2).
constexpr double kFlatTet = 1e-9;
// A curved element whose Jacobian falls below this share of the straight one's is about to fold.
constexpr double kLeastJacobian = 0.02;

std::string text_of(Vec3 p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g) mm", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z);
  return text;
}

std::string tet_text(std::size_t t) { return "tetrahedron " + std::to_string(t); }

void check_numbers(const TetMesh& mesh, const std::string& label) {
  if (mesh.tet.empty() || mesh.node_m.empty()) throw ConfigError(label + ": the mesh holds no tetrahedra");
  for (std::size_t i = 0; i < mesh.node_m.size(); ++i)
    if (!is_finite(mesh.node_m[i]))
      throw ConfigError(label + ": node " + std::to_string(i) + " is not a finite number; export the mesh again");
  const auto count = static_cast<std::int32_t>(mesh.node_m.size());
  for (std::size_t t = 0; t < mesh.tet.size(); ++t)
    for (std::size_t k = 0; k < 10; ++k) {
      const std::int32_t i = mesh.tet[t].node[k];
      if (i >= count || (i < 0 && (k < 4 || i != -1)))
        throw ConfigError(label + ": " + tet_text(t) + " refers to node " + std::to_string(i) + "; allowed 0 to " +
                          std::to_string(count - 1));
    }
}

void check_nodes(const TetMesh& mesh, const std::string& label) {
  std::vector<char> used(mesh.node_m.size(), 0);
  for (const Tet& tet : mesh.tet)
    for (const std::int32_t i : tet.node)
      if (i >= 0) used[at(i)] = 1;
  if (const auto loose = std::count(used.begin(), used.end(), 0); loose > 0) {
    const auto first = static_cast<std::size_t>(std::find(used.begin(), used.end(), 0) - used.begin());
    throw ConfigError(label + ": " + std::to_string(loose) + " nodes belong to no tetrahedron, the first is node " +
                      std::to_string(first) + " at " + text_of(mesh.node_m[first]) + "; remove loose nodes");
  }
  // Coincident nodes: sorted along x, compared within the tolerance.
  Vec3 low = mesh.node_m[0], high = low;
  std::vector<std::int32_t> order(mesh.node_m.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = static_cast<std::int32_t>(i);
    const Vec3 p = mesh.node_m[i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const double near = 1e-9 * norm(high - low);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return std::pair(mesh.node_m[at(a)].x, a) < std::pair(mesh.node_m[at(b)].x, b);
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Vec3 a = mesh.node_m[at(order[i])], b = mesh.node_m[at(order[j])];
      if (b.x - a.x > near) break;
      if (norm(b - a) <= near)
        throw ConfigError(label + ": nodes " + std::to_string(std::min(order[i], order[j])) + " and " +
                          std::to_string(std::max(order[i], order[j])) + " lie in the same place, at " + text_of(a) +
                          "; merge coincident nodes, or the body falls apart there");
    }
}

double longest_edge_m(const TetMesh& mesh, const Tet& tet) {
  double longest = 0;
  for (const auto& e : kTetEdge)
    longest = std::max(longest, norm(mesh.node_m[at(tet.node[at(e[0])])] - mesh.node_m[at(tet.node[at(e[1])])]));
  return longest;
}

void check_volumes(const TetMesh& mesh, const std::string& label) {
  for (std::size_t t = 0; t < mesh.tet.size(); ++t) {
    const Tet& tet = mesh.tet[t];
    const double volume = corner_volume_m3(mesh, tet), edge = longest_edge_m(mesh, tet);
    const std::string where = ", at " + text_of(mesh.node_m[at(tet.node[0])]);
    if (!(volume > kFlatTet * edge * edge * edge)) {
      if (volume < -kFlatTet * edge * edge * edge)
        throw ConfigError(label + ": " + tet_text(t) + " is inverted (volume " + std::to_string(1e9 * volume) +
                          " mm3)" + where + "; exchange two of its corners, or mesh again");
      throw ConfigError(label + ": " + tet_text(t) + " has no volume" + where + "; remove slivers (gmsh: -optimize)");
    }
    if (!(least_jacobian_ratio(mesh, tet) > kLeastJacobian))
      throw ConfigError(label + ": " + tet_text(t) + " folds: a middle node lies too far from its edge" + where +
                        "; refine the curved surface or use straight edges");
  }
}

void check_middle_nodes(const TetMesh& mesh, const std::string& label) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middle;
  for (std::size_t t = 0; t < mesh.tet.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const std::int32_t a = mesh.tet[t].node[at(kTetEdge[e][0])], b = mesh.tet[t].node[at(kTetEdge[e][1])];
      const std::int32_t m = mesh.tet[t].node[4 + e];
      const auto [entry, fresh] = middle.try_emplace({std::min(a, b), std::max(a, b)}, m);
      if (!fresh && entry->second != m)
        throw ConfigError(label + ": " + tet_text(t) + " and a neighbour disagree about the middle node of the edge " +
                          std::to_string(a) + "-" + std::to_string(b) + ", at " + text_of(mesh.node_m[at(a)]) +
                          "; elements that share an edge must share its middle node");
    }
}

void check_faces(const TetMesh& mesh, const std::string& label) {
  std::map<Corners, std::pair<std::size_t, int>> owners;
  for (std::size_t t = 0; t < mesh.tet.size(); ++t)
    for (const auto& face : kTetFace) {
      Corners c;
      for (std::size_t k = 0; k < 3; ++k) c[k] = mesh.tet[t].node[at(face[k])];
      std::sort(c.begin(), c.end());
      const auto [entry, fresh] = owners.try_emplace(c, std::pair(t, 1));
      if (!fresh && ++entry->second.second > 2)
        throw ConfigError(label + ": " + tet_text(t) + " and " + tet_text(entry->second.first) +
                          " share a face with a third, at " + text_of(mesh.node_m[at(c[0])]) +
                          "; elements overlap: remove duplicates");
      if (!fresh) {
        // Two elements on the same side of their common face overlap; the same four corners twice is the usual case.
        std::array<std::int32_t, 4> a{}, b{};
        for (std::size_t k = 0; k < 4; ++k) {
          a[k] = mesh.tet[t].node[k];
          b[k] = mesh.tet[entry->second.first].node[k];
        }
        std::sort(a.begin(), a.end());
        std::sort(b.begin(), b.end());
        if (a == b)
          throw ConfigError(label + ": " + tet_text(t) + " repeats " + tet_text(entry->second.first) +
                            "; remove duplicates");
      }
    }
}

}  // namespace

void check_tet_mesh(const TetMesh& mesh, const std::string& label) {
  check_numbers(mesh, label);
  check_nodes(mesh, label);
  check_volumes(mesh, label);
  check_middle_nodes(mesh, label);
  check_faces(mesh, label);
  check_mesh(surface_of(mesh).mesh, label + ": boundary of the tetrahedra");
}

}  // namespace palpate
