// Relaxation of the body against closed forms: a step held, a load held (creep), a slow and a fast press; and that it
// cannot give energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "rt_core/contact/relaxation.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

constexpr double kStiffness = 1000, kPeriod_s = 1e-3;
constexpr double kShare[3] = {0.3, 0.2, 0.1}, kTime_s[3] = {0.05, 0.5, 2};

// One elastic law F = k x^(power) relaxed tick by tick.
class Relaxed {
 public:
  explicit Relaxed(double power = 1) : power_(power) {
    model_.params = test::tiny_params();
    ModelParams& p = model_.params;
    p.relax_share_1 = kShare[0], p.relax_share_2 = kShare[1], p.relax_share_3 = kShare[2];
    p.relax_kept_1 = std::exp(-kPeriod_s / kTime_s[0]);
    p.relax_kept_2 = std::exp(-kPeriod_s / kTime_s[1]);
    p.relax_kept_3 = std::exp(-kPeriod_s / kTime_s[2]);
  }
  // Force at `depth` in this tick.
  double press(double depth_m) {
    const double x = std::max(0.0, depth_m);
    scratch_->contact_wrench_w.force_N = {0, 0, kStiffness * std::pow(x, power_)};
    scratch_->energy_J = kStiffness * std::pow(x, power_ + 1) / (power_ + 1);
    relax(model_, *state_, *scratch_);
    return scratch_->contact_wrench_w.force_N.z;
  }
  double stored_J() const { return scratch_->energy_J; }
  void keep_one_term() { model_.params.relax_share_2 = model_.params.relax_share_3 = 0; }
  void keep_no_term() { keep_one_term(), model_.params.relax_share_1 = 0; }
  void lose(double share) { model_.params.lost_share = share; }
  // Presses as deep as this tick's force is `load_N`.
  double depth_under(double load_N) {
    const Vec3 memory = state_->relaxed_rootJ;
    double low = 0, high = 0.1;
    for (int i = 0; i < 60; ++i) {
      state_->relaxed_rootJ = memory;
      const double middle = 0.5 * (low + high);
      (press(middle) < load_N ? low : high) = middle;
    }
    return high;
  }

 private:
  double power_;
  Model model_;
  StatePtr state_ = test::roomy_state();
  ScratchPtr scratch_ = test::roomy_scratch();
};

double held_share(double time_s) {
  double share = 1;
  for (int i = 0; i < 3; ++i) share -= kShare[i] * (1 - std::exp(-time_s / kTime_s[i]));
  return share;
}

TEST(Relaxation, OfAStepIsThePronySeriesWhateverTheLaw) {
  for (const double power : {1.0, 1.5, 3.0}) {
    Relaxed body(power);
    const double full = kStiffness * std::pow(0.004, power);
    for (int i = 1; i <= 4000; ++i)
      EXPECT_NEAR(body.press(0.004) / full, held_share(i * kPeriod_s), 1e-9) << power << " " << i;
  }
}

// Under a load held the body creeps: with one term of share g the compliance goes from 1 / k to 1 / (k (1 - g)), with
// the retardation time tau / (1 - g).
TEST(Relaxation, OfALoadHeldIsCreep) {
  Relaxed body;
  body.keep_one_term();
  const double load_N = 2, g = kShare[0], late_s = kTime_s[0] / (1 - g);
  double deep = 0;
  for (int i = 1; i <= 1000; ++i) {
    deep = body.depth_under(load_N);
    const double expected = load_N / kStiffness * (1 + g / (1 - g) * (1 - std::exp(-i * kPeriod_s / late_s)));
    EXPECT_NEAR(deep / expected, 1, 0.01) << i;  // a tick is 2 % of the time constant
  }
  EXPECT_NEAR(deep, load_N / (kStiffness * (1 - g)), 1e-8);
}

TEST(Relaxation, LeavesASurfaceBehindThatComesBack) {
  Relaxed body;
  for (int i = 0; i < 10000; ++i) body.press(0.004);
  EXPECT_EQ(body.press(0.001), 0);  // not there yet: it pulls nothing
  EXPECT_GT(body.press(0.003), 0);
  for (int i = 0; i < 100000; ++i) body.press(0);
  EXPECT_NEAR(body.press(0.001), kStiffness * 0.001, 0.01);  // recovered; 0.7 % relaxes within the tick
}

// Whatever a hand does, it gets no more than it gave, on a linear and on a stiffening law: the midpoint rule over a
// path of small steps, against what is stored.
TEST(Relaxation, GivesNoEnergy) {
  std::mt19937 random(5);
  for (const double power : {1.0, 3.0}) {
    Relaxed body(power);
    double depth = 0, goal = 0, given_J = 0, force = body.press(0);
    for (int i = 0; i < 200000; ++i) {
      if (i % 400 == 0) goal = 1e-3 * static_cast<double>(random() % 6);
      const double speed = i % 800 < 400 ? 2e-6 : 2e-5;
      const double next = depth + std::clamp(goal - depth, -speed, speed);
      const double pushed = body.press(next);
      given_J += 0.5 * (force + pushed) * (next - depth);
      depth = next, force = pushed;
      // One step of rectangles is worth at most its rise of force times its length, here 1e-7 J.
      ASSERT_GE(given_J, -1e-7) << power << " " << i;
    }
    EXPECT_GT(given_J, body.stored_J()) << power;  // some of it is gone
  }
}

// Loss at any rate: loading as without, unloading softer by one factor after the turn, a round trip loses the stated
// share of the press's work, whatever the law and the speed, and what turns half way has a loop of its own.
TEST(Relaxation, AtAnyRateLosesItsShareOfAPress) {
  for (const double power : {1.0, 1.5, 3.0})
    for (const double step_m : {1e-6, 4e-6}) {
      Relaxed body(power);
      body.keep_no_term();
      body.lose(0.2);
      const auto ticks = static_cast<int>(std::llround(0.004 / step_m));
      double in_J = 0, out_J = 0, before = 0;
      for (int i = 1; i <= ticks; ++i) {
        const double force = body.press(i * step_m);
        EXPECT_NEAR(force, kStiffness * std::pow(i * step_m, power), 1e-12 * kStiffness);
        in_J += 0.5 * (force + before) * step_m;
        before = force;
      }
      for (int i = ticks - 1; i >= 0; --i) {
        const double force = body.press(i * step_m);
        EXPECT_LE(force, before + 1e-12);  // never up while it goes out
        out_J += 0.5 * (force + before) * step_m;
        before = force;
      }
      EXPECT_EQ(before, 0);
      EXPECT_NEAR((in_J - out_J) / in_J, 0.2, 2e-3);  // the trapezoids' error at the kinks of the turn
      EXPECT_NEAR(body.stored_J(), 0, 1e-15);
    }
}

TEST(Relaxation, LossGivesNoEnergyOnAnyWay) {
  std::mt19937 random(7);
  for (const bool relaxes : {false, true}) {
    Relaxed body(1.5);
    if (!relaxes) body.keep_no_term();
    body.lose(0.2);
    double depth = 0, goal = 0, given_J = 0, force = body.press(0);
    for (int i = 0; i < 200000; ++i) {
      if (i % 400 == 0) goal = 1e-3 * static_cast<double>(random() % 6);
      const double next = depth + std::clamp(goal - depth, -2e-5, 2e-5);
      const double pushed = body.press(next);
      given_J += 0.5 * (force + pushed) * (next - depth);
      depth = next, force = pushed;
      ASSERT_GE(given_J, -1e-7) << i;
    }
    EXPECT_GT(given_J, body.stored_J());
  }
}

TEST(Relaxation, CostsAndChangesNothingWithoutTerms) {
  Relaxed body;
  body.keep_no_term();
  for (int i = 0; i < 10; ++i) EXPECT_EQ(body.press(0.004), kStiffness * 0.004);
}

}  // namespace
}  // namespace palpate
