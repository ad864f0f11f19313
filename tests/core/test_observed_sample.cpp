// A handle followed by its encoder's edges in the tick: still on an edge, carried over lost samples, near what is told
// whatever its memory holds.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rt_core/safety/seat.h"
#include "rt_core/tick.h"
#include "tests/support/held_handle.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

constexpr double kStep_m = 3e-5, kStep_rad = 1e-3;

class EdgesInTheTick : public testing::Test {
 protected:
  EdgesInTheTick() {
    ModelParams& p = model_.params;
    p = tiny_params();
    p.silence_hold_ticks = 3;
    p.encoder_step_m = kStep_m, p.encoder_step_rad = kStep_rad;
    p.encoder_law_m = p.encoder_law_rad = EncoderLaw::kEdges;
  }
  // Where the handle is taken to be, told within its steps that it is there.
  Pose sample(double z_m, double turn_rad = 0, std::uint32_t stale = 0) {
    told_ = {{0, 0, told_m(z_m, kStep_m)}, small_rotation({0, told_m(turn_rad, kStep_rad), 0})};
    input_.pose_w = told_;
    input_.stale_ticks = stale;
    sense(model_, *state_, *scratch_, input_);
    return state_->device_w;
  }
  double turn_rad() const { return small_rotation_vector(state_->device_w.orientation).y; }
  Model model_;
  StatePtr state_ = roomy_state();
  ScratchPtr scratch_ = roomy_scratch();
  Input input_;
  Pose told_;
  int tick_ = 0;
};

TEST_F(EdgesInTheTick, OnAnEdgeNothingMoves) {
  const double edge_m = 20.5 * kStep_m, edge_rad = 30.5 * kStep_rad;
  double least_m = 1, most_m = -1, least_rad = 1, most_rad = -1;
  for (int i = 0; i < 600; ++i) {
    const double share = std::min(1.0, i / 100.0), aside = i % 2 == 0 ? 1e-9 : -1e-9;
    const Pose pose = sample(share * edge_m + aside, share * edge_rad + aside);
    if (i < 400) continue;
    least_m = std::min(least_m, pose.position_m.z), most_m = std::max(most_m, pose.position_m.z);
    least_rad = std::min(least_rad, turn_rad()), most_rad = std::max(most_rad, turn_rad());
  }
  EXPECT_LT(most_m - least_m, 1e-6 * kStep_m);        // as told: a step
  EXPECT_LT(most_rad - least_rad, 1e-4 * kStep_rad);  // turns of 30 mrad do not quite add up
  EXPECT_NEAR(most_m, edge_m, 1e-3 * kStep_m);
  EXPECT_NEAR(most_rad, edge_rad, 1e-3 * kStep_rad);
}

// At 20 mm/s, at any place between two edges: bridged, a handle is as near as before, and met again without a jump.
TEST_F(EdgesInTheTick, ThreeLostSamplesAreBridged) {
  for (int from = 200; from < 220; ++from) {
    reset(*state_);
    double before_m = 0;
    for (int i = 0; i < from + 60; ++i) {
      const double z_m = 2e-5 * i;
      const int lost = i - from;  // samples so far, less one
      const bool stale = lost >= 0 && lost < 3;
      const double now_m =
          sample(stale ? 2e-5 * (from - 1) : z_m, 0, stale ? static_cast<std::uint32_t>(lost + 1) : 0).position_m.z;
      if (i >= from) {
        EXPECT_NEAR(now_m, z_m, kStep_m) << from << ", " << lost;
        EXPECT_LT(std::abs(now_m - before_m - 2e-5), 0.6 * kStep_m) << from << ", " << lost;
      }
      before_m = now_m;
    }
  }
}

TEST_F(EdgesInTheTick, WhatIsSeatedAnewForgetsItsEdges) {
  for (int i = 0; i < 50; ++i) sample(2e-5 * i);
  EXPECT_NE(state_->edges_m.speed.z, 0);
  seat_anew(model_, *state_, {{0, 0, 30e-5}, {}});
  EXPECT_EQ(state_->edges_m.speed.z, 0);
  const Pose pose = sample(30e-5);
  EXPECT_NEAR(pose.position_m.z, told_.position_m.z, 1e-6 * kStep_m);
}

// What feels soft is felt on the track, within 50 ms and without a jump; what gets stiff, or is let go of, by the edges
// again within 10. Of a tremor of 0.1 mm at 9 Hz the track leaves less than half from tick to tick.
TEST_F(EdgesInTheTick, ASoftObjectIsFeltOnTheTrack) {
  model_.params.track_below_N_per_m = 1000;
  const auto tremor_m = [&](double feels_N_per_m, int ticks) {
    state_->feels_N_per_m = feels_N_per_m;
    double bends_m2 = 0, last_m = state_->device_w.position_m.z, change_m = 0;
    for (int i = 0; i < ticks; ++i) {
      const double z_m = 2e-3 + 1e-4 * std::sin(2 * kPi * 9e-3 * static_cast<double>(tick_++));
      const double now_m = sample(z_m).position_m.z;
      EXPECT_LT(std::abs(now_m - z_m), 2 * kStep_m);
      EXPECT_LT(std::abs(now_m - last_m), kStep_m);
      bends_m2 += (now_m - last_m - change_m) * (now_m - last_m - change_m);
      change_m = now_m - last_m;
      last_m = now_m;
    }
    return std::sqrt(bends_m2 / ticks);
  };
  sample(2e-3);
  tremor_m(0, 200);
  EXPECT_EQ(state_->track.share, 0);
  const double edges_m = tremor_m(1300, 1000);
  EXPECT_EQ(state_->track.share, 0);
  tremor_m(700, 51);
  EXPECT_EQ(state_->track.share, 1);
  EXPECT_LT(tremor_m(700, 1000), 0.5 * edges_m);
  tremor_m(1300, 11);
  EXPECT_EQ(state_->track.share, 0);
  tremor_m(700, 30);
  EXPECT_NEAR(state_->track.share, 0.6, 1e-9);
  tremor_m(0, 7);
  EXPECT_EQ(state_->track.share, 0);
}

// A state spoilt in memory never puts the handle more than a step beside what is told.
TEST_F(EdgesInTheTick, NoMemoryCarriesTheHandleAway) {
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300,
                        -1e300, 1};
  for (Vec3 EdgeMemory::*field :
       {&EdgeMemory::ahead, &EdgeMemory::eased, &EdgeMemory::speed, &EdgeMemory::since_s, &EdgeMemory::change})
    for (const double x : bad) {
      reset(*state_);
      for (int i = 0; i < 400; ++i) {
        if (i == 100) (state_->edges_m.*field).z = (state_->edges_rad.*field).y = x;
        const Pose pose = sample(1e-5 * i, 3e-4 * i);
        ASSERT_LE(norm(pose.position_m - told_.position_m), 1.01 * kStep_m) << x << ", " << i;
        ASSERT_LE(norm(small_rotation_vector(pose.orientation * conjugate(told_.orientation))), 1.01 * kStep_rad)
            << x << ", " << i;
      }
    }
  model_.params.track_below_N_per_m = 1000;
  for (const double x : bad)
    for (const bool share : {false, true}) {
      reset(*state_);
      state_->feels_N_per_m = 500;
      for (int i = 0; i < 400; ++i) {
        if (i == 100) (share ? state_->track.share : state_->track.at_m.z) = x;
        const Pose pose = sample(1e-5 * i);
        ASSERT_LE(norm(pose.position_m - told_.position_m), 2 * kStep_m) << x << ", " << i;
      }
    }
}

}  // namespace
}  // namespace palpate::test
