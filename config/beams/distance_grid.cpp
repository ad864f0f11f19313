#include "config/beams/distance_grid.h"

#include <algorithm>
#include <cmath>

#include "rt_core/surface/closest_point.h"

namespace palpate {

DistanceGrid::DistanceGrid(const Model& surface, double cell_m) : cell_m_(cell_m) {
  Vec3 low = surface.vertex_m[0], high = low;
  for (const Vec3& p : surface.vertex_m) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 size = high - low, middle = 0.5 * (low + high);
  const auto nodes = [&](double length) { return 2 * static_cast<int>(std::ceil(0.5 * length / cell_m_ + 2)) + 1; };
  const auto total = [&] { return 1.0 * nodes(size.x) * nodes(size.y) * nodes(size.z); };
  while (total() > kMostNodes) cell_m_ *= 1.1;
  count_ = {nodes(size.x), nodes(size.y), nodes(size.z)};
  // Symmetric about the middle of the body, so that mirror images of a body get mirror images of a grid.
  origin_m_ = middle - (0.5 * cell_m_) * Vec3{count_[0] - 1.0, count_[1] - 1.0, count_[2] - 1.0};
  value_m_.reserve(static_cast<std::size_t>(total()));
  std::int32_t warm = -1;
  for (int k = 0; k < count_[2]; ++k)
    for (int j = 0; j < count_[1]; ++j)
      for (int i = 0; i < count_[0]; ++i) {
        const Vec3 p = origin_m_ + cell_m_ * Vec3{1.0 * i, 1.0 * j, 1.0 * k};
        const SurfacePoint at = closest_surface_point(surface, p, 2e9, warm);
        warm = at.triangle;
        value_m_.push_back(at.signed_distance_m);
      }
}

double DistanceGrid::at(Vec3 p) const {
  const Vec3 local = (1.0 / cell_m_) * (p - origin_m_);
  const double x[3] = {local.x, local.y, local.z};
  std::array<int, 3> cell{};
  double f[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double c = std::clamp(x[a], 0.0, count_[a] - 1.001);
    cell[a] = static_cast<int>(c);
    f[a] = c - cell[a];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = (corner >> 1) & 1, dz = corner >> 2;
    const double weight = (dx ? f[0] : 1 - f[0]) * (dy ? f[1] : 1 - f[1]) * (dz ? f[2] : 1 - f[2]);
    const auto at = ((static_cast<std::size_t>(cell[2] + dz) * static_cast<std::size_t>(count_[1])) +
                     static_cast<std::size_t>(cell[1] + dy)) *
                        static_cast<std::size_t>(count_[0]) +
                    static_cast<std::size_t>(cell[0] + dx);
    sum += weight * value_m_[at];
  }
  return sum;
}

std::vector<double> wall_thickness_m(const Model& surface, const DistanceGrid& grid, double longest_m) {
  const double step = 0.25 * grid.cell_m();
  std::vector<double> thickness(surface.vertex_m.size(), longest_m);
  for (std::size_t v = 0; v < thickness.size(); ++v) {
    const Vec3 p = surface.vertex_m[v], n = surface.vertex_normal[v];
    // The first cell is skipped: the grid rounds the surface off there.
    double before = -grid.cell_m();
    for (double depth = grid.cell_m(); depth < longest_m; depth += step) {
      const double now = grid.at(p - depth * n);
      if (now >= 0) {
        thickness[v] = depth - step * now / std::max(now - before, 1e-12);
        break;
      }
      before = now;
    }
  }
  return thickness;
}

}  // namespace palpate
