// Where the numbers of config/elastic/width_law.h come from: a ball on a bonded layer by large-strain finite elements
// over the linear layer's integral equation, by Poisson's ratio and thickness, beside what the law has.
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

// As far as there is equilibrium: the first mesh on which there is one at every depth, or the one that goes deepest.
PressCurve press_layer(double nu, double thickness_m, const std::vector<double>& depths_m) {
  PressBody body;
  body.outer_radius_m = std::max(3.5 * thickness_m, 0.045);
  body.height_m = thickness_m;
  body.youngs_modulus_Pa = kYoung_Pa;
  body.poisson_ratio = nu;
  RigidTool ball;
  ball.radius_m = kBall_m;
  PressCurve best;
  for (const double wider : {1.0, 1.1, 1.25, 1.4}) {
    PressMeshing meshing = default_meshing(body, ball, depths_m.back(), 13);
    meshing.fine_extent_m *= wider;
    PressCurve curve = press_as_far_as_possible(body, ball, StrainLaw::kNeoHookean, depths_m, meshing);
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
  const PressCurve curve = press_layer(nu, thickness_m, depths_m);
  EXPECT_GE(curve.points.size(), 4u);
  const LayerContact layer({thickness_m, nu, LayerBase::kBonded}, 2 * kBall_m);
  const double modulus = kYoung_Pa / (1 - nu * nu);
  const elastic::BallLaw ball{kBall_m, modulus, false, nu, 0};
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

}  // namespace
}  // namespace palpate::fem
