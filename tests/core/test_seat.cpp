// Where the coupling is held when samples come anew: what that leaves as it was, and that bringing the end back to the
// handle never stretches the spring by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rt_core/image.h"
#include "rt_core/safety/seat.h"
#include "rt_core/tick.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

Pose at(Vec3 position_m, Vec3 turn_rad = {}) { return {position_m, small_rotation(turn_rad)}; }

// A tool that is pressed along -z with 1.5 N, by a hand that holds the coupling 1 mm below it.
class Seat : public testing::Test {
 protected:
  Seat() : state_(roomy_state()) {
    model_.params = tiny_params();  // 8.5 N, 1500 N/m
    state_->started = 1;
    state_->device_w = state_->device_previous_w = state_->told_w = at({0, 0, -1e-3});
    state_->safety.mode = Mode::kForce;
    state_->safety.ramp = 1;
    state_->safety.object_w.force_N = {0, 0, 1.5};
    state_->safety.last_good_w.force_N = state_->safety.last_device_w.force_N = {0, 0, 1.5};
  }
  Twist stretch() const { return twist_between(coupling_end(*state_), state_->safety.tool_corrected_w); }
  // The hand goes by `way_m`, the tool stays.
  void go(Vec3 way_m) {
    state_->device_previous_w = state_->device_w;
    state_->device_w.position_m += way_m;
    ease_seat(model_, *state_);
  }
  Model model_;
  StatePtr state_;
};

TEST_F(Seat, AWayThatNobodySawStretchesNothing) {
  const Vec3 before_m = stretch().translation_m;
  seat_anew(model_, *state_, at({1e-3, 0, -4e-3}, {0, 0.05, 0}));
  EXPECT_LT(norm(stretch().translation_m - before_m), 1e-15);
  EXPECT_LT(norm(stretch().rotation_rad), 1e-8);  // to third order of the turn
  EXPECT_EQ(state_->device_w.position_m.z, -4e-3);
  EXPECT_EQ(state_->safety.unpaid_J, 0);  // inwards: the hand worked, if anybody did
  EXPECT_EQ(state_->apart, 1);
}

// Outwards it may have got the whole force on the way; and where the force is gone, what the springs hold is nobody's:
// coupling and object, 1.5 N on 1500 N/m and 3000 N/m in series.
TEST_F(Seat, WhatTheHandMayHaveGotIsNotPaid) {
  seat_anew(model_, *state_, at({0, 0, 1e-3}));
  EXPECT_NEAR(state_->safety.unpaid_J, 1.5 * 2e-3, 1e-12);
  forget_seat(*state_);
  state_->device_w = at({0, 0, -1e-3});
  state_->safety.last_device_w = {};
  state_->safety.stored_J = 1;
  state_->contact_stiffness[14] = 3000;
  seat_anew(model_, *state_, at({0, 0, -2e-3}));
  EXPECT_NEAR(state_->safety.unpaid_J, 0.5 * 1.5 * 1.5 * (1. / 1500 + 1. / 3000), 1e-12);
}

TEST_F(Seat, ComesBackAsTheHandGoesOutAndNotWhileItPresses) {
  seat_anew(model_, *state_, at({0, 0, -4e-3}));
  EXPECT_NEAR(state_->seat_m.z, 3e-3, 1e-15);
  go({0, 0, -5e-4});  // farther in: the end goes with the handle
  EXPECT_NEAR(state_->seat_m.z, 3e-3, 1e-15);
  EXPECT_NEAR(stretch().translation_m.z, 1.5e-3, 1e-15);
  go({0, 0, 1.5e-3});  // out, until the coupling is slack
  EXPECT_NEAR(state_->seat_m.z, 3e-3, 1e-15);
  for (int i = 0; i < 4; ++i) {
    go({0, 0, 5e-4});  // then the end stays at the surface while the handle comes to it
    EXPECT_LT(norm(stretch().translation_m), 1e-15);
  }
  EXPECT_NEAR(state_->seat_m.z, 1e-3, 1e-12);
  go({0, 0, 2e-3});
  EXPECT_EQ(state_->apart, 0);
  EXPECT_EQ(coupling_end(*state_).position_m, state_->device_w.position_m);
}

// In free air a standing hand's end comes home by a quarter of a per cent of the longest stretch a tick.
TEST_F(Seat, ComesBackSlowlyInFreeAir) {
  seat_anew(model_, *state_, at({0, 0, -4e-3}));
  state_->safety.object_w = {};
  state_->safety.tool_corrected_w = coupling_end(*state_);
  const double before_m = norm(state_->seat_m);
  go({});
  EXPECT_NEAR(before_m - norm(state_->seat_m), 0.0025 * 8.5 / 1500, 1e-12);
}

// Whatever way the hand goes and wherever end and tool are: in contact the end's own motion never stores energy.
TEST_F(Seat, ItsOwnMotionStoresNothing) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-3e-3, 3e-3);
  const auto somewhere = [&] { return Vec3{any(random), any(random), any(random)}; };
  for (int i = 0; i < 1000; ++i) {
    forget_seat(*state_);
    state_->safety.tool_corrected_w = at(somewhere(), 20 * somewhere());
    seat_anew(model_, *state_, at(somewhere(), 20 * somewhere()));
    state_->safety.unpaid_J = i % 2 == 0 ? 1e-3 : 0;
    state_->device_previous_w = state_->device_w;
    state_->device_w = moved(state_->device_w, {somewhere(), 20 * somewhere()});
    const Twist before = stretch();
    ease_seat(model_, *state_);
    EXPECT_LE(norm(stretch().translation_m), norm(before.translation_m) + 1e-12);
    EXPECT_LE(norm(stretch().rotation_rad), 1.01 * norm(before.rotation_rad) + 1e-9);  // turns of a Twist are small
  }
}

// 1 mJ that nobody paid is let go by a stretch of 2 mm in so many ticks as a surplus is braked away in, and no more.
TEST_F(Seat, GivesWayToWhatIsNotPaid) {
  seat_anew(model_, *state_, at({0, 0, -4e-3}));
  go({0, 0, -1e-3});
  state_->safety.unpaid_J = 1e-3;
  const double before_m = norm(stretch().translation_m);
  go({});
  const double let_go_J = 1500 * before_m * (before_m - norm(stretch().translation_m));
  EXPECT_NEAR(let_go_J, 1e-3 / 8, 1e-9);
  count_unpaid(*state_, -let_go_J);
  EXPECT_NEAR(state_->safety.unpaid_J, 1e-3 * 7 / 8, 1e-9);
  count_unpaid(*state_, -1);
  EXPECT_EQ(state_->safety.unpaid_J, 0);
}

TEST_F(Seat, IsForgottenAtRest) {
  for (const Mode mode : {Mode::kIdle, Mode::kFault}) {
    state_->safety.mode = Mode::kForce;
    seat_anew(model_, *state_, at({0, 0, -9e-3}));
    EXPECT_EQ(state_->apart, 1);
    state_->safety.mode = mode;
    ease_seat(model_, *state_);
    EXPECT_EQ(state_->apart, 0);
    EXPECT_EQ(norm(state_->seat_m), 0);
  }
}

// The detector: after more than is bridged; after refused samples only where the way is none that the hand was on.
TEST_F(Seat, SamplesComeAnewAfterAGapOrAJump) {
  Input input;
  const Pose near = at({0, 0, -1.1e-3}), far = at({0, 0, -4e-3});
  model_.params.silence_hold_ticks = 3;
  model_.params.acceleration_max_m_per_s2 = 200;  // 1.4 mm in a tick of 1 ms
  EXPECT_FALSE(comes_anew(model_, *state_, input, far));
  state_->unseen_ticks = 3;
  EXPECT_FALSE(comes_anew(model_, *state_, input, far));
  state_->unseen_ticks = 4;
  EXPECT_TRUE(comes_anew(model_, *state_, input, near));
  state_->unseen_ticks = state_->rejected_ticks = 2;
  EXPECT_FALSE(comes_anew(model_, *state_, input, near));
  EXPECT_TRUE(comes_anew(model_, *state_, input, far));
  state_->rejected_ticks = 0;
  input.overrun_ticks = 4;
  EXPECT_TRUE(comes_anew(model_, *state_, input, near));
  input.commands = Command::kStall;  // the simulated device stood still as well
  EXPECT_FALSE(comes_anew(model_, *state_, input, near));
  input.commands = 0;
  state_->safety.mode = Mode::kIdle;
  EXPECT_FALSE(comes_anew(model_, *state_, input, near));
}

// Whole ticks, pressed on the tetrahedron: 1.5 mm farther in after 15 lost samples the force goes on from what was
// commanded, and a copy of the state made in the gap goes on to the same bits with another scratch.
TEST(SeatTick, ACopyMadeInTheGapGoesOnTheSame) {
  ImageBytes image = tiny_image();
  Model model;
  ASSERT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
  const StatePtr state = make_state(model);
  ScratchPtr scratch = make_scratch(model);
  Input input;
  Output output;
  const auto at_depth = [&](double depth_m, std::uint32_t stale) {
    input.pose_w.position_m = {0.01, depth_m - 0.006, 0.012};
    input.stale_ticks = stale;
  };
  const auto next = [&](State& s, Scratch& with) { tick(model, s, with, input, output); };
  for (int i = 0; i < 600; ++i) {  // outside, armed, then in
    at_depth(i < 300 ? -0.02 : -0.02 + 1e-4 * (i - 300), 0);
    input.commands = i > 2 ? Command::kArm : 0;
    next(*state, *scratch);
  }
  const double pressed_N = norm(output.device_w.force_N);
  ASSERT_GT(pressed_N, 0.1);
  for (std::uint32_t lost = 1; lost <= 15; ++lost) {
    at_depth(0.01, lost);
    next(*state, *scratch);
  }
  const double faded_N = norm(output.device_w.force_N);
  EXPECT_LT(faded_N, 0.5 * pressed_N);
  const StatePtr copy = copy_of(*state);
  const ScratchPtr other = make_scratch(model);
  at_depth(0.0115, 0);
  next(*state, *scratch);
  next(*copy, *other);
  EXPECT_NE(output.status & Status::kSeatedAnew, 0u);
  EXPECT_EQ(state->apart, 1);
  EXPECT_NEAR(norm(output.device_w.force_N), faded_N, 0.02 * pressed_N);  // the gain rises by a two hundredth
  for (int i = 0; i < 300; ++i) {
    at_depth(0.0115 - (i < 100 ? 0 : 1e-4 * (i - 100)), 0);
    next(*state, *scratch);
    next(*copy, *other);
    ASSERT_EQ(hash_state(*state), hash_state(*copy)) << i;
  }
}

}  // namespace
}  // namespace palpate::test
