#include "config/bake/elastic_bed.h"

#include <Eigen/Core>
#include <algorithm>
#include <map>

namespace palpate {

namespace {

// Force per displacement and area at a point of the surface.
Eigen::Matrix3d stiffness_at(const ElasticBed& bed, const Eigen::Vector3d& normal) {
  if (bed.normal) return bed.stiffness_N_per_m3 * normal * normal.transpose();
  Eigen::Matrix3d k = Eigen::Matrix3d::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if ((bed.components >> axis & 1) != 0) k(axis, axis) = bed.stiffness_N_per_m3;
  return k;
}

}  // namespace

std::vector<fem::NodeSpring> bed_springs(const elastic::Surface<3>& surface, const std::vector<ElasticBed>& beds) {
  std::map<std::pair<int, int>, double> entry;
  for (const ElasticBed& bed : beds)
    for (const auto& point : surface.points()) {
      const std::vector<int>& nodes = surface.facets()[static_cast<std::size_t>(point.facet)].nodes;
      if (!std::ranges::all_of(nodes, [&](int n) { return bed.node[static_cast<std::size_t>(n)] != 0; })) continue;
      const Eigen::Matrix3d k = point.area_m2 * stiffness_at(bed, point.normal);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (std::size_t b = 0; b < nodes.size(); ++b)
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
              const int row = 3 * nodes[a] + i, column = 3 * nodes[b] + j;
              if (row >= column && k(i, j) != 0)
                entry[{row, column}] += point.shape.value[a] * point.shape.value[b] * k(i, j);
            }
    }
  std::vector<fem::NodeSpring> springs;
  for (const auto& [place, k] : entry) springs.push_back({place.first, place.second, k});
  return springs;
}

}  // namespace palpate
