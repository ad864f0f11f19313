// What couples the regions of an elastic body, four at a time, against plain sums.
#include <gtest/gtest.h>

#include "config/elastic/fixed_random.h"
#include "rt_core/contact/elastic/pair_lanes.h"

namespace palpate {
namespace {

elastic::FixedRandom random_numbers(11);
Real uniform() { return random_numbers.symmetric(); }

// A symmetric matrix of `n` with at least `least` in every direction: B B' + least.
void fill_positive(std::int32_t n, Real least, Real (&a)[kMaxRegions][kMaxRegions]) {
  Real b[kMaxRegions][kMaxRegions];
  for (auto& row : b)
    for (Real& x : row) x = uniform();
  for (std::int32_t i = 0; i < kMaxRegions; ++i) {
    for (std::int32_t j = 0; j < kMaxRegions; ++j) {
      const bool inside = i < n && j < n;
      a[i][j] = inside && i == j ? least : 0;
      for (std::int32_t k = 0; inside && k < n; ++k) a[i][j] += b[i][k] * b[j][k];
    }
  }
}

TEST(FactorLanes, SolvesSystemsOfEverySize) {
  for (std::int32_t n = 1; n <= kMaxRegions; ++n) {
    Real a[kMaxRegions][kMaxRegions], x[kMaxRegions] = {}, asked[kMaxRegions] = {};
    fill_positive(n, 0.5, a);
    FactorLanes factor;
    for (std::int32_t j = 0; j < kMaxRegions; ++j)
      for (std::int32_t i = 0; i < kMaxRegions; ++i) factor.column[j][i] = a[j][i];
    ASSERT_TRUE(factor.factor(n)) << n;
    for (std::int32_t i = 0; i < n; ++i) x[i] = asked[i] = uniform();
    factor.solve(n, x);
    for (std::int32_t i = 0; i < n; ++i) {
      Real sum = 0;
      for (std::int32_t j = 0; j < n; ++j) sum += a[i][j] * x[j];
      EXPECT_NEAR(sum, asked[i], 1e-13 * n) << n;  // rounding, with a condition of about n^2
    }
    for (std::int32_t i = n; i < kMaxRegions; ++i) EXPECT_EQ(x[i], 0) << n;
  }
}

TEST(FactorLanes, RefusesWhatIsNotPositive) {
  for (std::int32_t bad = 0; bad < 7; ++bad) {
    FactorLanes factor;
    Real a[kMaxRegions][kMaxRegions];
    fill_positive(7, 0.5, a);
    a[bad][bad] = bad % 2 == 0 ? -1 : kHuge * kHuge * kHuge;
    for (std::int32_t j = 0; j < kMaxRegions; ++j)
      for (std::int32_t i = 0; i < kMaxRegions; ++i) factor.column[j][i] = a[j][i];
    EXPECT_FALSE(factor.factor(7)) << bad;
  }
}

// W = sum_{i<j} c_ij F_i F_j + sum_{i != j} h_ij F_i^2 F_j / 2.
Real energy(const PairLanes& pair, std::int32_t n, const Real* f) {
  Real sum = 0;
  for (std::int32_t i = 0; i < n; ++i)
    for (std::int32_t j = 0; j < n; ++j)
      if (i != j) sum += 0.5 * pair.c_m_per_N[i][j] * f[i] * f[j] + 0.5 * pair.h_m_per_N2[i][j] * f[i] * f[i] * f[j];
  return sum;
}

TEST(PairLanes, SlopesAndBendsAreThoseOfTheEnergy) {
  constexpr Real kStep = 1e-4;  // of forces of one: central differences of a cubic are off by its square, times h
  for (std::int32_t n = 2; n <= kMaxRegions; ++n) {
    PairLanes pair = {};
    Real f[kMaxRegions] = {};
    for (std::int32_t i = 0; i < n; ++i) {
      f[i] = uniform();
      for (std::int32_t j = 0; j < n; ++j) {
        if (i == j) continue;
        pair.c_m_per_N[i][j] = pair.c_m_per_N[j][i] = uniform();
        pair.h_m_per_N2[i][j] = pair.h_across_m_per_N2[j][i] = uniform();
      }
    }
    Real slope[kMaxRegions], bend[kMaxRegions];
    pair.slopes(n, f, slope, bend);
    const auto moved = [&](std::int32_t i, Real by_i, std::int32_t j, Real by_j) {
      Real at[kMaxRegions];
      for (std::int32_t k = 0; k < kMaxRegions; ++k) at[k] = f[k];
      at[i] += by_i;
      at[j] += by_j;
      return energy(pair, n, at);
    };
    for (std::int32_t i = 0; i < n; ++i) {
      EXPECT_NEAR(slope[i], (moved(i, kStep, i, 0) - moved(i, -kStep, i, 0)) / (2 * kStep), 1e-9);
      const Real second = moved(i, kStep, i, 0) - 2 * energy(pair, n, f) + moved(i, -kStep, i, 0);
      EXPECT_NEAR(bend[i], second / (kStep * kStep), 1e-5);  // rounding of the energy over the step's square
      for (std::int32_t j = 0; j < n; ++j) {
        if (i == j) continue;
        const Real mixed = moved(i, kStep, j, kStep) - moved(i, kStep, j, -kStep) - moved(i, -kStep, j, kStep) +
                           moved(i, -kStep, j, -kStep);
        const std::int32_t b = i / kRegionLanes * kRegionLanes;
        EXPECT_NEAR(pair.bends(f, j, b)[i - b], mixed / (4 * kStep * kStep), 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace palpate
