// Three ODrives on a bus, simulated byte by byte: found, proved, enabled, rendering the real tick's force, and every
// wrong thing noticed before a motor is on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/drives/odrive_drives.h"
#include "hal/drives/odrive_sim.h"
#include "tests/hal/encoder_judge.h"

namespace palpate {
namespace {

using test::replaced;
using testing::HasSubstr;
using ODriveArm = test::WiredArm<ODriveDrives, ODriveSim>;

// Without the frame of kArm, which test_device_profile reads: the bench has its own.
std::string tables() { return replaced(test::kArm, "scale = 2\n", ""); }

std::string refusal(const ODriveFault& fault, const std::string& text = tables()) {
  VirtualClock clock;
  ODriveArm arm(text, clock);
  arm.sim().set_fault(fault);
  const std::string wrong = arm.start();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(arm.sim().closed_loop(i)) << "enabled before it was proved";
  return wrong;
}

TEST(ODrive, ThreeDrivesAreFoundAndTheirWatchdogsAreOn) {
  VirtualClock clock;
  ODriveArm arm(tables(), clock);
  EXPECT_EQ(arm.start(), "");
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(arm.sim().watchdog_on(i));
    EXPECT_FALSE(arm.sim().closed_loop(i));
  }
}

TEST(ODrive, WhatIsWrongIsSaidBeforeAMotorIsEnabled) {
  EXPECT_THAT(refusal({.axis = 1, .mute = true}), HasSubstr("axis 2 (ODrive node 2): no heartbeat"));
  EXPECT_THAT(refusal({.axis = 1, .serial = 5}), HasSubstr("serial number 5 is not that of the profile"));
  EXPECT_THAT(refusal({.axis = 1, .serial = 61925406831667}), HasSubstr("that of axis 3: the axes are swapped"));
  EXPECT_THAT(refusal({.axis = 2, .firmware_minor = 5}), HasSubstr("has firmware 0.5.10"));
  EXPECT_THAT(refusal({.axis = 0, .reversed = true}),
              HasSubstr("axis 1 (ODrive node 1): its position mapper is reversed"));
  EXPECT_THAT(refusal({.axis = 0, .no_watchdog = true}), HasSubstr("watchdog stays disabled"));
  EXPECT_THAT(refusal({.axis = 0, .estimate_periods = 10}),
              HasSubstr("positions come 100 times a second, needed are 1000"));
  EXPECT_THAT(refusal({.axis = 2, .error = 0x200}), HasSubstr("reports error 0x200 (supply voltage too low)"));
}

// The force on the handle is what the tick asked for: torques went out through the Jacobian and the capstans, in 32
// bits, and came back through differences of the inverse map. The motors obey one period later (the hand holds still:
// 1e-3 N), and torque in single precision is 1e-7 of it.
TEST(ODrive, TheHandFeelsTheTicksForce) {
  VirtualClock clock;
  ODriveArm arm(replaced(replaced(tables(), "weight_z_N = -0.5\n", ""), "gravity_Nm = 0.2\n", ""), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(arm, clock, 1500, 2e4, {}, 0, arm.frame());
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_EQ(run.summary.stale_ticks + run.summary.gaps + run.summary.send_failures + run.summary.link_drops, 0u);
  EXPECT_EQ(arm.sim().watchdogs(), 0u);
  EXPECT_EQ(arm.axes().limited_ticks(), 0u);
  for (std::size_t i = 1200; i < 1500; ++i) {
    const Vec3 asked = run.records[i].output.device_w.force_N;
    EXPECT_GT(norm(asked), 1.0) << "it presses";
    ASSERT_LT(norm(arm.rendered_N()[i + 1] - asked), 2e-3) << i;
  }
  clock.advance(2'000'000);  // the drives take what the loop sent last
  DeviceSample sample;
  arm.receive(sample);
  EXPECT_EQ(arm.rendered_N().back(), Vec3{});
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(arm.sim().closed_loop(i));
}

// A controller that stops: each drive lets go by itself after its 20 ms; the loop then makes the edge that enables
// anew.
TEST(ODrive, SilenceTripsTheDrivesWatchdogsAndForceComesBack) {
  VirtualClock clock;
  ODriveArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(
      arm, clock, 2500, 2e4,
      [&arm](const test::Surroundings& s) { arm.silence_controller(s.tick >= 800 && s.tick < 850); }, 0, arm.frame());
  EXPECT_EQ(arm.sim().watchdogs(), 3u);
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_GE(run.summary.link_drops, 1u);
  EXPECT_GT(norm(arm.rendered_N()[790]), 0.5);
  for (std::size_t i = 822; i < 850; ++i) ASSERT_EQ(arm.rendered_N()[i], Vec3{}) << i;
  EXPECT_GT(norm(run.records[2400].output.device_w.force_N), 1.0) << "enabled anew";
  EXPECT_GT(norm(arm.rendered_N()[2400]), 1.0);
}

TEST(ODrive, AnErrorOfOneDriveIsAFaultAndFreesTheHand) {
  VirtualClock clock;
  ODriveArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(
      arm, clock, 1500, 2e4,
      [&arm](const test::Surroundings& s) {
        if (s.tick == 800) arm.sim().set_fault({.axis = 1, .error = 0x2000});
      },
      0, arm.frame());
  EXPECT_EQ(run.summary.faults & Fault::kDeviceReported, Fault::kDeviceReported);
  EXPECT_EQ(arm.last().error_code, 0x2000u);
  EXPECT_EQ(arm.rendered_N().back(), Vec3{});
}

TEST(ODrive, ADriveThatTakesNoClosedLoopIsAFault) {
  VirtualClock clock;
  ODriveArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  arm.sim().set_fault({.axis = 1, .stays_idle = true});
  const test::FaultRun run = test::run_on(arm, clock, 1500, 2e4, {}, 0, arm.frame());
  EXPECT_EQ(run.summary.faults & Fault::kDeviceReported, Fault::kDeviceReported);
  for (const Vec3 force : arm.rendered_N()) ASSERT_EQ(force, Vec3{}) << "torque before all axes obey";
}

TEST(ODrive, BadCablesAreBorneOrNoticed) { test::expect_bad_cables_are_borne<ODriveArm>(tables()); }
TEST(ODrive, GarbledCommandsEndWithTheCable) { test::expect_garbled_commands_end_with_the_cable<ODriveArm>(tables()); }

TEST(ODrive, WrongEncodersAreBorneOrNoticed) { test::expect_wrong_encoders_are_borne<ODriveArm>(tables()); }
TEST(ODrive, SparsePositionsAreAFault) { test::expect_sparse_positions_are_a_fault<ODriveArm>(tables()); }

// What start() set is gone with the power: enabling it again would drive it without its watchdog.
TEST(ODrive, ADriveThatStartsAnewIsAFaultUntilTheControllerDoes) {
  test::expect_a_restart_is_a_fault<ODriveArm>(
      tables(), ODriveDrives::kRestarted, {1, 20, 300},
      [](ODriveSim& sim, int axis, int periods) { sim.restart(axis, periods); });
}

TEST(ODrive, AnEmergencyStopIsAFaultAndFreesTheHand) {
  VirtualClock clock;
  ODriveArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(
      arm, clock, 1500, 2e4,
      [&arm](const test::Surroundings& s) {
        if (s.tick == 800) arm.sim().set_fault({.axis = 2, .error = odrive::kEstopRequested});
      },
      0, arm.frame());
  EXPECT_EQ(run.summary.faults & Fault::kDeviceReported, Fault::kDeviceReported);
  EXPECT_EQ(arm.last().flags & DeviceFlag::kStopButton, DeviceFlag::kStopButton);
  EXPECT_EQ(arm.rendered_N().back(), Vec3{});
}

// They send unasked, each by its own crystal: 100 ppm are a period in 10 s, and their phases meet the loop's slots in
// turn. A position that is not there yet is that of the period before; two at once count once.
TEST(ODrive, ClocksThatDriftAreBridged) {
  VirtualClock clock;
  ODriveArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  arm.sim().set_clock(0, 100);
  arm.sim().set_clock(2, -100);
  const test::FaultRun run = test::run_on(arm, clock, 30'000, 2e4, {}, 0, arm.frame());
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_EQ(run.summary.stale_ticks, 0u) << "while one slips the others are there";
  EXPECT_GT(norm(arm.rendered_N()[29'000]), 1.0);
}

// The worst of it: all three slip at once, each position up to 0.4 ms early or late. For 8 s of ten two positions may
// lie before one tick and none before the next; with whole sets alone that ended in kSamplesSparse (2026-11-25).
TEST(ODrive, ClocksThatDriftTogetherWithJitterAreBridged) {
  VirtualClock clock;
  ODriveArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  for (int i = 0; i < 3; ++i) arm.sim().set_clock(i, i == 0 ? -100 : 100, 0.4);
  const test::FaultRun run = test::run_on(arm, clock, 20'000, 2e4, {}, 0, arm.frame());
  EXPECT_EQ(run.summary.faults, 0u);
  // None of three in a period: each is late with q (1 - q) <= 1/4, independently; 1/64 of the ticks at most. 109 were.
  EXPECT_LE(run.summary.stale_ticks, 20'000u / 64);
  EXPECT_GT(norm(arm.rendered_N()[19'000]), 1.0);
}

}  // namespace
}  // namespace palpate
