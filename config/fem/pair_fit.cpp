#include "config/fem/pair_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/scene/config_error.h"

namespace palpate::fem {

std::vector<Point<2>> top_line(const StrainMesh<2>& mesh, const std::vector<double>& u_m) {
  double size = 0;
  for (const Point<2>& p : mesh.nodes_m) size = std::max(size, std::abs(p[1]));
  std::vector<std::size_t> top;
  for (std::size_t i = 0; i < mesh.nodes_m.size(); ++i)
    if (mesh.nodes_m[i][1] > -1e-9 * size) top.push_back(i);
  std::sort(top.begin(), top.end(),
            [&](std::size_t a, std::size_t b) { return mesh.nodes_m[a][0] < mesh.nodes_m[b][0]; });
  std::vector<Point<2>> line;
  for (const std::size_t i : top)
    line.push_back({mesh.nodes_m[i][0] + u_m[2 * i], mesh.nodes_m[i][1] + u_m[2 * i + 1]});
  return line;
}

double touch_depth_m(const std::vector<Point<2>>& line, const RigidTool& tool, double at_m) {
  // Each element's edge is a parabola through three nodes; the tool meets the line where their distance is least.
  constexpr int kSamples = 64;
  double depth = std::numeric_limits<double>::infinity();
  Point<2> last{};
  for (std::size_t first = 0; first + 2 < line.size(); first += 2)
    for (int k = 0; k <= kSamples; ++k) {
      const double s = 2.0 * k / kSamples - 1, w[3] = {0.5 * s * (s - 1), 1 - s * s, 0.5 * s * (s + 1)};
      Point<2> p{};
      for (std::size_t n = 0; n < 3; ++n)
        for (std::size_t i = 0; i < 2; ++i) p[i] += w[n] * line[first + n][i];
      const double across = p[0] - at_m, r = tool.radius_m;
      if (tool.shape == RigidShape::kBall) {
        if (std::abs(across) < r) depth = std::min(depth, r - std::sqrt(r * r - across * across) - p[1]);
      } else if (k > 0 && last[0] <= at_m && p[0] >= at_m) {
        const double share = p[0] > last[0] ? (at_m - last[0]) / (p[0] - last[0]) : 0.0;
        depth = std::min(depth, -(last[1] + share * (p[1] - last[1])));
      }
      last = p;
    }
  if (!std::isfinite(depth)) throw ConfigError("pair coupling: the other contact lies beside the body's top");
  return depth;
}

TouchFit fit_touch(const std::vector<LoadPoint>& touch) {
  double n = 0, f1 = 0, f2 = 0, y = 0, yf = 0;
  for (const LoadPoint& p : touch) {
    const double f = p.force_N, ratio = p.depth_m / f;
    n += 1;
    f1 += f;
    f2 += f * f;
    y += ratio;
    yf += ratio * f;
  }
  const double determinant = n * f2 - f1 * f1;
  if (!(determinant > 1e-9 * n * f2)) throw ConfigError("pair coupling: needs two or more states of different force");
  return {(y * f2 - yf * f1) / determinant, 2 * (n * yf - f1 * y) / determinant};
}

}  // namespace palpate::fem
