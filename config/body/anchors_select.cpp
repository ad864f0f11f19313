// Choosing among anchor candidates: suppression, coverage, limits.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "config/body/anchors.h"

namespace palpate {

namespace {

double nearest_distance(const std::vector<AnchorPoint>& anchors, Vec3 p) {
  double nearest = kHuge;
  for (const AnchorPoint& a : anchors) nearest = std::min(nearest, norm(a.position_m - p));
  return nearest;
}

void sort_by_rank(std::vector<AnchorPoint>& anchors) {
  std::stable_sort(anchors.begin(), anchors.end(),
                   [](const AnchorPoint& a, const AnchorPoint& b) { return a.rank > b.rank; });
}

// Keeps, in order of rank, the candidates that are at least `apart_m` from every kept one.
std::vector<AnchorPoint> suppress(std::vector<AnchorPoint> candidates, double apart_m) {
  sort_by_rank(candidates);
  std::vector<AnchorPoint> kept;
  for (const AnchorPoint& c : candidates)
    if (nearest_distance(kept, c.position_m) >= apart_m) kept.push_back(c);
  return kept;
}

// Adds the vertex farthest from all anchors while it is farther than `reach_m`.
void cover(const SurfaceMesh& mesh, const std::vector<Vec3>& normal, double reach_m, std::size_t most,
           std::vector<AnchorPoint>& anchors) {
  std::vector<double> distance(mesh.vertex_m.size(), kHuge);
  std::size_t measured = 0;
  while (anchors.size() < most) {
    for (; measured < anchors.size(); ++measured)
      for (std::size_t i = 0; i < distance.size(); ++i)
        distance[i] = std::min(distance[i], norm(mesh.vertex_m[i] - anchors[measured].position_m));
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (!(*farthest > reach_m)) return;
    const auto i = static_cast<std::size_t>(farthest - distance.begin());
    anchors.push_back({mesh.vertex_m[i], normal[i], 0});
  }
}

}  // namespace

PrincipalExtents principal_extents(const SurfaceMesh& mesh) {
  PrincipalExtents e;
  // Weighted by area, so that the axes do not depend on where the mesh is fine.
  Vec3 sum;
  double area = 0;
  std::vector<Vec3> centre(mesh.triangle.size());
  std::vector<double> weight(mesh.triangle.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Corners& c = mesh.triangle[t];
    centre[t] =
        (1.0 / 3) * (mesh.vertex_m[static_cast<std::size_t>(c[0])] + mesh.vertex_m[static_cast<std::size_t>(c[1])] +
                     mesh.vertex_m[static_cast<std::size_t>(c[2])]);
    weight[t] = norm(triangle_cross(mesh, t));
    sum += weight[t] * centre[t];
    area += weight[t];
  }
  e.centre_m = (1.0 / area) * sum;
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t < centre.size(); ++t) {
    const Vec3 d = centre[t] - e.centre_m;
    const Eigen::Vector3d v(d.x, d.y, d.z);
    moment += weight[t] * v * v.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d v = solver.eigenvectors().col(2 - k);  // largest first
    Vec3 axis{v.x(), v.y(), v.z()};
    const double largest = std::abs(axis.x) >= std::abs(axis.y) && std::abs(axis.x) >= std::abs(axis.z) ? axis.x
                           : std::abs(axis.y) >= std::abs(axis.z)                                       ? axis.y
                                                                                                        : axis.z;
    if (largest < 0) axis = -axis;  // the solver's sign is arbitrary
    double low = kHuge, high = -kHuge;
    for (const Vec3& p : mesh.vertex_m) {
      low = std::min(low, dot(axis, p - e.centre_m));
      high = std::max(high, dot(axis, p - e.centre_m));
    }
    e.axis[k] = axis;
    e.half_extent_m[k] = 0.5 * (high - low);
  }
  return e;
}

std::vector<AnchorPoint> mesh_anchors(const SurfaceMesh& mesh) {
  const PrincipalExtents extents = principal_extents(mesh);
  const std::vector<Vec3> normal = vertex_normals(mesh);
  const Features features = find_features(mesh, normal, extents.mean_m());
  std::vector<AnchorPoint> candidates = features.anchors;
  const std::vector<AnchorPoint> smooth = curvature_anchors(mesh, normal, features.on_feature, extents);
  candidates.insert(candidates.end(), smooth.begin(), smooth.end());
  std::vector<AnchorPoint> anchors = suppress(std::move(candidates), 0.3 * extents.mean_m());
  if (anchors.size() > static_cast<std::size_t>(kMaxAnchors)) anchors.resize(static_cast<std::size_t>(kMaxAnchors));
  cover(mesh, normal, kAnchorCoverage * extents.mean_m(), static_cast<std::size_t>(kMaxAnchors), anchors);
  return anchors;
}

void limit_anchors(const SurfaceMesh& mesh, std::int32_t fewest, std::int32_t most, std::vector<AnchorPoint>& anchors) {
  sort_by_rank(anchors);
  if (anchors.size() > static_cast<std::size_t>(most)) anchors.resize(static_cast<std::size_t>(most));
  if (anchors.size() >= static_cast<std::size_t>(fewest)) return;
  const PrincipalExtents extents = principal_extents(mesh);
  const std::vector<Vec3> normal = vertex_normals(mesh);
  for (const Vec3& axis : extents.axis)
    for (const double s : {1.0, -1.0}) {
      std::size_t best = 0;
      for (std::size_t i = 1; i < mesh.vertex_m.size(); ++i)
        if (s * dot(axis, mesh.vertex_m[i] - mesh.vertex_m[best]) > 0) best = i;
      if (anchors.size() < static_cast<std::size_t>(fewest) &&
          nearest_distance(anchors, mesh.vertex_m[best]) > 0.3 * extents.mean_m())
        anchors.push_back({mesh.vertex_m[best], normal[best], 0});
    }
  cover(mesh, normal, 0, static_cast<std::size_t>(fewest), anchors);
}

}  // namespace palpate
