#include "tests/strain/arm_series.h"

#include <Eigen/Dense>
#include <cmath>

#include "config/scene/config_error.h"

namespace palpate::fem {

namespace {

// Half of H(f, f), component by component, as a row in (xxx, xxy, xyy, yyy).
Eigen::Matrix<double, 2, 4> quadratic_rows(const Point<2>& f) {
  Eigen::Matrix<double, 2, 4> rows;
  rows << 0.5 * f[0] * f[0], f[0] * f[1], 0.5 * f[1] * f[1], 0, 0, 0.5 * f[0] * f[0], f[0] * f[1], 0.5 * f[1] * f[1];
  return rows;
}

Point<2> linear_tip(const ArmSeries& arm, const Point<2>& f) {
  return {arm.c_m_per_N[0] * f[0] + arm.c_m_per_N[1] * f[1], arm.c_m_per_N[1] * f[0] + arm.c_m_per_N[2] * f[1]};
}

}  // namespace

ArmSeries fit_arm(const ArmState& along_x, const ArmState& along_y, const std::array<ArmState, 2>& large) {
  if (!(along_x.force_N[0] != 0 && along_y.force_N[1] != 0))
    throw ConfigError("arm series: the linear loads must act along x and along y");
  ArmSeries arm;
  arm.c_m_per_N = {along_x.tip_m[0] / along_x.force_N[0],
                   0.5 * (along_x.tip_m[1] / along_x.force_N[0] + along_y.tip_m[0] / along_y.force_N[1]),
                   along_y.tip_m[1] / along_y.force_N[1]};
  Eigen::Matrix4d rows;
  Eigen::Vector4d rest;
  for (int k = 0; k < 2; ++k) {
    const ArmState& s = large[static_cast<std::size_t>(k)];
    const Point<2> linear = linear_tip(arm, s.force_N);
    rows.middleRows<2>(2 * k) = quadratic_rows(s.force_N);
    rest[2 * k] = s.tip_m[0] - linear[0];
    rest[2 * k + 1] = s.tip_m[1] - linear[1];
  }
  const Eigen::FullPivLU<Eigen::Matrix4d> lu(rows);
  if (!lu.isInvertible()) throw ConfigError("arm series: the two large-strain loads must not be parallel");
  const Eigen::Vector4d h = lu.solve(rest);
  arm.h_m_per_N2 = {h[0], h[1], h[2], h[3]};
  return arm;
}

Point<2> arm_tip_m(const ArmSeries& arm, const Point<2>& f) {
  const Eigen::Vector2d second = quadratic_rows(f) * Eigen::Map<const Eigen::Vector4d>(arm.h_m_per_N2.data());
  const Point<2> first = linear_tip(arm, f);
  return {first[0] + second[0], first[1] + second[1]};
}

Point<2> arm_force_from_disc_N(const ArmSeries& arm, const Point<2>& rest, const Point<2>& disc, double reach_m) {
  // The force acts along the line of centres, which the tip's own displacement turns: a few rounds settle it.
  const auto push = [&](double magnitude) {
    Point<2> f{}, tip = rest;
    for (int round = 0; round < 60; ++round) {
      const double x = tip[0] - disc[0], y = tip[1] - disc[1], distance = std::hypot(x, y);
      f = {magnitude * x / distance, magnitude * y / distance};
      const Point<2> u = arm_tip_m(arm, f);
      tip = {rest[0] + u[0], rest[1] + u[1]};
    }
    return std::pair{f, std::hypot(tip[0] - disc[0], tip[1] - disc[1])};
  };
  if (!(push(0).second < reach_m)) return {0, 0};
  double low = 0, high = 1e-3;
  for (int i = 0; i < 40 && push(high).second < reach_m; ++i) high *= 2;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (push(middle).second < reach_m ? low : high) = middle;
  }
  return push(0.5 * (low + high)).first;
}

}  // namespace palpate::fem
