#include <gtest/gtest.h>

#include <limits>

#include "sim_host/view/neighbourhood.h"
#include "tests/deform/deform_scene.h"

namespace palpate {
namespace {

constexpr double kA = 3e-3, kR = 10e-3;
constexpr NeighbourhoodLaw kLaws[] = {NeighbourhoodLaw::kLogPaper, NeighbourhoodLaw::kLogC1, NeighbourhoodLaw::kPunch};

double blend(NeighbourhoodLaw law, double r, double a = kA) {
  return neighbourhood_blend(make_neighbourhood(law, a, kR), {r, 0, 0});
}

TEST(Neighbourhood, WorkedExampleOfTheLogLaw) {
  const LogLaw law = log_law(kA, kR, 4.3577e-3, 0.8e-3);
  EXPECT_NEAR(law.b, 2.954967e-3, 6e-10);
  EXPECT_NEAR(law.a, -1.28081263e-2, 6e-11);
  EXPECT_NEAR(law.a - law.b * std::log(5e-3), 2.848227e-3, 6e-10);
  EXPECT_NEAR(0.8e-3 + (4.3577e-3 - 0.8e-3) * blend(NeighbourhoodLaw::kLogPaper, 5e-3), 2.848227e-3, 6e-10);
}

TEST(Neighbourhood, WorkedBlendsAtFiveMillimetres) {
  EXPECT_NEAR(blend(NeighbourhoodLaw::kLogPaper, 5e-3), .5757167, 6e-8);
  EXPECT_NEAR(blend(NeighbourhoodLaw::kLogC1, 5e-3), .4247780, 6e-8);
  EXPECT_NEAR(blend(NeighbourhoodLaw::kPunch, 5e-3), .4096655, 6e-8);  // 2/pi asin(0.6): half the reach
}

// The formulas in long double through the C library.
TEST(Neighbourhood, AgreesWithDefinitions) {
  const long double a = deform_test::wide(kA), big = deform_test::wide(kR);
  for (int i = 1; i < 100; ++i) {
    const long double r = a + (big - a) * i / 100;
    const auto c1 = [&](long double x) { return std::log(big / x) - 0.5L * (1 - x * x / big / big); };
    const double at = static_cast<double>(r);
    EXPECT_NEAR(blend(NeighbourhoodLaw::kLogPaper, at), static_cast<double>(std::log(big / r) / std::log(big / a)),
                1e-14);
    EXPECT_NEAR(blend(NeighbourhoodLaw::kLogC1, at), static_cast<double>(c1(r) / c1(a)), 1e-14);
    // The half space's out to half of the reach.
    const double punch = static_cast<double>(std::asin(a / r) / std::asin(1.0L));
    if (2 * r <= big) {
      EXPECT_NEAR(blend(NeighbourhoodLaw::kPunch, at), punch, 1e-14);
    }
    EXPECT_LE(blend(NeighbourhoodLaw::kPunch, at), punch + 1e-15);
  }
}

TEST(Neighbourhood, ContinuousAtBothEndsAndFalling) {
  for (const NeighbourhoodLaw law : kLaws) {
    for (const double a : {0.05 * kR, kA, 0.9 * kR}) {
      EXPECT_EQ(blend(law, 0, a), 1);
      EXPECT_EQ(blend(law, a, a), 1);
      EXPECT_EQ(blend(law, kR, a), 0);
      EXPECT_EQ(blend(law, 1.0, a), 0);
      // asin rises like a square root at the punch's edge: 1e-12 outside it, 1e-5 below one.
      EXPECT_NEAR(blend(law, a * (1 + 1e-12), a), 1, 1e-5);
      EXPECT_NEAR(blend(law, kR * (1 - 1e-12), a), 0, 1e-10);
      double last = 1;
      for (int i = 1; i <= 1000; ++i) {
        const double g = blend(law, a + (kR - a) * i / 1000, a);
        EXPECT_LE(g, last);
        EXPECT_GE(g, 0);
        last = g;
      }
    }
  }
}

TEST(Neighbourhood, C1LawHasNoKinkAtTheReach) {
  const double h = 1e-6 * kR;
  const auto slope = [&](NeighbourhoodLaw law) { return blend(law, kR - h) / h * kR; };
  EXPECT_LT(slope(NeighbourhoodLaw::kLogC1), 3e-6);
  EXPECT_GT(slope(NeighbourhoodLaw::kLogPaper), 0.8);  // 1 / ln(R/a) = 0.83: the paper's law has one
}

TEST(Neighbourhood, DegenerateRadiiSwitchTheLawOff) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const NeighbourhoodLaw law : kLaws) {
    for (const double a : {0.0, -1e-3, 0.95 * kR, kR, nan}) EXPECT_EQ(blend(law, 1e-3, a), 0);
    EXPECT_EQ(neighbourhood_blend(make_neighbourhood(law, kA, 0), {}), 0);
    EXPECT_EQ(neighbourhood_blend(make_neighbourhood(law, kA, nan), {}), 0);
    EXPECT_EQ(blend(law, nan), 0);
  }
  EXPECT_EQ(blend(NeighbourhoodLaw::kNone, 0), 0);
  EXPECT_EQ(log_law(kR, kR, 2, 1).b, 0);
  EXPECT_EQ(log_law(0, kR, 2, 1).a, 1);
}

TEST(Neighbourhood, ContactRadiusFollowsTheAreaWithinItsClip) {
  const double pi = palpate::kPi;
  EXPECT_NEAR(contact_radius_m(pi * kA * kA, kR), kA, 1e-17);
  EXPECT_DOUBLE_EQ(contact_radius_m(1.0, kR), 0.9 * kR);
  EXPECT_DOUBLE_EQ(contact_radius_m(0, kR), 0.05 * kR);
  EXPECT_DOUBLE_EQ(contact_radius_m(-1, kR), 0.05 * kR);
  EXPECT_DOUBLE_EQ(contact_radius_m(std::numeric_limits<double>::quiet_NaN(), kR), 0.05 * kR);
}

TEST(Neighbourhood, LargerRegionsMakeShallowerDents) {
  EXPECT_EQ(region_size_factor(1e-6, 4e-6), 1);
  EXPECT_EQ(region_size_factor(4e-6, 4e-6), 1);
  EXPECT_DOUBLE_EQ(region_size_factor(16e-6, 4e-6), 0.5);
  EXPECT_EQ(region_size_factor(0, 4e-6), 1);
  EXPECT_EQ(region_size_factor(4e-6, 0), 1);
  EXPECT_EQ(region_size_factor(std::numeric_limits<double>::quiet_NaN(), 4e-6), 1);
  // On a uniform mesh of patches A_ref it is the paper's count: 1/sqrt(n).
  for (int n = 1; n < 20; ++n) EXPECT_NEAR(region_size_factor(n * 2e-6, 2e-6), 1 / std::sqrt(n), 1e-15);
}

}  // namespace
}  // namespace palpate
