#include "config/response/press_series.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

// Elements under the tool, in the order they are tried: now and then one mesh finds no equilibrium where another does.
// A cone that fails on one fails on all, and slowly.
constexpr int kElements[] = {12, 10, 16}, kConeElements[] = {12};
constexpr double kLargestMisfit = 0.02;

}  // namespace

OwnedLaw make_owned_law(const TipDesc& tip) {
  OwnedLaw law;
  law.tip = make_tip_law(tip, law.factor);
  return law;
}

double FarSeries::travel_m(double force_N) const {
  const double f = std::min(force_N, force_max_N);
  return (c0_m_per_N + (c1_m_per_N2 + c2_m_per_N3 * f) * f) * f + slope_m_per_N(force_N) * (force_N - f);
}

double FarSeries::slope_m_per_N(double force_N) const {
  const double f = std::min(force_N, force_max_N);
  return c0_m_per_N + (2 * c1_m_per_N2 + 3 * c2_m_per_N3 * f) * f;
}

FarSeries fit_far_series(const LocalLaw& local, const std::vector<fem::LoadPoint>& press) {
  const auto rows = static_cast<Eigen::Index>(press.size());
  const double force_max = press.back().force_N;
  const auto depth_of =
      fem::inverse_of([local](double depth) { return local_at(local, depth).force_N; }, press.back().depth_m);
  Eigen::MatrixXd a(rows, 3);
  Eigen::VectorXd b(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const fem::LoadPoint& p = press[static_cast<std::size_t>(i)];
    const double f = p.force_N / force_max, per_depth = f / p.depth_m;
    a.row(i) << per_depth, per_depth * f, per_depth * f * f;
    b(i) = (p.depth_m - depth_of(p.force_N)) / p.depth_m;
  }
  const Eigen::Vector3d c = a.colPivHouseholderQr().solve(b);
  return {c(0) / force_max, c(1) / (force_max * force_max), c(2) / (force_max * force_max * force_max), force_max};
}

std::vector<double> press_shares(fem::RigidShape tool) {
  if (tool == fem::RigidShape::kCone) return {0.4, 0.5, 0.65, 0.8, 1.0};
  return {0.15, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0};
}

std::span<const int> press_elements(fem::RigidShape tool) {
  if (tool == fem::RigidShape::kCone) return kConeElements;
  return kElements;
}

PressSeries press_series(const fem::PressBody& body, const fem::RigidTool& tool, const LocalLaw& local,
                         double depth_max_m, std::span<const int> meshes) {
  std::vector<double> depths = press_shares(tool.shape);
  for (double& d : depths) d *= depth_max_m;
  PressSeries series;
  std::string why;
  for (const int elements : meshes) {
    try {
      const fem::PressCurve curve = fem::press_axisymmetric(body, tool, fem::StrainLaw::kNeoHookean, depths,
                                                            press_meshing(body, tool, depth_max_m, elements));
      for (const fem::PressPoint& p : curve.points) series.press.push_back({p.depth_m, p.force_N});
      series.elements = elements;
      break;
    } catch (const ConfigError& error) {
      why = error.what();
    }
  }
  if (series.press.empty()) throw ConfigError(why);
  series.far = fit_far_series(local, series.press);
  const auto depth_of = fem::inverse_of([local](double depth) { return local_at(local, depth).force_N; }, depth_max_m);
  for (const fem::LoadPoint& p : series.press)
    series.misfit =
        std::max(series.misfit, std::abs(depth_of(p.force_N) + series.far.travel_m(p.force_N) - p.depth_m) / p.depth_m);
  if (!(series.misfit <= kLargestMisfit))
    throw ConfigError("the presses stray from the tip's law in series with a far field by " +
                      number_text(std::round(1000 * series.misfit) / 10) + " % of their depth; allowed " +
                      number_text(100 * kLargestMisfit) + " %");
  return series;
}

}  // namespace palpate
