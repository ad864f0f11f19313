// Six CiA 402 drives on one bus: an arm whose gimbal has motors, from switching on to force and torque on the handle,
// at the period the bus has room for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "hal/drives/cia402_drives.h"
#include "hal/drives/cia402_sim.h"
#include "hal/drives/drive_link.h"
#include "tests/hal/arm_bench.h"

namespace palpate {
namespace {

using testing::HasSubstr;
using GimbalArm = test::WiredArm<Cia402Drives, Cia402Sim>;

constexpr double kPeriod_s = 2e-3;

// The shipped profile's, but that the place of the base is found by WiredArm.
std::string tables() {
  std::ifstream stream(std::string(PALPATE_SOURCE_DIR) + "/config/devices/example-gimbal-cia402.toml");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return text.substr(text.find("[linkage]"));
}

PlantOptions plant() {
  PlantOptions options;
  options.period_s = kPeriod_s;
  options.substeps = 40;
  options.damping_N_s_per_m = 2.5;
  options.delay_ticks = 0;
  return options;
}

// The tool's sphere is carried 10 mm beside the handle, so that a force has a moment about it; the coupling is within
// 2b / T of the device and the hand, 2 (2.5 + 5) / 2 ms, by four.
void carry_tool_aside(test::ImageBytes& image) {
  const Vec3 aside{0.007, -0.007, 0};
  image.params().period_s = kPeriod_s;
  image.params().coupling_N_per_m = 800;
  image.params().coupling_Nm_per_rad = 0.3;
  image.array<ToolPiece>(test::kPiece)->pose_tool.position_m = aside;
  image.array<ToolPoint>(test::kToolPoint)->position_tool_m = aside;
}

TEST(SixDrives, ForceAndTorqueOfTheTickComeToTheHandle) {
  VirtualClock clock;
  GimbalArm arm(tables(), clock, plant());
  ASSERT_EQ(arm.start(), "");
  for (int i = 0; i < kMaxAxes; ++i) {
    EXPECT_EQ(arm.sim().object(i, canopen::kPeriodValue), 2u);
    EXPECT_EQ(arm.sim().object(i, canopen::kConsumerHeartbeat), 127u << 16 | 20u);
    EXPECT_FALSE(arm.sim().enabled(i));
  }
  const test::FaultRun run = test::run_on(arm, clock, 900, 2e4, {}, 0, arm.frame(), 0, carry_tool_aside);
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_EQ(run.summary.stale_ticks + run.summary.gaps + run.summary.send_failures + run.summary.link_drops, 0u);
  EXPECT_EQ(arm.sim().heartbeats_lost(), 0u);
  EXPECT_EQ(arm.axes().limited_ticks(), 0u);
  double force_N = 0, torque_Nm = 0;
  for (std::size_t i = 600; i < 900; ++i) {
    const Wrench asked = run.records[i].output.device_w, felt = arm.rendered()[i + 1];
    force_N = std::max(force_N, norm(asked.force_N));
    torque_Nm = std::max(torque_Nm, norm(asked.torque_Nm));
    // Torque goes out in thousandths of the rated one. Half a step of an arm's motor, 0.125 N m / 2000 x 13.3 over the
    // lever of 0.17 m, is 5 mN, and of a gimbal's, 0.05 N m / 2000 x 5, 0.13 mN m; the arm's joints carry the moment
    // that the gimbal misses, and the joints are those of whole counts.
    ASSERT_LT(norm(felt.force_N - asked.force_N), 0.015 + 0.005 * norm(asked.force_N)) << i;
    ASSERT_LT(norm(felt.torque_Nm - asked.torque_Nm), 0.001 + 0.005 * norm(asked.torque_Nm)) << i;
  }
  EXPECT_GT(force_N, 1.0) << "it presses";
  EXPECT_GT(torque_Nm, 0.01) << "beside its middle";
  clock.advance(4'000'000);  // the drives take what the loop sent last
  DeviceSample sample;
  arm.receive(sample);
  EXPECT_EQ(arm.rendered().back().force_N, Vec3{});
  EXPECT_EQ(arm.rendered().back().torque_Nm, Vec3{});
  for (int i = 0; i < kMaxAxes; ++i) EXPECT_FALSE(arm.sim().enabled(i));
}

// At start, too, no more goes over the bus than the budget counts with: one SYNC in 2 ms.
TEST(SixDrives, NoStartIsFasterThanTheBus) {
  VirtualClock clock;
  GimbalArm arm(tables(), clock, plant());
  std::vector<Frame> frames;
  arm.cable().tap(frames);
  int pauses = 0;
  ASSERT_EQ(arm.axes().start([&] {
    if (++pauses % 2 == 0) arm.sim().step_bus();
  }),
            "");
  const auto syncs = std::ranges::count(frames, std::uint32_t{canopen::kSync}, &Frame::id);
  EXPECT_GE(syncs, 75) << "50 ms to see that they answer, 100 ms of positions";
  EXPECT_LE(2 * syncs, pauses);
}

TEST(SixDrives, WhatIsWrongWithASixthIsSaid) {
  const auto refusal = [](const std::function<void(Cia402Sim&)>& meddle) {
    VirtualClock clock;
    GimbalArm arm(tables(), clock, plant());
    meddle(arm.sim());
    const std::string wrong = arm.start();
    EXPECT_FALSE(arm.sim().any_enabled());
    return wrong;
  };
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.mute(5); }), HasSubstr("axis 6 (CANopen node 6): does not answer"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(3, canopen::kSerial, 106); }), HasSubstr("that of axis 6"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(4, canopen::kPolarity, 0xC0); }), HasSubstr("axis 5"));
}

TEST(SixDrives, OneKilohertzIsRefusedWithTheRemedy) {
  const ArmProfile arm = *test::arm_profile(tables()).arm;
  const BusVerdict fast = check_drives_budget(arm, 1e-3);
  EXPECT_FALSE(fast.fits);
  EXPECT_NEAR(fast.used_us, 6 * (95 + 115) + 55 + 65 + 31 + 115, 1e-9);
  EXPECT_THAT(fast.text, HasSubstr("half the rate fits, 1526 of 1800 us: bake the scene with device.period_ms = 2"));
  EXPECT_THAT(fast.text, HasSubstr("one node on CAN FD"));
  EXPECT_TRUE(check_drives_budget(arm, kPeriod_s).fits);
}

// Three torques and a controlword in common for every three drives, positions alone: 2 x 135 + 6 x 95 + 55 + 65 + 166.
// Six do not fit with them either; with as many drives as a linkage can have, no period becomes possible that is not.
TEST(SixDrives, PackedObjectsWouldBeNoWayOut) {
  ArmProfile arm = *test::arm_profile(tables()).arm;
  const BusVerdict packed = check_bus_budget(packed_drives_budget(arm, 1e-3));
  EXPECT_NEAR(packed.used_us, 2 * 135 + 6 * 95 + 55 + 65 + 31 + 135, 1e-9);
  EXPECT_FALSE(packed.fits);
  EXPECT_THAT(check_drives_budget(arm, 1e-3).text, HasSubstr("packed objects would take 1126 of 900 us: no way out"));
  for (const std::size_t axes : {2u, 3u, 6u}) {
    arm.axes.resize(axes);
    for (const double period_s : {1e-3, 2e-3})
      EXPECT_EQ(check_bus_budget(packed_drives_budget(arm, period_s)).fits, check_drives_budget(arm, period_s).fits);
    arm.axes.resize(6, arm.axes[0]);
  }
}

}  // namespace
}  // namespace palpate
