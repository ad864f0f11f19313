// Random valid tips, layers, curvatures and far fields: every law the baker accepts is zero at zero, never falls, is C1
// and gives back exactly the work done on it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "config/response/tip_bake.h"
#include "config/scene/config_error.h"
#include "rt_core/contact/tips/travel.h"

namespace palpate {
namespace {

struct Drawn {
  std::mt19937_64 random{20261121};
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random); }
  double between(double low, double high) { return low * std::pow(high / low, unit()); }
  // Two principal curvatures of tip and body together, hollow bodies included.
  double radius_m(double tip_m) {
    const double first = (unit() - 0.4) / tip_m, second = (unit() - 0.4) / tip_m;
    return elliptic_radius_m(1 / tip_m + first, 1 / tip_m + second);
  }
  TipDesc tip(int trial) {
    TipDesc tip;
    const double size = between(2e-4, 5e-2);
    tip.indenter.profile = static_cast<TipProfile>(trial % 4);
    tip.indenter.radius_m = trial % 4 == 0 ? size : radius_m(size);
    tip.indenter.tan_half_angle = std::tan(0.1 + 1.4 * unit());
    tip.modulus_Pa = between(1e3, 1e8);
    tip.depth_max_m = tip.indenter.radius_m * (0.02 + 0.97 * unit());
    if (unit() < 0.6)
      tip.layer = {tip.depth_max_m * between(1.1, 30), 0.5 * unit(),
                   unit() < 0.5 ? LayerBase::kBonded : LayerBase::kSlip};
    return tip;
  }
};

struct Point {
  double force_N, tangent_N_per_m, energy_J;
};
Point at(const TipLaw& law, const LocalLaw& local, double depth_m) {
  const Tip tip{local, {}, TipKind::kPower, depth_m};
  const TipRegion region{&tip, 1, {law.c0_m_per_N, law.c1_m_per_N2, law.force_max_N}};
  const double e = depth_m - solve_travel(region).shift_m;
  const LawPoint point = local_at(local, e);
  return {point.force_N,
          point.tangent_N_per_m / (1 + far_slope_m_per_N(region.far, point.force_N) * point.tangent_N_per_m),
          tip_energy_J(tip, e) + far_energy_J(region.far, point.force_N)};
}

void check_curve(const TipLaw& law, const LocalLaw& local, int trial) {
  // Travel at the end of the law's range, and a quarter beyond it.
  const double range =
      law.depth_max_m + law.c0_m_per_N * law.force_max_N + law.c1_m_per_N2 * law.force_max_N * law.force_max_N;
  ASSERT_GT(range, 0) << trial;
  const double scale = law.force_max_N;
  EXPECT_EQ(at(law, local, 0).force_N, 0);
  EXPECT_EQ(at(law, local, -range).force_N, 0);
  Point last{0, 0, 0};
  double work = 0;
  constexpr int kSteps = 300;
  for (int i = 1; i <= kSteps; ++i) {
    const double d = 1.25 * range * i / kSteps, h = 1.25 * range / kSteps, half = d - 0.5 * h;
    const Point here = at(law, local, d);
    ASSERT_TRUE(std::isfinite(here.force_N) && std::isfinite(here.energy_J)) << trial;
    EXPECT_GE(here.force_N, last.force_N) << trial << " at " << d;
    // Simpson's rule; a flat punch starts with a corner at zero, the first step is left to its energy.
    work += i == 1 ? here.energy_J : h / 6 * (last.force_N + 4 * at(law, local, half).force_N + here.force_N);
    const double small = 1e-6 * range;
    const double slope = (at(law, local, d + small).force_N - at(law, local, d - small).force_N) / (2 * small);
    // The range's end has a corner in the second derivative only: 1e-3 of the mean stiffness.
    EXPECT_NEAR(slope, here.tangent_N_per_m, 1e-3 * (scale / range + here.tangent_N_per_m)) << trial << " at " << d;
    last = here;
  }
  EXPECT_NEAR(work, last.energy_J, 1e-5 * last.energy_J) << trial;
}

TEST(TipFuzz, AcceptedLawsAreZeroAtZeroMonotoneSmoothAndConservative) {
  Drawn drawn;
  int accepted = 0, refused = 0;
  for (int trial = 0; trial < 60; ++trial) {
    TipDesc tip = drawn.tip(trial);
    std::vector<FactorKnot> factor;
    const TipLaw plain = make_tip_law(tip, factor);
    const double soft = tip.depth_max_m / plain.force_max_N;
    tip.c0_m_per_N = soft * (1.5 * drawn.unit() - 0.4);
    tip.c1_m_per_N2 = soft / plain.force_max_N * (drawn.unit() - 0.5);
    factor.clear();
    TipLaw law;
    try {
      law = make_tip_law(tip, factor);
    } catch (const ConfigError&) {
      ++refused;
      continue;
    }
    ++accepted;
    check_curve(law, {&law, law.first_factor < 0 ? nullptr : factor.data()}, trial);
  }
  std::printf("  %d laws, %d refused as unstable\n", accepted, refused);
  EXPECT_GT(accepted, 40);
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace palpate
