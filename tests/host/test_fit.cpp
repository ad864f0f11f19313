// Material from presses: synthetic measurements with noise, whose truth is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "config/scene/config_error.h"
#include "sim_host/fit/press_forward.h"

namespace palpate::test {
namespace {

constexpr double kTrue_Pa = 12e3, kTrueFriction = 0.35;

// A ball of 8 mm on a soft block by the tip's own law, which bakes in milliseconds.
SceneDesc soft_block() {
  return parse_scene(
      "name = \"soft\"\n[body]\nshape = \"box\"\nsize_mm = [80, 40, 80]\ntriangles = 1200\n[body.material]\n"
      "youngs_modulus_Pa = 8000\npoisson_ratio = 0.45\n[skeleton]\nlaw = \"none\"\n[contact]\nlaw = \"tool\"\n"
      "max_depth_mm = 6\n[friction]\nlaw = \"presliding\"\nmu_ref = 0.5\n[shape]\nneighbourhood = \"none\"\n"
      "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n",
      "soft.toml");
}

// Down to 4 mm in steps of 0.1 mm, then aside by 6 mm.
Measurement motion() {
  Measurement m;
  const auto add = [&](double x, double depth) {
    TimedPose pose;
    pose.tool_w.position_m = {x, 0.048 - depth, 0};
    m.pose.push_back(pose);
  };
  for (int k = 0; k <= 40; ++k) add(0, 1e-4 * k);
  for (int k = 1; k <= 60; ++k) add(1e-4 * k, 4e-3);
  return m;
}

// The scene's own forces at the true values, with noise.
Measurement measured(double noise_N, unsigned seed) {
  Measurement m = motion();
  PressForward forward(soft_block(), m);
  m.force_N = forward({kTrue_Pa, 0.45, kTrueFriction});
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, noise_N);
  for (Vec3& f : m.force_N) f = f + Vec3{normal(random), normal(random), normal(random)};
  return m;
}

MaterialFit fitted(const Measurement& m, const std::vector<Fitted>& wanted) {
  PressForward forward(soft_block(), m);
  return fit_material([&](const MaterialGuess& g) { return forward(g); }, {8e3, 0.45, 0.5}, wanted, m.force_N);
}

// 95 % intervals hold the truth in 17 or more of 20 with a probability of 0.98; the seeds are fixed.
TEST(Fit, ModulusIsWithinItsConfidence) {
  const Measurement clean = measured(0, 1);
  PressForward forward(soft_block(), clean);
  int inside = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 0.02);
    std::vector<Vec3> noisy = clean.force_N;
    for (Vec3& f : noisy) f = f + Vec3{normal(random), normal(random), normal(random)};
    // Friction as it was: E alone is sought.
    const MaterialFit fit = fit_material([&](const MaterialGuess& g) { return forward(g); }, {8e3, 0.45, kTrueFriction},
                                         {Fitted::kModulus}, noisy);
    ASSERT_TRUE(fit.value[0].identified);
    EXPECT_LT(fit.value[0].half_width, 0.05 * kTrue_Pa);
    EXPECT_NEAR(fit.noise_N, 0.02, 0.004);
    inside += std::abs(fit.value[0].value - kTrue_Pa) <= fit.value[0].half_width ? 1 : 0;
  }
  EXPECT_GE(inside, 17);
}

TEST(Fit, FrictionIsFoundWithTheModulus) {
  const MaterialFit fit = fitted(measured(0.01, 5), {Fitted::kModulus, Fitted::kFriction});
  ASSERT_EQ(fit.value.size(), 2u);
  for (const FittedValue& value : fit.value) {
    EXPECT_TRUE(value.identified);
    const double truth = value.what == Fitted::kModulus ? kTrue_Pa : kTrueFriction;
    EXPECT_NEAR(value.value, truth, 3 * value.half_width);
    EXPECT_LT(value.half_width, 0.1 * truth);
  }
}

// A half space answers to E/(1 - nu^2) alone: no press tells nu from E, and the fit must not pretend.
TEST(Fit, PoissonsRatioOfAHalfSpaceIsNotIdentified) {
  const MaterialFit fit = fitted(measured(0.02, 7), {Fitted::kModulus, Fitted::kPoisson});
  ASSERT_EQ(fit.value.size(), 2u);
  for (const FittedValue& value : fit.value) EXPECT_EQ(value.identified, value.what == Fitted::kModulus);
}

TEST(Fit, ForcelessMeasurementsAreRefused) {
  Measurement m = motion();
  m.force_N.assign(m.pose.size(), {});
  EXPECT_THROW(fitted(m, {Fitted::kModulus}), std::runtime_error);
}

TEST(Fit, LawsThatDoNotKnowTheModulusAreRefused) {
  SceneDesc scene = soft_block();
  scene.contact.law = ContactLaw::kDuffing;
  const Measurement m = motion();
  EXPECT_THROW(PressForward(scene, m), ConfigError);
}

// Steps between far poses are filled in: the force is that of a slow press, whatever the rows.
TEST(Fit, DepthTablesPressAtTheHighestPoint) {
  CsvTable table;
  table.name = {"depth_mm", "force_N"};
  table.values = {{1, 2, 4}, {0.1, 0.3, 0.9}};
  const SceneModel model(soft_block());
  const Measurement m = read_measurement(table, model.model());
  ASSERT_EQ(m.pose.size(), 3u);
  EXPECT_FALSE(m.vectors);
  EXPECT_NEAR(m.pose[0].tool_w.position_m.y, 0.048 - 1e-3, 2e-5);
  PressForward forward(soft_block(), m);
  const std::vector<Vec3> force = forward({8e3, 0.45, 0.5});
  const double hertz = 4.0 / 3 * 8e3 / (1 - 0.45 * 0.45) * std::sqrt(8e-3) * std::pow(1e-3, 1.5);
  EXPECT_NEAR(force[0].x / hertz, 1, 0.06);  // exact sphere and where touching begins, 0.02 mm
}

}  // namespace
}  // namespace palpate::test
