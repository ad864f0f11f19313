// What a place adds to a tip's law where its give changes with the width of the contact.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "config/elastic/width_law.h"
#include "config/response/layer_contact.h"
#include "rt_core/contact/tips/travel.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

constexpr double kModulus = 2.5e4, kBall_m = 6.35e-3, kThickness_m = 0.01, kDepth_m = 4e-3;

// A layer's own give under no width, and under a patch by the least b: what an exact layer has within 2 %.
double narrow_mpN() {
  const LayerContact layer({kThickness_m, 0.45, LayerBase::kBonded}, kBall_m);
  return -layer.kernel_at_zero_per_m() / (std::numbers::pi * kModulus);
}
elastic::WidthLaw layer_width() {
  const double narrow = narrow_mpN(), b = 4 * std::numbers::pi * kModulus * narrow * kModulus * narrow;
  const double sigma[2] = {2e-3, 3e-3};
  const double give[2] = {narrow / std::sqrt(1 + b * sigma[0] * sigma[0]),
                          narrow / std::sqrt(1 + b * sigma[1] * sigma[1])};
  return {give, sigma, kModulus};
}

TEST(WidthLaw, TwoPatchesTellALayer) {
  const elastic::WidthLaw width = layer_width();
  EXPECT_NEAR(width.give_mpN(0) / narrow_mpN(), 1, 1e-12);
  // As wide as can be, a layer gives nothing, and less than a half space never.
  for (const double sigma : {0.01, 0.1, 1.0}) {
    const double half_space = 1 / (2 * std::sqrt(std::numbers::pi) * sigma * kModulus);
    EXPECT_GT(half_space + width.give_mpN(sigma), 0) << sigma;
    EXPECT_LT(width.give_mpN(sigma), 0) << sigma;
  }
}

TEST(WidthLaw, TwoPatchesTellAWall) {
  const double give[2] = {3e-5, 2.8e-5}, sigma[2] = {3e-3, 4e-3};
  const elastic::WidthLaw width(give, sigma, kModulus);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(width.give_mpN(sigma[i]), give[i], 1e-18);
  EXPECT_NEAR(width.give_mpN(0), 3e-5 + 2e-6 * 9 / 7, 1e-18);
}

// Closed form of the tick against the exact layer, less what large strain adds to the dent (2 % of a / R).
TEST(WidthLaw, ABallOnALayer) {
  const LayerContact layer({kThickness_m, 0.45, LayerBase::kBonded}, kBall_m);
  const Indenter ball{TipProfile::kSphere, kBall_m, 0};
  const elastic::WidthLaw width = layer_width();
  const double narrow = narrow_mpN(), beta = elastic::fit_beta({kBall_m, kModulus, false}, width, narrow, kDepth_m);
  const double m = 4.0 / 3 * kModulus * std::sqrt(kBall_m);
  const LayerContact half_space({0, 0.45, LayerBase::kBonded}, kBall_m);
  for (const double depth : {0.25e-3, 0.5e-3, 1e-3, 2e-3, 3e-3, 4e-3}) {
    const double z = -narrow * m * std::sqrt(depth);
    const double force = kModulus * half_space.at_depth(ball, depth).force_m2 +
                         m * std::pow(depth, 1.5) * z * (1.5 + 2.625 * z) + beta * kBall_m * m * m * std::pow(depth, 3);
    EXPECT_NEAR(force / (kModulus * layer.at_depth(ball, depth).force_m2), 1, 0.025) << depth;
  }
}

TEST(WidthLaw, APlainPlaceAddsNothingBySeries) {
  const double give[2] = {0, 0}, sigma[2] = {2e-3, 3e-3};
  const elastic::WidthLaw width(give, sigma, kModulus);
  // What is left is large strain's share of the dent: 1.5 x 2 % of a / R, softer.
  const double beta = elastic::fit_beta({kBall_m, kModulus, false}, width, 0, kDepth_m);
  const double m = 4.0 / 3 * kModulus * std::sqrt(kBall_m);
  const double share = beta * kBall_m * m * std::pow(kDepth_m, 1.5);
  EXPECT_LT(share, 0);
  EXPECT_GT(share, -0.04);
}

TEST(PlaceTerms, ForceIsTheSlopeOfTheEnergyAndItsTangentOfTheForce) {
  const PlaceTerms terms{3e3, 2e4, -4e5, 6e7};
  constexpr double kRange = 3e-3, kStep = 1e-8;
  for (const double e : {1e-5, 4e-4, 2.9e-3, 3.5e-3, 9e-3}) {
    const LawPoint at = place_at(terms, kRange, e);
    const double slope = (place_energy_J(terms, kRange, e + kStep) - place_energy_J(terms, kRange, e - kStep)) / 2;
    EXPECT_NEAR(slope / kStep / at.force_N, 1, 1e-5) << e;
    const double rise = place_at(terms, kRange, e + kStep).force_N - place_at(terms, kRange, e - kStep).force_N;
    EXPECT_NEAR(rise / (2 * kStep) / at.tangent_N_per_m, 1, 1e-5) << e;
  }
  EXPECT_EQ(place_at(terms, kRange, -1e-3).force_N, 0);
  EXPECT_EQ(place_energy_J(terms, kRange, 0), 0);
}

// The case `layer` of tests/accuracy, whose reference is axisymmetric Q9 of 24 elements under the ball (2026-11-22).
// One clamped number for c had it 24 % too soft at 4 mm.
TEST(ElasticTick, BallOnAThinLayer) {
  SceneDesc scene = parse_scene(
      elastic_scene("shape = \"cylinder\"\nradius_mm = 40\nheight_mm = 10\ntriangles = 4000\n", 0, 5, 6.35, 4),
      "layer.toml");
  scene.material.youngs_modulus_Pa = 2e4;
  scene.contact.max_depth_m = 4.2e-3;
  const BakedScene baked(scene);
  const struct {
    double depth_mm, force_N;
  } rows[] = {{0.4, 0.02533522}, {1.2, 0.151284}, {2.4, 0.48864}, {4, 1.170875}};
  for (const auto& row : rows)
    EXPECT_NEAR(press_N(baked.model(), {0, 0.01635, 0}, 1e-3 * row.depth_mm) / row.force_N, 1, 0.03) << row.depth_mm;
}

// Where the give falls along the surface, what a loop of slides and presses takes it gives back.
TEST(ElasticTick, ALoopOverTheRimOfASupportReturnsItsWork) {
  const BakedScene scene(elastic_scene(
      "shape = \"cylinder\"\nradius_mm = 30\nheight_mm = 12\naxis = \"y\"\ntriangles = 3000\n", 0, 6, 8, 2));
  Bench bench(scene.model());
  const Vec3 corner[] = {{0.004, 0.021, 0}, {0.004, 0.0185, 0}, {0.016, 0.0185, 0.003}, {0.016, 0.021, 0.003}};
  double work = 0, largest = 0;
  Vec3 at = corner[0];
  bench.tick_at({at, {}}, {});
  for (int i = 1; i <= 4; ++i) {
    const Vec3 from = at, to = corner[i % 4];
    const int steps = static_cast<int>(norm(to - from) / 2e-5) + 1;
    Vec3 before = bench.output.contact_w.force_N;
    for (int k = 1; k <= steps; ++k) {
      const Vec3 next = from + (static_cast<double>(k) / steps) * (to - from);
      bench.tick_at({next, {}}, {});
      const Vec3 force = bench.output.contact_w.force_N;
      work += 0.5 * dot(force + before, next - at);
      at = next;
      before = force;
    }
    largest = std::max(largest, std::abs(work));
  }
  EXPECT_GT(largest, 1e-3);
  EXPECT_LT(std::abs(work), 2e-3 * largest);
}

}  // namespace
}  // namespace palpate::test
