// Three ODrives on a bus, simulated byte by byte: found, proved, enabled, rendering the real tick's force, and every
// wrong thing noticed before a motor is on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>

#include "hal/drives/odrive_dbc.h"
#include "hal/drives/odrive_drives.h"
#include "hal/drives/odrive_sim.h"
#include "tests/hal/dissector.h"
#include "tests/hal/encoder_judge.h"

namespace palpate {
namespace {

using test::replaced;
using testing::HasSubstr;
using ODriveArm = test::WiredArm<ODriveDrives, ODriveSim>;

constexpr int kNodes[] = {1, 2, 3};

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

TEST(ODriveDbc, IsWhatTheTableSays) {
  std::ifstream file(std::string(PALPATE_SOURCE_DIR) + "/docs/odrive.dbc");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, odrive::dbc_text(kNodes)) << "the table changed: write dbc_text({1, 2, 3}) to docs/odrive.dbc";
}

// A whole start and half a second of force, as candump writes them, read by python-can and canmatrix: each torque is
// what was sent, each position what the joint was, serial number and firmware those of the profile; nothing is unknown.
TEST(ODriveDbc, OtherProgramsReadTheBus) {
  VirtualClock clock;
  ODriveArm arm(tables(), clock);
  std::vector<Frame> frames;
  arm.cable().tap(frames);
  ASSERT_EQ(arm.start(), "");
  std::vector<double> sent_Nm[3], counted[3];
  DeviceCommand command;
  command.flags = CommandFlag::kEnable;
  DeviceSample sample;
  for (int i = 0; i < 500; ++i) {
    command.force_N = {1.0 - 0.002 * i, 0.5, -1};
    arm.axes().transmit(command);
    for (int k = 0; k < 3; ++k) sent_Nm[k].push_back(arm.axes().torque_Nm(k));
    arm.sim().step_bus();
    arm.axes().receive(sample);
    for (int k = 0; k < 3; ++k) counted[k].push_back(arm.sim().plant().turns(k));
  }
  const std::string log = testing::TempDir() + "odrive.log";
  test::write_candump(log, frames);
  std::map<std::string, std::vector<test::DecodedFrame>> seen;
  for (const test::DecodedFrame& frame : test::decode(PALPATE_SOURCE_DIR, "docs/odrive.dbc", log))
    seen[frame.name].push_back(frame);
  ASSERT_FALSE(seen.empty()) << "python3-can or python3-canmatrix is missing: apt-get install both";
  EXPECT_EQ(seen.count("unknown"), 0u);
  for (int k = 0; k < 3; ++k) {
    const std::string node = "Node" + std::to_string(k + 1) + "_";
    const auto& torque = seen[node + "SetInputTorque"];
    const auto& estimate = seen[node + "GetEncoderEstimates"];
    ASSERT_GE(torque.size(), sent_Nm[k].size());
    ASSERT_GE(estimate.size(), counted[k].size());
    for (std::size_t i = 1; i <= 500; ++i) {
      EXPECT_EQ((torque.end() - static_cast<long>(i))->value.at("Torque"),
                static_cast<double>(static_cast<float>(sent_Nm[k][500 - i])));
      EXPECT_EQ((estimate.end() - static_cast<long>(i))->value.at("Position"),
                static_cast<double>(static_cast<float>(counted[k][500 - i])));
    }
    EXPECT_NE(sent_Nm[k].back(), 0.0);
    EXPECT_EQ(seen[node + "Address"].at(0).value.at("SerialNumber"), 61925406831665.0 + k);
    EXPECT_EQ(seen[node + "GetVersion"].at(0).value.at("FirmwareRevision"), 10.0);
    EXPECT_EQ(seen[node + "SetAxisState"].back().value.at("State"), 8.0);
    EXPECT_EQ(seen[node + "SetControllerMode"].back().value.at("ControlMode"), 1.0);
    EXPECT_EQ(seen[node + "Heartbeat"].back().value.at("State"), 8.0);
    EXPECT_EQ(seen[node + "RxSdo"].at(0).value.at("Endpoint"), 396.0) << "the direction is asked first";
  }
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
