// Where the numbers of config/elastic/width_law.h come from: a ball on a bonded layer by large-strain finite elements
// over the linear layer's integral equation, by Poisson's ratio and thickness, and on a larger ball over linear
// elements, beside what the law has.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "config/elastic/width_law.h"
#include "config/fem/axisymmetric_press.h"
#include "config/response/layer_contact.h"

namespace palpate::fem {
namespace {

constexpr double kBall_m = 0.01, kYoung_Pa = 1e5;

PressBody layer_of(double nu, double thickness_m) {
  PressBody body;
  body.outer_radius_m = std::max(3.5 * thickness_m, 0.045);
  body.height_m = thickness_m;
  body.youngs_modulus_Pa = kYoung_Pa;
  body.poisson_ratio = nu;
  return body;
}
PressBody ball_of(double nu, double radius_m) {
  PressBody body;
  body.kind = PressBody::Kind::kEllipsoid;
  body.outer_radius_m = body.height_m = radius_m;
  body.fixed_below_m = -0.1 * radius_m;
  body.youngs_modulus_Pa = kYoung_Pa;
  body.poisson_ratio = nu;
  return body;
}

// As far as there is equilibrium: the first mesh on which there is one at every depth, or the one that goes deepest.
PressCurve pressed(const PressBody& body, StrainLaw law, const std::vector<double>& depths_m,
                   const std::vector<double>& extents) {
  RigidTool ball;
  ball.radius_m = kBall_m;
  PressCurve best;
  for (const double wider : extents) {
    PressMeshing meshing = default_meshing(body, ball, depths_m.back(), 13);
    meshing.fine_extent_m *= wider;
    PressCurve curve = press_as_far_as_possible(body, ball, law, depths_m, meshing);
    if (curve.points.size() > best.points.size()) best = std::move(curve);
    if (best.points.size() == depths_m.size()) break;
  }
  return best;
}

// Elements' force over the linear layer's, and the law's; returns the largest difference.
double compare(double nu, double thickness_m) {
  std::vector<double> depths_m;
  for (const double share : {0.1, 0.2, 0.4, 0.6, 0.8, 1.0})
    depths_m.push_back(share * 0.4 * std::min(kBall_m, thickness_m));
  const PressCurve curve = pressed(layer_of(nu, thickness_m), StrainLaw::kNeoHookean, depths_m, {1.0, 1.1, 1.25, 1.4});
  EXPECT_GE(curve.points.size(), 4u);
  const LayerContact layer({thickness_m, nu, LayerBase::kBonded}, 2 * kBall_m);
  const double modulus = kYoung_Pa / (1 - nu * nu);
  const elastic::BallLaw ball{kBall_m, modulus, false, nu, 0, {}};
  const double narrow = -layer.kernel_at_zero_per_m() / (std::numbers::pi * modulus);
  double worst = 0;
  std::printf("nu %.2f, %2.0f mm:", nu, 1e3 * thickness_m);
  for (const PressPoint& point : curve.points) {
    const double linear = modulus * layer.at_depth({TipProfile::kSphere, kBall_m, 0}, point.depth_m).force_m2;
    const double law = elastic::large_strain_factor(ball, narrow, point.depth_m);
    std::printf("  %.2f mm %.3f (%.3f)", 1e3 * point.depth_m, point.force_N / linear, law);
    worst = std::max(worst, std::abs(law * linear / point.force_N - 1));
  }
  std::printf("\n");
  std::fflush(stdout);
  return worst;
}

TEST(LongReport, LargeStrainOverTheLinearLayer) {
  double worst = 0;
  for (const double nu : {0.0, 0.3, 0.4, 0.45, 0.49})
    for (const double thickness_m : {0.008, 0.014, 0.02}) worst = std::max(worst, compare(nu, thickness_m));
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 0.035);  // 3.1 % at nu = 0, 8 mm, 3.2 mm deep; 0.4 % at nu = 0.3 (2026-11-25)
}

// The same on a ball, over linear elements on the same meshes.
double compare_ball(double nu, double radius_m) {
  const std::vector<double> depths_m{0.1 * kBall_m, 0.3 * kBall_m, 0.5 * kBall_m};
  const PressBody body = ball_of(nu, radius_m);
  const PressCurve linear = pressed(body, StrainLaw::kLinear, depths_m, {0.8, 0.65, 1.0}),
                   large = pressed(body, StrainLaw::kNeoHookean, depths_m, {0.8, 0.65, 1.0});
  EXPECT_EQ(linear.points.size(), depths_m.size());
  EXPECT_EQ(large.points.size(), depths_m.size());
  const double k = 1 / radius_m;
  const elastic::BallLaw ball{kBall_m, kYoung_Pa / (1 - nu * nu), false, nu, k, {k, k}};
  double worst = 0;
  std::printf("nu %.2f, a ball of %2.0f mm:", nu, 1e3 * radius_m);
  for (std::size_t i = 0; i < std::min(linear.points.size(), large.points.size()); ++i) {
    const double found = large.points[i].force_N / linear.points[i].force_N;
    const double law = elastic::large_strain_factor(ball, 0, depths_m[i]);
    std::printf("  %.2f mm %.3f (%.3f)", 1e3 * depths_m[i], found, law);
    worst = std::max(worst, std::abs(law / found - 1));
  }
  std::printf("\n");
  std::fflush(stdout);
  return worst;
}

TEST(LongReport, LargeStrainOverALinearBall) {
  double worst = 0;
  for (const double nu : {0.0, 0.2, 0.35, 0.49})
    for (const double radius_m : {0.0377, 0.1}) worst = std::max(worst, compare_ball(nu, radius_m));
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 0.03);
}

}  // namespace
}  // namespace palpate::fem
