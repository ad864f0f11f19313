// Contact law: worked values, inverse, tangent continuation, degenerate laws and the derivations the baker uses.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "config/bake/contact_fit.h"
#include "rt_core/contact/cubic_law.h"
#include "rt_core/contact/cubic_law_lanes.h"

namespace palpate {
namespace {

const CubicLaw kPaperLaw{40, 3e8, kHuge};
const CubicLaw kShort{40, 3e8, 4e-3};
constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

TEST(CubicLaw, WorkedValues) {
  const Real force[5] = {0.34, 2.48, 8.22, 19.36, 37.7};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(law_force_N(kPaperLaw, 1e-3 * (i + 1)), force[i], 1e-12 * force[i]);
  EXPECT_NEAR(law_tangent_N_per_m(kPaperLaw, 4.36e-3), 17148.64, 1e-9);
  EXPECT_NEAR(law_energy_J(kPaperLaw, 4.357727104419091e-3), 0.02742569226, 1e-11);
}

TEST(CubicLaw, InverseWorkedValues) {
  const struct {
    Real force_N, depth_m;
  } cases[] = {{1e-6, 2.49999998828125e-8}, {1e-3, 2.48844301989412e-5}, {0.01, 1.9467015955123876e-4},
               {0.1, 6.294605751665613e-4}, {1, 1.464053019236961e-3},   {8.5, 3.034012854410961e-3},
               {10, 3.204488111562214e-3},  {25, 4.357727104419091e-3},  {1000, 1.493504056434064e-2}};
  for (const auto& c : cases) EXPECT_NEAR(law_depth_m(kPaperLaw, c.force_N), c.depth_m, 2e-15 * c.depth_m);
}

TEST(CubicLaw, InverseOverAllScales) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<Real> k1(-6, 6), k3(-6, 12), force(-9, 6);
  Real worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const CubicLaw law{std::pow(10, k1(random)), std::pow(10, k3(random)), kHuge};
    const Real target = std::pow(10, force(random));
    const auto d = static_cast<long double>(law_depth_m(law, target)), f = static_cast<long double>(target);
    // Error of the root = residual over slope, in extended precision.
    const auto p = static_cast<long double>(law.k1_N_per_m), q = static_cast<long double>(law.k3_N_per_m3);
    const long double error = (p * d + q * d * d * d - f) / (p + 3 * q * d * d) / d;
    worst = std::max(worst, static_cast<Real>(std::abs(error)));
  }
  EXPECT_LT(worst, 1e-15);                                                  // five Newton steps reach rounding: 4 ulp
  EXPECT_LT(std::abs(law_depth_m({1e9, 1e-300, kHuge}, 1) - 1e-9), 1e-24);  // nothing overflows
  EXPECT_NEAR(law_depth_m({1e-300, 1e15, kHuge}, 1), 1e-5, 1e-19);
}

// With and without a range, beyond it, without a force, and where one by one is asked for.
TEST(CubicLaw, InversesOfFourAreTheSameToTheBit) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<Real> k1(-3, 6), k3(-3, 12), depth(-6, -1), force(-9, 6);
  for (int i = 0; i < 20000; ++i) {
    const CubicLaw law{i % 7 == 0 ? 0.0 : std::pow(10, k1(random)), i % 11 == 0 ? 0.0 : std::pow(10, k3(random)),
                       i % 5 == 0 ? kHuge : std::pow(10, depth(random))};
    Double4 target{};
    for (int k = 0; k < 4; ++k) target[k] = std::pow(10, force(random));
    target[i % 4] = i % 3 == 0 ? -target[i % 4] : i % 3 == 1 ? target[i % 4] : std::nan("");
    const Double4 four = law_depth_m(law, target);
    for (int k = 0; k < 4; ++k) ASSERT_EQ(four[k], law_depth_m(law, target[k])) << i << ' ' << k;
  }
}

TEST(CubicLaw, ContinuesByItsTangentBeyondTheRange) {
  const Real edge = law_force_N(kPaperLaw, 4e-3), slope = law_tangent_N_per_m(kPaperLaw, 4e-3);
  EXPECT_DOUBLE_EQ(law_force_N(kShort, 4e-3), edge);
  EXPECT_NEAR(law_force_N(kShort, 6e-3), edge + 2e-3 * slope, 1e-12);
  EXPECT_DOUBLE_EQ(law_tangent_N_per_m(kShort, 6e-3), slope);
  EXPECT_NEAR(law_energy_J(kShort, 6e-3), law_energy_J(kPaperLaw, 4e-3) + 2e-3 * edge + 0.5 * 4e-6 * slope, 1e-15);
  for (const Real depth : {1e-4, 3.999e-3, 4e-3, 4.001e-3, 6e-3, 1.0}) {
    EXPECT_NEAR(law_depth_m(kShort, law_force_N(kShort, depth)), depth, 1e-14 * depth + 1e-17);
  }
}

TEST(CubicLaw, EnergyIsTheIntegralOfTheForce) {
  const Real h = 1e-7;
  for (const Real depth : {5e-4, 2e-3, 3.9e-3, 4.1e-3, 7e-3}) {
    const Real slope = (law_energy_J(kShort, depth + h) - law_energy_J(kShort, depth - h)) / (2 * h);
    EXPECT_NEAR(slope, law_force_N(kShort, depth), 1e-6);  // h^2 k3 + rounding 1e-17/h
    const Real tangent = (law_force_N(kShort, depth + h) - law_force_N(kShort, depth - h)) / (2 * h);
    EXPECT_NEAR(tangent, law_tangent_N_per_m(kShort, depth), 1e-3);
  }
}

TEST(CubicLaw, DegenerateLawsAndArguments) {
  EXPECT_EQ(law_depth_m({40, 0, kHuge}, 1), 0.025);
  EXPECT_NEAR(law_depth_m({0, 3e8, kHuge}, 0.3), 1e-3, 1e-18);
  EXPECT_EQ(law_depth_m({0, 0, kHuge}, 1), 0);
  EXPECT_EQ(law_depth_m({0, 0, 0.01}, 1), 0);
  for (const Real bad : {0.0, -1.0, -kInfinity, kNan}) {
    EXPECT_EQ(law_force_N(kPaperLaw, bad), 0);
    EXPECT_EQ(law_tangent_N_per_m(kPaperLaw, bad), 0);
    EXPECT_EQ(law_energy_J(kPaperLaw, bad), 0);
    EXPECT_EQ(law_depth_m(kPaperLaw, bad), 0);
  }
  EXPECT_TRUE(std::isfinite(law_force_N(kShort, kInfinity)));
  EXPECT_TRUE(std::isfinite(law_depth_m(kShort, kInfinity)));
}

TEST(Duffing, PaperParametersInMillimetresAndNewtons) {
  DuffingDesc object;
  object.mass_kg = 1;
  object.omega0 = 0.2;
  object.beta0sq_eps = 0.4;
  object.coefficient = DuffingCoefficient::kPaper;
  const ContactCoefficients paper = duffing_paper_coefficients(object);
  EXPECT_NEAR(paper.k1_N_per_m, 40, 1e-12);
  EXPECT_NEAR(paper.k3_N_per_m3, 3e8, 1e-5);
  EXPECT_NEAR(law_depth_m({paper.k1_N_per_m, paper.k3_N_per_m3, kHuge}, 25), 4.35773e-3, 1e-8);
  object.coefficient = DuffingCoefficient::kStatic;
  const ContactCoefficients settled = duffing_paper_coefficients(object);
  // Where a constant 25 N on the damped oscillator comes to rest (integrated separately): 3.96010 mm.
  EXPECT_NEAR(law_depth_m({settled.k1_N_per_m, settled.k3_N_per_m3, kHuge}, 25), 3.96010e-3, 1e-8);
  object.mass_kg = 0.1;
  object.coefficient = DuffingCoefficient::kPaper;
  const ContactCoefficients finger = duffing_paper_coefficients(object);
  EXPECT_NEAR(finger.k1_N_per_m, 4, 1e-12);
  EXPECT_NEAR(finger.k3_N_per_m3, 3e7, 1e-6);
}

TEST(Duffing, HertzFit) {
  const ContactCoefficients fit = hertz_coefficients(3e6, 0.47, 0.02, 4e-3);
  EXPECT_NEAR(fit.k1_N_per_m, 34440.785175, 1e-6);
  EXPECT_NEAR(fit.k3_N_per_m3, 7.17516357816e8, 1e-3);
  const CubicLaw law{fit.k1_N_per_m, fit.k3_N_per_m3, kHuge};
  EXPECT_NEAR(law_force_N(law, 4e-3), 183.684187601, 1e-9);
  const Real c = 4.0 / 3.0 * 3850596.8425 * std::sqrt(0.02);
  Real worst = 0;
  for (int i = 1; i <= 1000; ++i) {
    const Real depth = 5e-3 * i / 1000;
    worst = std::max(worst, std::abs(law_force_N(law, depth) - c * std::pow(depth, 1.5)) / 183.684187601);
  }
  EXPECT_LT(worst, 0.068);
  EXPECT_GT(worst, 0.05);  // two-sided: the fit is known not to be better than this
}

}  // namespace
}  // namespace palpate
