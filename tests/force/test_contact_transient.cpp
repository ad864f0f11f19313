// What rings at a touch: the sinusoid that is stated, once a touch, and nothing where the scene states none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "config/bake/time_params.h"
#include "rt_core/safety/contact_transient.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

constexpr double kPeriod_s = 1e-3, kMost_N = 8.5;

ModelParams ringing(const TransientDesc& transient) {
  ModelParams p = tiny_params();  // 1 kHz, 8.5 N
  set_transient(transient, kPeriod_s, p);
  return p;
}

class ContactTransient : public testing::Test {
 protected:
  ContactTransient() { model_.params = ringing({2, 100, 60}); }
  void SetUp() override { ASSERT_EQ(model_.params.period_s, kPeriod_s); }

  // A tick in which the hand comes in at `speed` against a slanted face, touching it or not; what was added, along the
  // face's normal, to a coupling's force of `coupling_N`.
  double tick(bool touches, double speed = 0.3, double coupling_N = 5) {
    state_->hand_velocity_m_per_s = -speed * normal_;
    scratch_->contact_wrench_w.force_N = touches ? 4 * normal_ : Vec3{};
    Vec3 force_N = touches ? coupling_N * normal_ : Vec3{};
    const Vec3 before_N = force_N;
    ring(model_, *state_, *scratch_, force_N);
    state_->safety.object_w = scratch_->contact_wrench_w;  // as the account does after it
    const Vec3 added_N = force_N - before_N;
    EXPECT_NEAR(norm(added_N - dot(added_N, normal_) * normal_), 0, 1e-12);
    return dot(added_N, normal_);
  }
  // A exp(-decay t) sin(2 pi f t), `ticks` after the last without contact.
  static double stated_N(double speed, int ticks) {
    const double t = kPeriod_s * ticks;
    return 2 * speed * std::exp(-60 * t) * std::sin(2 * std::numbers::pi * 100 * t);
  }
  int ticks() const { return model_.params.transient_ticks; }

  Model model_;
  StatePtr state_ = roomy_state();
  ScratchPtr scratch_ = roomy_scratch();
  const Vec3 normal_ = unit_or({1, 2, 3}, {});
};

TEST_F(ContactTransient, IsTheDecayingSinusoidThatIsStated) {
  EXPECT_EQ(ticks(), 77);  // ln 100 / 60 s
  tick(false);
  for (int i = 1; i <= ticks(); ++i) EXPECT_NEAR(tick(true), stated_N(0.3, i), 1e-12) << i;
  for (int i = 0; i < 50; ++i) EXPECT_EQ(tick(true), 0) << i;  // a hundredth was left
}

TEST_F(ContactTransient, BeginsOnceATouch) {
  tick(false);
  for (int i = 1; i < 20; ++i) tick(true);
  for (int i = 20; i < 30; ++i) EXPECT_EQ(tick(false), 0);  // nothing pushes a tool that touches nothing
  for (int i = 30; i <= ticks(); ++i) EXPECT_NEAR(tick(true, 0.5), stated_N(0.3, i), 1e-12) << i;  // still the first
  for (int i = 0; i < 20; ++i) EXPECT_EQ(tick(true, 0.5), 0);  // rested on, however it moves
  tick(false);
  EXPECT_NEAR(tick(true, 0.2), stated_N(0.2, 1), 1e-12);
}

// Slower than 10 mm/s, which an encoder's step can look like, or from behind: no touch.
TEST_F(ContactTransient, IsNotOfAHandAtRest) {
  for (const double speed : {0.009, 0.0, -0.3}) {
    tick(false, speed);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(tick(true, speed), 0) << speed;
  }
}

TEST_F(ContactTransient, NeverTurnsTheForceRound) {
  tick(false);
  double least = 0;
  for (int i = 1; i <= ticks(); ++i) {
    const double added_N = tick(true, 0.3, 0.1);
    EXPECT_GE(added_N, -0.1 * (1 + 1e-12)) << i;
    least = std::min(least, added_N);
  }
  EXPECT_NEAR(least, -0.1, 1e-12);
}

TEST_F(ContactTransient, IsNothingWhereNoneIsStated) {
  model_.params = tiny_params();
  const std::uint64_t before = hash_state(*state_);
  state_->hand_velocity_m_per_s = {0, 0, -0.3};
  scratch_->contact_wrench_w.force_N = {0, 0, 4};
  Vec3 force_N{0.1, 0.2, 5};
  ring(model_, *state_, *scratch_, force_N);
  EXPECT_EQ(force_N, (Vec3{0.1, 0.2, 5}));
  state_->hand_velocity_m_per_s = {};
  EXPECT_EQ(hash_state(*state_), before);
}

// Whatever bits a memory that failed holds: a finite force, and an end.
TEST_F(ContactTransient, OfASpoiltStateEnds) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    for (const std::int32_t left : {-5, 3, 2'000'000'000}) {
      state_->safety.ring_N = state_->safety.ring_before_N = {value, value, value};
      state_->safety.ring_ticks = left;
      for (int i = 0; i <= ticks(); ++i) EXPECT_TRUE(std::isfinite(tick(true)));
      EXPECT_EQ(state_->safety.ring_ticks, 0);
      EXPECT_EQ(state_->safety.ring_N, Vec3{});
    }
  }
}

// However high, frequent and long it is stated: no tick changes it by more than 5 % of the largest force, and one that
// is high enough to be lowered comes near to that.
TEST(ContactTransientSteps, AreBounded) {
  for (const double frequency_Hz : {1.0, 18.0, 60.0, 100.0, 300.0, 400.0})
    for (const double decay_per_s : {1.0, 30.0, 90.0, 1000.0, 1e4}) {
      Model model;
      model.params = ringing({1e5, frequency_Hz, decay_per_s});
      const StatePtr state = roomy_state();
      const ScratchPtr scratch = roomy_scratch();
      state->hand_velocity_m_per_s = {0, 0, -1};
      scratch->contact_wrench_w.force_N = {0, 0, 1};
      double last = 0, step = 0;
      for (int i = 0; i <= model.params.transient_ticks; ++i) {
        Vec3 force_N{0, 0, 100};
        ring(model, *state, *scratch, force_N);
        state->safety.object_w = scratch->contact_wrench_w;
        step = std::max(step, std::abs(force_N.z - 100 - last));
        last = force_N.z - 100;
      }
      EXPECT_LE(step, 0.05 * kMost_N * (1 + 1e-9)) << frequency_Hz << " Hz, " << decay_per_s;
      if (frequency_Hz >= 18 && decay_per_s <= 90) {
        EXPECT_GT(step, 0.03 * kMost_N) << frequency_Hz << " Hz, " << decay_per_s;
      }
    }
}

}  // namespace
}  // namespace palpate::test
