// Signed distance of the body's surface on a grid: what tests whether a beam stays inside.
#pragma once

#include <array>
#include <vector>

#include "rt_core/model.h"

namespace palpate {

class DistanceGrid {
 public:
  // `surface` needs vertex_m, vertex_normal, triangle and bvh. The cell is made larger than `cell_m` where the body
  // would take more than kMostNodes of them.
  DistanceGrid(const Model& surface, double cell_m);
  // Negative inside; trilinear, so it errs by about cell^2 times curvature / 8, and on the safe side (too near the
  // surface) where the nearest surface point changes. Far outside the grid: the value at the nearest grid point.
  double at(Vec3 p) const;
  double cell_m() const { return cell_m_; }

  static constexpr double kMostNodes = 1.5e6;

 private:
  double cell_m_;
  Vec3 origin_m_;
  std::array<int, 3> count_{};
  std::vector<double> value_m_;
};

// Wall thickness at every vertex: how far its inward normal runs before it leaves the body. Grid accuracy.
std::vector<double> wall_thickness_m(const Model& surface, const DistanceGrid& grid, double longest_m);

}  // namespace palpate
