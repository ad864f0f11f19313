#include "tests/strain/pair_states.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

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
