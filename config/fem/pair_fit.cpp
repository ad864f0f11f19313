#include "config/fem/pair_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "config/scene/config_error.h"

namespace palpate::fem {

namespace {

// The force at which a rising travel reaches zero, or none.
template <class Travel>
double force_where_zero(const Travel& travel) {
  if (!(travel(0.0) < 0)) return 0;
  double low = 0, high = 1;
  for (int i = 0; i < 60 && travel(high) < 0; ++i) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-13 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (travel(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

PairCoupling fit_pair(std::optional<double> c_m_per_N, const DepthOfForce& first, const DepthOfForce& second,
                      const std::vector<PairState>& large) {
  if (large.size() < 2)
    throw ConfigError("pair coupling: needs two or more large-strain states with both contacts loaded");
  Eigen::MatrixXd rows(2 * static_cast<Eigen::Index>(large.size()), 3);
  Eigen::VectorXd rest(rows.rows());
  const double c = c_m_per_N.value_or(0);
  for (Eigen::Index i = 0; i < rows.rows(); i += 2) {
    const PairState& s = large[static_cast<std::size_t>(i / 2)];
    const double f = s.first_N, g = s.second_N;
    rows.row(i) << f * g, 0.5 * g * g, g;
    rows.row(i + 1) << 0.5 * f * f, f * g, f;
    rest[i] = s.first_m - first(f) - c * g;
    rest[i + 1] = s.second_m - second(g) - c * f;
  }
  const Eigen::VectorXd h = rows.leftCols(c_m_per_N ? 2 : 3).colPivHouseholderQr().solve(rest);
  return {c_m_per_N ? c : h[2], h[0], h[1]};
}

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

PairState solve_pair(const DepthOfForce& first, const DepthOfForce& second, const PairCoupling& k, double first_m,
                     double second_m) {
  PairState s = {first_m, second_m, 0, 0};
  for (int sweep = 0; sweep < 500; ++sweep) {
    const double f = s.first_N, g = s.second_N;
    s.first_N = force_where_zero([&](double x) {
      return first(x) + k.c_m_per_N * g + k.h12_m_per_N2 * x * g + 0.5 * k.h21_m_per_N2 * g * g - first_m;
    });
    s.second_N = force_where_zero([&](double x) {
      const double y = s.first_N;
      return second(x) + k.c_m_per_N * y + k.h21_m_per_N2 * x * y + 0.5 * k.h12_m_per_N2 * y * y - second_m;
    });
    if (std::abs(s.first_N - f) + std::abs(s.second_N - g) < 1e-10 * (f + g)) break;
  }
  return s;
}

DepthOfForce depth_table(std::vector<LoadPoint> points) {
  points.insert(points.begin(), LoadPoint{});
  for (std::size_t i = 1; i < points.size(); ++i)
    if (!(points[i].force_N > points[i - 1].force_N && points[i].depth_m > points[i - 1].depth_m))
      throw ConfigError("table of travel over force: both must rise from the origin");
  return [points](double force_N) {
    const auto next = std::upper_bound(points.begin() + 1, points.end() - 1, force_N,
                                       [](double f, const LoadPoint& p) { return f < p.force_N; });
    const LoadPoint &a = *(next - 1), &b = *next;
    return a.depth_m + (force_N - a.force_N) * (b.depth_m - a.depth_m) / (b.force_N - a.force_N);
  };
}

}  // namespace palpate::fem
