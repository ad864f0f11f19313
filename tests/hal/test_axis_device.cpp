// What the axis layer does between drives and loop, on drives that do as the test says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hal/drives/axis_map.h"
#include "hal/drives/drive_link.h"
#include "tests/hal/arm_bench.h"

namespace palpate {
namespace {

using test::replaced;
using testing::HasSubstr;

struct FakeDrives : AxisDrives {
  AxisSample now;
  AxisCommand last;
  std::string wrong;
  std::string start(const Pause&) override { return wrong; }
  void receive(AxisSample& sample) noexcept override { sample = now; }
  bool transmit(const AxisCommand& command) noexcept override {
    last = command;
    return true;
  }
};

struct Bench {
  explicit Bench(const std::string& tables = test::kArm) : profile(test::arm_profile(tables)) {
    drives.now.fresh = true;
    drives.now.received = 1;
    drives.now.flags = DeviceFlag::kEnabled;
    EXPECT_EQ(device.start([] {}), "");
  }
  DeviceProfile profile;
  const ArmProfile& arm = *profile.arm;
  FakeDrives drives;
  AxisDevice device{drives, arm, profile.frame, 1e-3};
  DeviceSample sample;

  // Turns of the motors that bring the joints this far from home.
  void move(double a_rad, double b_rad, double c_rad) {
    const double by[] = {a_rad, b_rad, c_rad};
    for (std::size_t i = 0; i < 3; ++i) drives.now.turns[i] = by[i] / joint_per_turn(arm.axes[i]);
    device.receive(sample);
  }
  // Until the slope is over: 20 commands are twice ten tenths.
  void push(Vec3 force_N, std::uint32_t flags = CommandFlag::kEnable) {
    DeviceCommand command;
    command.force_N = force_N;
    command.flags = flags;
    for (int i = 0; i < 20; ++i) device.transmit(command);
  }
  bool still() const {
    return drives.last.torque_Nm[0] == 0 && drives.last.torque_Nm[1] == 0 && drives.last.torque_Nm[2] == 0;
  }
};

TEST(AxisDevice, TurnsOfMotorsBecomeThePose) {
  Bench bench;
  bench.move(0.1, -0.2, 0.3);
  EXPECT_TRUE(bench.sample.fresh);
  const double b = 80 * kPi / 180 - 0.2, c = -20 * kPi / 180 + 0.3, r = 0.205 * std::cos(b) + 0.245 * std::cos(c);
  const Vec3 expected{r * std::cos(0.1), r * std::sin(0.1), 0.205 * std::sin(b) + 0.245 * std::sin(c)};
  EXPECT_LT(norm(bench.sample.position_m - expected), 1e-15);
  EXPECT_EQ(bench.sample.flags & DeviceFlag::kCalibrated, DeviceFlag::kCalibrated);
}

// The device stands turned by a quarter; a handle that cannot turn holds the tool as the scene has it.
TEST(AxisDevice, WithoutAGimbalTheToolKeepsItsOrientation) {
  Bench bench;
  bench.move(0.3, -0.2, 0.1);
  const Quat seen = pose_in_world(bench.profile.frame, bench.sample).orientation;
  EXPECT_LT(norm(small_rotation_vector(seen)), 1e-15);
}

// At home with no force: the weight of 0.5 N on the forearm's lever and what holds the upper arm, geared down by 12.
TEST(AxisDevice, HoldsTheWeight) {
  Bench bench;
  bench.move(0, 0, 0);
  bench.push({});
  const double b = 80 * kPi / 180, c = -20 * kPi / 180;
  EXPECT_NEAR(bench.drives.last.torque_Nm[0], 0, 1e-15);
  EXPECT_NEAR(bench.drives.last.torque_Nm[1], -(0.5 * 0.205 + 0.2) * std::cos(b) / 12, 1e-15);
  EXPECT_NEAR(bench.drives.last.torque_Nm[2], 0.5 * 0.245 * std::cos(c) / 12, 1e-15);
}

// Against a motor's friction: 0.8 of it when it turns, nothing when it stands, and never more, whatever its encoder
// says: what holds a motor at rest is stronger, and what brakes one that turns takes more than this gives.
TEST(AxisDevice, FrictionIsCompensatedByLessThanItIs) {
  const auto friction = [](const std::string& text) {
    return replaced(text, "home_deg = 0\n", "home_deg = 0\nfriction_Nm = 0.004\n");
  };
  Bench bench(replaced(replaced(friction(test::kArm), "weight_z_N = -0.5\n", ""), "gravity_Nm = 0.2\n", ""));
  DeviceCommand nothing;
  nothing.flags = CommandFlag::kEnable;
  const auto after = [&](double turns) {
    bench.drives.now.turns[0] = turns;
    bench.device.receive(bench.sample);
    bench.device.transmit(nothing);
    EXPECT_LE(std::abs(bench.drives.last.torque_Nm[0]), 0.8 * 0.004 + 1e-15);
    EXPECT_EQ(bench.drives.last.torque_Nm[1], 0.0);
    return bench.drives.last.torque_Nm[0];
  };
  double turns = 0, torque_Nm = 0;
  for (int i = 0; i < 50; ++i) EXPECT_EQ(after(0), 0.0) << "at rest";
  for (int i = 0; i < 50; ++i) torque_Nm = after(turns += 2e-3);  // 2 turns/s
  EXPECT_NEAR(torque_Nm, 0.8 * 0.004, 1e-12);
  for (int i = 0; i < 100; ++i) torque_Nm = after(turns -= 2e-3);
  EXPECT_NEAR(torque_Nm, -0.8 * 0.004, 1e-12);
  for (int i = 0; i < 100; ++i) torque_Nm = after(turns);
  EXPECT_NEAR(torque_Nm, 0, 1e-7) << "a motor that stands is not pushed";
  // An encoder that flutters by a count: a sixth of that in a millisecond is a third of full speed's half a count.
  for (int i = 0; i < 100; ++i) EXPECT_LT(std::abs(after(turns + i % 2 / 8192.0)), 0.34 * 0.8 * 0.004);
  for (const double garbage : {1e300, -1e300, std::numeric_limits<double>::infinity(), 0.0, std::nan(""), 0.0})
    EXPECT_TRUE(std::isfinite(after(garbage)));
}

TEST(AxisDevice, NoTorqueBeyondAJointsLimit) {
  Bench bench;
  bench.move(0, 0, 0);
  bench.push({1, 1, 1});
  EXPECT_FALSE(bench.still());
  bench.move(1.1, 0, 0);  // 63 degrees of 60
  bench.push({1, 1, 1});
  EXPECT_TRUE(bench.still());
  EXPECT_FALSE(bench.device.within_limits());
  EXPECT_EQ(bench.device.limited_ticks(), 20u);
  EXPECT_EQ(bench.sample.faults, 0u) << "a hand at the end of its reach is no fault";
  bench.move(1.0, 0, 0);
  bench.push({1, 1, 1});
  EXPECT_FALSE(bench.still());
}

TEST(AxisDevice, NoTorqueWhereTheLinkageIsSingular) {
  Bench bench;
  bench.move(0, -50 * kPi / 180, 45 * kPi / 180);  // links at 30 and 25 degrees: stretched
  bench.push({1, 1, 1});
  EXPECT_TRUE(bench.still());
  EXPECT_TRUE(is_finite(bench.sample.position_m));
}

TEST(AxisDevice, TorquesRiseByATenthOfTheLimitAMillisecondAndKeepTheirDirection) {
  Bench bench;
  bench.move(0, 0, 0);
  bench.push({});
  double before[3], most = 0;
  for (int i = 0; i < 3; ++i) before[i] = bench.drives.last.torque_Nm[i];
  DeviceCommand command;
  command.force_N = {0, 100, -100};
  command.flags = CommandFlag::kEnable;
  bench.device.transmit(command);
  for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(bench.drives.last.torque_Nm[i] - before[i]));
  EXPECT_NEAR(most, 0.1 * 0.1, 1e-12);
  bench.push({0, 100, -100});
  bench.device.receive(bench.sample);
  EXPECT_EQ(bench.sample.flags & DeviceFlag::kSaturated, DeviceFlag::kSaturated);
  most = 0;
  for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(bench.drives.last.torque_Nm[i]));
  EXPECT_NEAR(most, 0.1, 1e-12) << "the motor that bears most is at its limit";
}

TEST(AxisDevice, WhatIsNotANumberMovesNothing) {
  Bench bench;
  bench.move(0, 0, 0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  bench.push({nan, 0, 0});
  EXPECT_TRUE(std::isfinite(bench.drives.last.torque_Nm[0]) && std::isfinite(bench.drives.last.torque_Nm[1]));
  bench.drives.now.turns[1] = nan;
  bench.device.receive(bench.sample);
  EXPECT_TRUE(is_finite(bench.sample.position_m)) << "the last pose stays";
  EXPECT_EQ(bench.sample.faults & Fault::kDeviceReported, Fault::kDeviceReported);
  EXPECT_EQ(bench.sample.error_code, AxisDevice::kNoHandle);
  bench.push({1, 1, 1});
  EXPECT_TRUE(bench.still());
}

TEST(AxisDevice, NoTorqueUntilEveryDriveObeysAndNoneAfterDisabling) {
  Bench bench;
  bench.move(0, 0, 0);
  bench.drives.now.flags = 0;
  bench.device.receive(bench.sample);
  bench.push({1, 1, 1});
  EXPECT_TRUE(bench.still());
  EXPECT_TRUE(bench.drives.last.enable);
  bench.drives.now.flags = DeviceFlag::kEnabled;
  bench.device.receive(bench.sample);
  bench.push({1, 1, 1});
  EXPECT_FALSE(bench.still());
  bench.push({1, 1, 1}, 0);
  EXPECT_TRUE(bench.still());
  EXPECT_FALSE(bench.drives.last.enable);
}

TEST(AxisDevice, AHandleThatMovesIsNotAtHome) {
  const DeviceProfile profile = test::arm_profile(test::kArm);
  FakeDrives drives;
  AxisDevice device(drives, *profile.arm, profile.frame, 1e-3);
  EXPECT_THAT(device.start([] {}), HasSubstr("no positions of all axes"));
  drives.now.fresh = true;
  EXPECT_THAT(device.start([&] { drives.now.turns[2] += 0.01; }), HasSubstr("axis 3 moved while its home was taken"));
  drives.wrong = "no";
  EXPECT_EQ(device.start([] {}), "no");
}

// Three axes at 1 kHz: 3 x (95 + 135) us and 166 us for an error of 900; a fourth does not fit, at 500 Hz it does.
TEST(DriveBudget, ODrives) {
  ArmProfile arm = *test::arm_profile(test::kArm).arm;
  const BusVerdict three = check_drives_budget(arm, 1e-3);
  EXPECT_TRUE(three.fits);
  EXPECT_NEAR(three.used_us, 3 * (95 + 135) + 31 + 135, 1e-9);
  arm.axes.push_back(arm.axes[0]);
  const BusVerdict four = check_drives_budget(arm, 1e-3);
  EXPECT_FALSE(four.fits);
  EXPECT_THAT(four.text, HasSubstr("half the rate fits"));
  EXPECT_THAT(four.text, HasSubstr("one node on CAN FD"));
  EXPECT_TRUE(check_drives_budget(arm, 2e-3).fits);
}

}  // namespace
}  // namespace palpate
