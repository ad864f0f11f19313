// The handle between two encoder steps: never far from what was told, smooth where the hand is, still where it is
// still.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "rt_core/safety/encoder_observer.h"

namespace palpate {
namespace {

constexpr double kStep_m = 3e-5, kPeriod_s = 1e-3;

struct Followed {
  std::vector<double> error_m, told_error_m;
  double worst_m = 0;
};

template <class Motion>
Followed follow(Motion motion, int ticks, double period_s = kPeriod_s) {
  Followed run;
  double estimate = motion(0), velocity = 0;
  for (int i = 0; i < ticks; ++i) {
    const double x = motion(i * period_s), told = kStep_m * std::floor(x / kStep_m + 0.5);
    estimate += period_s * velocity;
    estimate += observe(observer_gains(kStep_m, period_s), told - estimate, velocity);
    EXPECT_LE(std::abs(estimate - told), kObserverReach * kStep_m * (1 + 1e-9));
    run.error_m.push_back(estimate - x);
    run.told_error_m.push_back(told - x);
    run.worst_m = std::max(run.worst_m, std::abs(estimate - x));
  }
  return run;
}

// How rough: RMS of the second difference, in which a staircase shows and a hand's motion does not.
double roughness(const std::vector<double>& x) {
  double sum = 0;
  for (std::size_t i = x.size() / 2; i + 1 < x.size(); ++i)
    sum += (x[i + 1] - 2 * x[i] + x[i - 1]) * (x[i + 1] - 2 * x[i] + x[i - 1]);
  return std::sqrt(sum);
}

TEST(EncoderObserver, TakesTheStaircaseOutOfATremor) {
  for (const double amplitude : {2e-5, 5e-5, 8e-5, 1.2e-4}) {
    const Followed run = follow([&](double t) { return 1e-5 + amplitude * std::sin(2 * kPi * 9 * t); }, 2000);
    // Measured 2026-11-22: a tenth to a fifteenth; a quarter leaves room for another phase.
    EXPECT_LT(roughness(run.error_m), 0.25 * roughness(run.told_error_m)) << amplitude;
    EXPECT_LT(run.worst_m, 1.3 * kStep_m) << amplitude;
  }
}

TEST(EncoderObserver, IsBoundedInFastMotionAndAtAnyRate) {
  for (const double period_s : {2.5e-4, 1e-3, 2e-3, 2e-2}) {
    const Followed run = follow([](double t) { return 0.005 * std::sin(2 * kPi * 10 * t); }, 2000, period_s);
    EXPECT_LE(run.worst_m, 2 * kStep_m);
  }
  const Followed jump = follow([](double t) { return t < 0.5 ? 0.0 : 4e-3; }, 2000);
  EXPECT_LT(std::abs(jump.error_m.back()), kStep_m);
}

TEST(EncoderObserver, ComesToRest) {
  const Followed run = follow([](double t) { return std::min(t * 0.02, 0.006 + 1.3e-5); }, 2000);
  for (std::size_t i = run.error_m.size() - 200; i + 1 < run.error_m.size(); ++i)
    EXPECT_NEAR(run.error_m[i], run.error_m.back(), 1e-9);
}

TEST(EncoderObserver, ForgetsWhatIsNoNumber) {
  double velocity = std::numeric_limits<double>::quiet_NaN();
  observe(observer_gains(kStep_m, kPeriod_s), 1e-5, velocity);
  EXPECT_EQ(velocity, 0);
}

}  // namespace
}  // namespace palpate
