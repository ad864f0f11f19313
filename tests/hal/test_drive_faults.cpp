// Faults played on simulated drives, as a controller sees them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/drives/drive_faults.h"
#include "hal/drives/drive_link.h"
#include "hal/drives/odrive_sim.h"
#include "tests/hal/arm_bench.h"

namespace palpate {
namespace {

using testing::HasSubstr;

std::vector<FaultLine> script_of(const std::string& text) {
  std::vector<FaultLine> lines;
  std::string error;
  EXPECT_TRUE(parse_fault_script(text, lines, error)) << error;
  return lines;
}

// A hand that goes along x at 0.1 m/s on average, and what the controller is told of it.
struct Played {
  std::vector<DeviceSample> samples;
  std::uint64_t watchdogs = 0;
};
Played play(const std::string& script, int periods) {
  std::string error;
  const DeviceProfile profile = test::arm_profile(test::kArm);
  const ArmProfile& arm = *profile.arm;
  double home[kMaxAxes] = {};
  for (std::size_t i = 0; i < arm.axes.size(); ++i) home[i] = arm.axes[i].home_joint;
  const Pose from = linkage_at(arm.linkage, home).pose;
  auto ends = open_loopback_pair(error);
  DriveFaults faults(*ends.second, script_of(script), 1e-3);
  ODriveSim sim(faults, arm, {}, HandPath({{0, from}, {0.2, {from.position_m + Vec3{0.02, 0, 0}, from.orientation}}}));
  const auto drives = make_drives(*ends.first, arm, 1e-3);
  AxisDevice device(*drives, arm, {}, 1e-3);
  EXPECT_EQ(device.start([&sim] { sim.step_bus(); }), "");
  Played played;
  for (int i = 0; i < periods; ++i) {
    DeviceSample sample;
    faults.advance(sim);
    sim.step();
    device.receive(sample);
    device.transmit({});
    played.samples.push_back(sample);
  }
  played.watchdogs = sim.watchdogs();
  return played;
}

std::ptrdiff_t without_sample(const Played& played) {
  return std::ranges::count_if(played.samples, [](const DeviceSample& sample) { return !sample.fresh; });
}

// Of all axes at once: a period without any position has no sample.
TEST(DriveFaults, PositionsAreLostForSoManyPeriods) {
  EXPECT_EQ(without_sample(play("", 200)), 0);
  EXPECT_EQ(without_sample(play("0.05 lose 5", 200)), 5);
  EXPECT_EQ(without_sample(play("0.05 silence 0.03", 200)), 30);
}

TEST(DriveFaults, CommandsThatAreMissedTripTheWatchdogs) {
  EXPECT_EQ(play("0.05 miss 10", 200).watchdogs, 0u);
  EXPECT_EQ(play("0.05 deaf 0.05", 200).watchdogs, 3u);
}

TEST(DriveFaults, EncodersFreezeAndThaw) {
  const Played played = play("0.1 freeze 0.05", 300);
  for (std::size_t i = 101; i < 150; ++i) EXPECT_EQ(played.samples[i].position_m, played.samples[100].position_m) << i;
  EXPECT_GT(norm(played.samples[151].position_m - played.samples[149].position_m), 1e-3);
}

TEST(DriveFaults, EncodersJumpByWhatTheHandleSeemsToMove) {
  const Vec3 still = play("", 400).samples.back().position_m,
             jumped = play("0.05 jump 5", 400).samples.back().position_m;
  // Not where the jump was any more: the linkage bends it a little.
  EXPECT_NEAR(norm(jumped - still), 5e-3, 1e-3);
  EXPECT_GT((jumped - still).x, 4e-3);
}

TEST(DriveFaults, WhatDrivesDoNotKnowIsRefused) {
  EXPECT_EQ(DriveFaults::refuse(script_of("1 lose 5\n2 jump 3")), "");
  EXPECT_THAT(DriveFaults::refuse(script_of("1 lose 5\n2 drift 100")), HasSubstr("know of lose, silence, miss, deaf"));
}

}  // namespace
}  // namespace palpate
