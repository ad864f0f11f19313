// Feature edges of a mesh, the corners on them and points of closed feature loops.
#include <algorithm>
#include <cmath>

#include "config/body/anchors.h"
#include "config/index.h"

namespace palpate {

namespace {

using Neighbours = std::vector<std::vector<std::int32_t>>;  // along feature edges, per vertex

Neighbours feature_edges(const SurfaceMesh& mesh) {
  Neighbours along(mesh.vertex_m.size());
  const std::vector<Corners> adjacent = triangle_adjacency(mesh);
  const double cosine = std::cos(kCornerAngle_rad);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t other = adjacent[t][k];
      if (other <= static_cast<std::int32_t>(t)) continue;
      const Vec3 n = unit_or(triangle_cross(mesh, t), {}), m = unit_or(triangle_cross(mesh, at(other)), {});
      if (dot(n, m) >= cosine) continue;
      const std::int32_t a = mesh.triangle[t][k], b = mesh.triangle[t][(k + 1) % 3];
      along[at(a)].push_back(b);
      along[at(b)].push_back(a);
    }
  return along;
}

// Removes connected sets of feature edges shorter than `least_m` in all: vertex noise makes such crumbs, real edges of
// an object are long.
void drop_crumbs(const SurfaceMesh& mesh, double least_m, Neighbours& along) {
  std::vector<char> seen(along.size(), 0);
  for (std::size_t start = 0; start < along.size(); ++start) {
    if (seen[start] || along[start].empty()) continue;
    std::vector<std::size_t> members{start};
    seen[start] = 1;
    double length = 0;
    for (std::size_t i = 0; i < members.size(); ++i)
      for (const std::int32_t other : along[members[i]]) {
        length += 0.5 * norm(mesh.vertex_m[members[i]] - mesh.vertex_m[at(other)]);
        if (seen[at(other)]) continue;
        seen[at(other)] = 1;
        members.push_back(at(other));
      }
    if (length < least_m)
      for (const std::size_t i : members) along[i].clear();
  }
}

bool is_corner(const SurfaceMesh& mesh, const Neighbours& along, std::size_t i) {
  if (along[i].empty()) return false;
  if (along[i].size() != 2) return true;
  const Vec3 in = unit_or(mesh.vertex_m[i] - mesh.vertex_m[at(along[i][0])], {});
  const Vec3 out = unit_or(mesh.vertex_m[at(along[i][1])] - mesh.vertex_m[i], {});
  return dot(in, out) < std::cos(kCornerAngle_rad);
}

// Discrete curvature of a closed polyline at each vertex, averaged over its neighbours.
std::vector<double> loop_curvature(const SurfaceMesh& mesh, const std::vector<std::size_t>& loop) {
  const std::size_t n = loop.size();
  std::vector<double> k(n), smooth(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 u = mesh.vertex_m[loop[i]] - mesh.vertex_m[loop[(i + n - 1) % n]];
    const Vec3 v = mesh.vertex_m[loop[(i + 1) % n]] - mesh.vertex_m[loop[i]];
    k[i] = 2 * std::atan2(norm(cross(u, v)), dot(u, v)) / (norm(u) + norm(v));
  }
  for (std::size_t i = 0; i < n; ++i) smooth[i] = (k[(i + n - 1) % n] + 2 * k[i] + k[(i + 1) % n]) / 4;
  return smooth;
}

// Closed loop without corners: four equally spaced points when it is a circle, otherwise its curvature's extrema.
void add_loop(const SurfaceMesh& mesh, const std::vector<Vec3>& normal, const std::vector<std::size_t>& loop,
              std::vector<AnchorPoint>& anchors) {
  const std::size_t n = loop.size();
  const std::vector<double> k = loop_curvature(mesh, loop);
  double mean = 0;
  for (const double value : k) mean += value / static_cast<double>(n);
  double spread = 0;
  for (const double value : k) spread = std::max(spread, std::abs(value - mean));
  const auto push = [&](std::size_t i) { anchors.push_back({mesh.vertex_m[loop[i]], normal[loop[i]], kHuge}); };
  if (spread < 0.1 * mean) {
    std::size_t first = 0;  // the point farthest along x
    for (std::size_t i = 1; i < n; ++i)
      if (mesh.vertex_m[loop[i]].x > mesh.vertex_m[loop[first]].x) first = i;
    for (std::size_t quarter = 0; quarter < 4; ++quarter) push((first + quarter * n / 4) % n);
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double before = k[(i + n - 1) % n], after = k[(i + 1) % n];
    if ((k[i] > before && k[i] >= after) || (k[i] < before && k[i] <= after)) push(i);
  }
}

}  // namespace

Features find_features(const SurfaceMesh& mesh, const std::vector<Vec3>& normal, double mean_half_extent_m) {
  Neighbours along = feature_edges(mesh);
  drop_crumbs(mesh, mean_half_extent_m, along);
  // Corners everywhere on a fine mesh are roughness, not shape: then there are no features.
  std::size_t corners = 0;
  for (std::size_t i = 0; i < along.size(); ++i) corners += is_corner(mesh, along, i) ? 1U : 0U;
  if (along.size() > 500 && 20 * corners > along.size())
    for (auto& edges : along) edges.clear();
  Features features;
  features.on_feature.assign(mesh.vertex_m.size(), 0);
  std::vector<char> done(mesh.vertex_m.size(), 0);
  for (std::size_t i = 0; i < along.size(); ++i) {
    features.on_feature[i] = along[i].empty() ? 0 : 1;
    if (is_corner(mesh, along, i)) {
      features.anchors.push_back({mesh.vertex_m[i], normal[i], 2 * kHuge});  // above loop points
      done[i] = 1;
    }
  }
  // What is left are curves between corners, which need nothing, and closed loops.
  for (std::size_t start = 0; start < along.size(); ++start) {
    if (done[start] || along[start].empty()) continue;
    std::vector<std::size_t> loop;
    std::size_t i = start;
    bool closed = false;
    for (std::size_t previous = along.size();;) {
      done[i] = 1;
      loop.push_back(i);
      const std::size_t a = at(along[i][0]), b = at(along[i][1]);
      const std::size_t next = a == previous || (previous == along.size() && done[a]) ? b : a;
      if (next == start && loop.size() > 2) closed = true;
      if (done[next]) break;
      previous = i;
      i = next;
    }
    if (closed) add_loop(mesh, normal, loop, features.anchors);
  }
  return features;
}

}  // namespace palpate
