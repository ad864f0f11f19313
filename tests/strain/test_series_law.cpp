// The series law against the large-strain reference it was not fitted to.
#include <gtest/gtest.h>

#include <cmath>

#include "config/fem/series_fit.h"
#include "tests/strain/strain_scenes.h"

namespace palpate::fem {
namespace {

DepthOfForce hertz(double modulus_Pa, double radius_m) {
  return [=](double f) { return std::pow(f / (4.0 / 3 * modulus_Pa * std::sqrt(radius_m)), 2.0 / 3); };
}

struct ReferenceRow {
  double depth_mm, force_N;
};

void expect_within(const DepthOfForce& local, const SeriesCoefficients& c, const std::vector<ReferenceRow>& rows,
                   double share) {
  for (const ReferenceRow& row : rows)
    EXPECT_NEAR(series_force_N(local, c, 1e-3 * row.depth_mm) / row.force_N, 1, share) << row.depth_mm << " mm";
}

TEST(SeriesLaw, StaysWithinTwoPerCentOnTheRubberBlock) {
  const PressBody body = rubber_block();
  const DepthOfForce local = hertz(3.45e6, 6.35e-3);
  const SeriesBake bake = bake_series(body, ball(6.35e-3), local, 3e-3, 10, 0.67);
  EXPECT_FALSE(bake.coefficients.clamped);
  // Large-strain forces on a mesh of 30 elements over 6 mm (published with the scene), good to 0.5 %.
  expect_within(local, bake.coefficients, {{0.25, 1.4558}, {0.5, 4.1091}, {1, 11.573}, {2, 32.303}, {3, 58.363}}, 0.02);
}

TEST(SeriesLaw, StaysWithinTwoPerCentOnTheEllipsoid) {
  const DepthOfForce local = hertz(3e6 / (1 - 0.45 * 0.45), 1 / (1 / 0.01 + 0.03 / (0.04 * 0.04)));
  const SeriesBake bake = bake_series(ellipsoid(), ball(0.01), local, 8e-3, 8, 0.6);
  expect_within(local, bake.coefficients, {{1, 14.208}, {2, 39.671}, {4, 109.78}, {6, 197.67}, {8, 298.42}}, 0.02);
}

TEST(SeriesLaw, FitReturnsTheCoefficientsOfAnExactSeries) {
  const DepthOfForce local = hertz(3e6, 8e-3);
  const SeriesCoefficients truth = {2e-5, -3e-8, false};
  const LoadPoint linear = {local(20) + 2e-5 * 20, 20}, large = {series_depth_m(local, truth, 15), 15};
  const SeriesCoefficients fit = fit_series(local, linear, large, 40);
  EXPECT_NEAR(fit.c0_m_per_N, truth.c0_m_per_N, 1e-15);
  EXPECT_NEAR(fit.c1_m_per_N2, truth.c1_m_per_N2, 1e-17);
  EXPECT_NEAR(series_force_N(local, fit, series_depth_m(local, fit, 7.5)), 7.5, 1e-10);
}

TEST(SeriesLaw, ACoefficientThatWouldTurnTheTravelBackIsCutUntilItRises) {
  const DepthOfForce local = hertz(3e6, 8e-3);
  const LoadPoint linear = {local(20), 20}, large = {0.5 * local(20), 20};
  const SeriesCoefficients fit = fit_series(local, linear, large, 60);
  EXPECT_TRUE(fit.clamped);
  for (double f = 0.5; f < 60; f += 0.5)
    EXPECT_LT(series_depth_m(local, fit, f - 0.5), series_depth_m(local, fit, f)) << f;
}

}  // namespace
}  // namespace palpate::fem
