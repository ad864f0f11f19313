// The tick's own elementary functions against the C library in extended precision.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "rt_core/math.h"

namespace palpate {
namespace {

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real kLargest = std::numeric_limits<Real>::max();
constexpr Real kSubnormal = std::numeric_limits<Real>::denorm_min();
// Four units in the last place: what the algorithms are designed for; the promise in math.h's users is 1e-14.
constexpr long double kRelative = 5e-16L;

long double relative_error(Real value, long double exact) {
  const long double difference = std::abs(static_cast<long double>(value) - exact);
  return exact == 0 ? difference : difference / std::abs(exact);
}

std::vector<Real> dense_and_random(Real lowest, Real highest, int count, std::uint32_t seed) {
  std::vector<Real> x;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<Real> uniform(lowest, highest);
  for (int i = 0; i <= count; ++i) {
    x.push_back(lowest + (highest - lowest) * i / count);
    x.push_back(uniform(random));
  }
  return x;
}

// Magnitudes from 2^-1020 to 2^1020.
std::vector<Real> all_magnitudes(int count, std::uint32_t seed) {
  std::vector<Real> x;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<Real> exponent(-1020, 1020);
  for (int i = 0; i < count; ++i) x.push_back(std::exp2(exponent(random)));
  return x;
}

template <typename F, typename G>
long double worst(const std::vector<Real>& points, F own, G reference) {
  long double largest = 0;
  for (const Real x : points)
    largest = std::max(largest, relative_error(own(x), reference(static_cast<long double>(x))));
  return largest;
}

TEST(Math, Exp) {
  const auto reference = [](long double x) { return std::exp(x); };
  EXPECT_LT(worst(dense_and_random(-1, 1, 20000, 1), math::exp, reference), kRelative);
  EXPECT_LT(worst(dense_and_random(-700, 700, 20000, 2), math::exp, reference), kRelative);
  EXPECT_EQ(math::exp(0), 1);
  EXPECT_EQ(math::exp(-1e4), 0);
  EXPECT_EQ(math::exp(1e4), kLargest);
  EXPECT_EQ(math::exp(kInfinity), kLargest);
  EXPECT_EQ(math::exp(-kInfinity), 0);
  EXPECT_EQ(math::exp(kNan), 0);
  EXPECT_NEAR(math::exp(-740), 0.0, 1e-300);  // subnormal result
  EXPECT_GT(math::exp(-740), 0);
}

TEST(Math, Log) {
  const auto reference = [](long double x) { return std::log(x); };
  EXPECT_LT(worst(dense_and_random(0.5, 2, 20000, 3), math::log, reference), kRelative);  // the zero at 1 included
  EXPECT_LT(worst(all_magnitudes(20000, 4), math::log, reference), kRelative);
  EXPECT_EQ(math::log(1), 0);
  EXPECT_EQ(math::log(0), -kHuge);
  EXPECT_EQ(math::log(-1), -kHuge);
  EXPECT_EQ(math::log(kNan), -kHuge);
  EXPECT_LT(relative_error(math::log(kSubnormal), std::log(static_cast<long double>(kSubnormal))), kRelative);
  EXPECT_NEAR(math::log(kInfinity), std::log(kLargest), 1e-12);
}

TEST(Math, Pow) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<Real> exponent(-30, 30), wild(-1000, 1000), power(0.5, 1);
  long double worst_any = 0, worst_friction = 0;
  for (int i = 0; i < 40000; ++i) {
    const Real x = std::exp2(wild(random)), y = exponent(random);
    const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    if (exact > 1e-300L && exact < 1e300L) worst_any = std::max(worst_any, relative_error(math::pow(x, y), exact));
    const Real force = std::exp2(exponent(random)), beta = power(random);
    worst_friction = std::max(
        worst_friction, relative_error(math::pow(force, beta),
                                       std::pow(static_cast<long double>(force), static_cast<long double>(beta))));
  }
  EXPECT_LT(worst_any, kRelative);
  EXPECT_LT(worst_friction, kRelative);
  EXPECT_EQ(math::pow(0, 0.75), 0);
  EXPECT_EQ(math::pow(0, 0), 1);
  EXPECT_EQ(math::pow(0, -1), kLargest);
  EXPECT_EQ(math::pow(1, kNan), 1);
  EXPECT_EQ(math::pow(2, kNan), 0);
  EXPECT_EQ(math::pow(kNan, 2), 0);
  EXPECT_EQ(math::pow(-2, 2), 0);  // x >= 0 only: a negative force has no friction limit
  EXPECT_EQ(math::pow(kInfinity, 2), kLargest);
  EXPECT_EQ(math::pow(kInfinity, -2), 0);
  EXPECT_EQ(math::pow(2, kInfinity), kLargest);
  EXPECT_EQ(math::pow(2, -kInfinity), 0);
  EXPECT_EQ(math::pow(2, 10), 1024);
  EXPECT_GT(math::pow(kSubnormal, 0.5), 0);
}

TEST(Math, CubeRoot) {
  const auto reference = [](long double x) { return std::cbrt(x); };
  EXPECT_LT(worst(dense_and_random(-9, 9, 20001, 6), math::cbrt, reference), kRelative);
  EXPECT_LT(worst(all_magnitudes(20000, 7), math::cbrt, reference), kRelative);
  EXPECT_EQ(math::cbrt(0), 0);
  EXPECT_EQ(math::cbrt(-8), -2);
  EXPECT_EQ(math::cbrt(kNan), 0);
  EXPECT_LT(relative_error(math::cbrt(kSubnormal), std::cbrt(static_cast<long double>(kSubnormal))), kRelative);
  EXPECT_TRUE(std::isfinite(math::cbrt(kInfinity)));
  EXPECT_TRUE(std::isfinite(math::cbrt(-kInfinity)));
}

TEST(Math, SineAndCosine) {
  long double worst_absolute = 0, worst_relative = 0;
  for (const Real range : {1.0, 100.0, 1e4}) {
    for (const Real x : dense_and_random(-range, range, 20000, 8)) {
      const long double s = std::sin(static_cast<long double>(x)), c = std::cos(static_cast<long double>(x));
      worst_absolute = std::max({worst_absolute, std::abs(static_cast<long double>(math::sin(x)) - s),
                                 std::abs(static_cast<long double>(math::cos(x)) - c)});
      worst_relative = std::max({worst_relative, relative_error(math::sin(x), s), relative_error(math::cos(x), c)});
    }
  }
  EXPECT_LT(worst_absolute, 2e-16L);
  EXPECT_LT(worst_relative, 1e-14L);  // also next to the zeros, thanks to the three-part reduction
  for (int n = -6000; n <= 6000; n += 7) {
    const Real zero = n * M_PI;  // nearest double: sin of it is the rounding error of n pi
    EXPECT_NEAR(math::sin(zero), static_cast<Real>(std::sin(static_cast<long double>(zero))), 1e-18 + 1e-15 * 1e-12);
  }
  EXPECT_EQ(math::sin(0), 0);
  EXPECT_EQ(math::cos(0), 1);
  EXPECT_EQ(math::sin(kSubnormal), kSubnormal);
  for (const Real bad : {kNan, kInfinity, -kInfinity, 1e300}) {
    EXPECT_EQ(math::sin(bad), 0);
    EXPECT_EQ(math::cos(bad), 1);
  }
  EXPECT_LE(std::abs(math::sin(9e11)), 1);  // outside the stated range: inaccurate but bounded
}

TEST(Math, ArcTangent) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<Real> angle(-M_PI, M_PI), scale(-200, 200);
  long double largest = 0;
  for (int i = 0; i < 40000; ++i) {
    const Real a = angle(random), r = std::exp2(scale(random)), y = r * std::sin(a), x = r * std::cos(a);
    const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    largest = std::max(largest, relative_error(math::atan2(y, x), exact));
  }
  EXPECT_LT(largest, kRelative);
  EXPECT_EQ(math::atan2(0, 0), 0);
  EXPECT_EQ(math::atan2(0, 1), 0);
  EXPECT_EQ(math::atan2(0, -1), M_PI);
  EXPECT_EQ(math::atan2(1, 0), M_PI_2);
  EXPECT_EQ(math::atan2(-1, 0), -M_PI_2);
  EXPECT_EQ(math::atan2(1, 1), M_PI_4);
  EXPECT_EQ(math::atan2(kInfinity, kInfinity), M_PI_4);
  EXPECT_LT(math::atan2(1, kInfinity), 1e-300);
  EXPECT_EQ(math::atan2(kNan, 1), 0);
  EXPECT_EQ(math::atan2(1, kNan), 0);
  EXPECT_EQ(math::atan2(kSubnormal, 1), kSubnormal);
}

TEST(Math, SinesAndCosinesOfFourAreTheSameToTheBit) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<Real> wide(-1e4, 1e4), narrow(-4, 4);
  for (int i = 0; i < 20000; ++i) {
    const Double4 x{narrow(random), wide(random), (i % 12000) * M_PI_4, -1e-9 * i};
    const math::SinCos4 four = math::sin_cos(x);
    for (int k = 0; k < 4; ++k) {
      ASSERT_EQ(four.sin[k], math::sin(x[k])) << x[k];
      ASSERT_EQ(four.cos[k], math::cos(x[k])) << x[k];
    }
  }
  const math::SinCos4 bad = math::sin_cos(Double4{kNan, kInfinity, -kInfinity, 1e5});
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(bad.sin[k], 0);
    EXPECT_EQ(bad.cos[k], 1);
  }
}

TEST(Math, CubeRootsOfFourAreTheSameToTheBit) {
  const std::vector<Real> points = all_magnitudes(20000, 12);
  for (std::size_t i = 0; i + 4 <= points.size(); i += 4) {
    Double4 x{};
    for (int k = 0; k < 4; ++k) x[k] = std::clamp(std::abs(points[i + static_cast<std::size_t>(k)]), 1e-300, 1e300);
    const Double4 four = math::cube_roots(x);
    for (int k = 0; k < 4; ++k) ASSERT_EQ(four[k], math::cbrt(x[k])) << x[k];
  }
}

TEST(Math, ArcSineAndArcCosine) {
  const auto points = dense_and_random(-1, 1, 20001, 10);
  EXPECT_LT(worst(points, math::asin, [](long double x) { return std::asin(x); }), kRelative);
  EXPECT_LT(worst(points, math::acos, [](long double x) { return std::acos(x); }), kRelative);
  EXPECT_EQ(math::asin(2), M_PI_2);
  EXPECT_EQ(math::asin(-2), -M_PI_2);
  EXPECT_EQ(math::acos(1), 0);
  EXPECT_EQ(math::acos(2), 0);
  EXPECT_EQ(math::acos(-3), M_PI);
  EXPECT_EQ(math::asin(kNan), 0);
  EXPECT_EQ(math::acos(kNan), M_PI_2);
  EXPECT_EQ(math::asin(kInfinity), M_PI_2);
}

}  // namespace
}  // namespace palpate
