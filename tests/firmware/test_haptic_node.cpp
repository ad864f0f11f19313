// The firmware's node against the project's own codec and local model, which share no line with it, and by its rules.
// What it does on a bus is graded in tests/examples/test_device_examples.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "hal/bus/codec.h"
#include "hal/bus/device_bus.h"
#include "hal/device/local_model.h"
#include "hal/firmware/haptic_node.h"

namespace palpate {
namespace {

constexpr int kNode = 3;
constexpr hn_config kConfig{kNode, 10000, 8.5f, 0.2f, 3000.0f, 5e-5f};

Vec3 vector_of(const float (&v)[3]) {
  return {static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2])};
}

class HapticNode : public testing::Test {
 protected:
  HapticNode() {
    EXPECT_TRUE(hn_init(&node_, &kConfig));
    hn_set_calibrated(&node_, true);
  }
  template <class Message, std::size_t kBytes>
  void send(const Message& message, std::uint32_t identifier) {
    std::uint8_t data[64] = {};
    wire::encode(message, kNode, std::span{data}.first<kBytes>());
    hn_take(&node_, identifier + kNode, data, kBytes);
  }
  void command(Vec3 force_N, bool enable = true, Vec3 torque_Nm = {}) {
    wire::Command message;
    message.sequence = ++number_;
    message.flags = enable ? 1 : 0;
    wire::set_wrench(message, force_N, torque_Nm);
    send<wire::Command, wire::kCommandBytes>(message, wire::kCommandId);
  }
  LocalModel command(Vec3 force_N, const LocalModel& model) {
    wire::LocalCommand message;
    message.sequence = ++number_;
    message.flags = 1;
    wire::set_wrench(message, force_N, {});
    wire::set_local(message, model);
    send<wire::LocalCommand, wire::kLocalCommandBytes>(message, wire::kLocalCommandId);
    return wire::get_local(message);
  }
  void arm() {
    command({}, false);
    command({}, true);
  }
  Vec3 control(const std::int32_t (&position)[3] = {0, 0, 0}) {
    hn_control(&node_, position, &motors_);
    return vector_of(motors_.force_N);
  }
  // What the bus's reader makes of the node's status.
  wire::Status status(const hn_handle& handle = {}) {
    hn_frame frame;
    hn_status(&node_, &handle, 1234567, &frame);
    EXPECT_EQ(frame.identifier, wire::kStatusId + kNode);
    wire::Status read;
    EXPECT_EQ(wire::decode({frame.data, frame.length}, kNode, read), wire::DecodeResult::kOk);
    return read;
  }

  hn_node node_{};
  hn_motors motors_{};
  std::uint32_t number_ = 0;
};

TEST_F(HapticNode, StatusReadsAsItWasMeant) {
  arm();
  const wire::Status said = status({{1234567, -7654321, 9999999}, {-32768, 1, 2, 32767}, 5});
  EXPECT_EQ(said.command_sequence, 2u);
  EXPECT_EQ(said.position[0], 1234567);
  EXPECT_EQ(said.position[1], -7654321);
  EXPECT_EQ(said.position[2], 0x7FFFFF);  // beyond the field: its end
  EXPECT_EQ(said.quaternion[0], -32768);
  EXPECT_EQ(said.quaternion[3], 32767);
  EXPECT_EQ(said.buttons, 5u);
  EXPECT_EQ(said.time_us, 1234567u);
  EXPECT_EQ(said.flags, DeviceFlag::kCalibrated | DeviceFlag::kEnabled | DeviceFlag::kLocalModel);
}

// The same models, refused and cut down alike, and the same force within single precision: 1e-6 of the largest product.
TEST_F(HapticNode, EvaluatesTheLocalModelAsTheSimulatedDeviceDoes) {
  std::mt19937_64 draw(1);
  std::normal_distribution<double> part;
  int taken = 0, dropped = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 n = unit_or({part(draw), part(draw), part(draw)}, {1, 0, 0});
    const double k = 20 * std::exp(1.5 * part(draw)) * 50, spoil = i % 4 == 0 ? 0.02 * k * part(draw) : 0;
    const Vec3 point{0.1 * part(draw), 0.1 * part(draw), 0.1 * part(draw)}, force_N{part(draw), part(draw), part(draw)};
    const LocalModel sent{point, k * Vec3{n.x * n.x, n.y * n.y, n.z * n.z} + Vec3{spoil, 0, 0},
                          k * Vec3{n.y * n.z, n.x * n.z, n.x * n.y}, i % 5 == 0 ? 6e-3 : 2e-3};
    number_ = static_cast<std::uint32_t>(i);
    hn_init(&node_, &kConfig);
    const LocalModel bounded =
        bounded_model(command(force_N, sent), static_cast<double>(kConfig.stiffness_max_N_per_m));
    ASSERT_EQ(node_.command.valid_steps > 0, bounded.valid_s > 0) << i;
    (bounded.valid_s > 0 ? taken : dropped) += 1;
    if (!(bounded.valid_s > 0)) continue;
    std::int32_t position[3];
    for (int axis = 0; axis < 3; ++axis)
      position[axis] = node_.command.point[axis] + static_cast<std::int32_t>(2e4 * part(draw));
    control(position);
    const Vec3 force = vector_of(node_.command.force_N);
    const Vec3 right =
        local_force_N(force, bounded, 1e-7 * Vec3{double(position[0]), double(position[1]), double(position[2])});
    ASSERT_LT(norm(vector_of(node_.wanted_N) - right), 1e-6 * (norm(force) + 3000 * 5e-3)) << i;
  }
  EXPECT_GT(taken, 5000);
  EXPECT_GT(dropped, 2000);
}

// And renders it alike, from the same force before: the handle's way at once, jumps and commands by the slope, within
// the limit. 1e-5 N is what single precision makes of 30 N in a dozen sums.
TEST_F(HapticNode, ComesToAForceAsTheSimulatedDeviceDoes) {
  constexpr double kMax_N = 8.5;
  const LocalLoop loop{1e-4, kMax_N, 1e3 * kLocalSlopeShare_per_ms * kMax_N, 5e-5};
  std::mt19937_64 draw(5);
  std::normal_distribution<double> part;
  arm();
  std::int32_t at[3] = {}, to[3] = {};
  control(at);
  LocalModel model;
  int jumps = 0, limited = 0;
  for (int i = 0; i < 40000; ++i) {
    if (i % 10 == 0 && draw() % 4 != 0) {  // some are lost
      const Vec3 n = unit_or({part(draw), part(draw), part(draw)}, {1, 0, 0});
      const double k = 1500 * std::abs(part(draw));
      const Vec3 point = 1e-7 * Vec3{at[0] + 3e3 * part(draw), at[1] + 3e3 * part(draw), at[2] + 3e3 * part(draw)};
      const LocalModel sent{point, k * Vec3{n.x * n.x, n.y * n.y, n.z * n.z}, k * Vec3{n.y * n.z, n.x * n.z, n.x * n.y},
                            draw() % 4 == 0 ? 0 : 5e-3};
      model = bounded_model(command(Vec3{3 * part(draw), 3 * part(draw), 12 * std::sin(3e-4 * i)}, sent),
                            static_cast<double>(kConfig.stiffness_max_N_per_m));
    }
    const bool goes_on = node_.age_steps < node_.command.valid_steps, jumps_now = draw() % 100 == 0;
    for (int axis = 0; axis < 3; ++axis)
      to[axis] = at[axis] + static_cast<std::int32_t>((jumps_now ? 2e4 : 3e2) * part(draw));
    const auto metres = [](const std::int32_t(&p)[3]) { return 1e-7 * Vec3{double(p[0]), double(p[1]), double(p[2])}; };
    const Vec3 before_N = vector_of(motors_.force_N), asked_N = vector_of(node_.command.force_N);
    LocalModel now = goes_on ? model : LocalModel{};
    // A stale model's force is held: where it came to without one, F.
    const Vec3 held_N = goes_on ? asked_N : vector_of(node_.wanted_N);
    const Vec3 right_N = next_force_N(loop, before_N, held_N, now, {metres(at), metres(to)});
    const Vec3 got_N = control(to);
    if (goes_on || norm(held_N - asked_N) == 0) {
      ASSERT_LT(norm(got_N - right_N), 1e-5) << i;
    }
    jumps += jumps_now ? 1 : 0;
    limited += norm(got_N) > 8.49 ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis) at[axis] = to[axis];
  }
  EXPECT_GT(jumps, 200);
  EXPECT_GT(limited, 100);
}

TEST_F(HapticNode, HoldsWhatAModelCameToWhenItIsStale) {
  arm();
  for (int i = 0; i < 200; ++i) {
    command({2, 0, 0});
    control();
  }
  command({2, 0, 0}, {{0, 0, 0}, {1000, 0, 0}, {}, 3e-3});
  for (int step = 1; step <= 100; ++step) {  // 10 ms; the handle goes on by 0.01 mm a step
    const Vec3 force = control({100 * step, 0, 0});
    EXPECT_NEAR(force.x, 2 - 1000 * 1e-5 * std::min(step, 30), 1e-5) << step;
  }
}

TEST_F(HapticNode, NeverPullsAHandBackThatHasLeft) {
  arm();
  command({2, 0, 0}, {{0, 0, 0}, {1000, 0, 0}, {}, 5e-3});
  for (int i = 0; i < 50; ++i) EXPECT_NEAR(control({50000, 0, 0}).x, 0, 1e-6);
}

TEST_F(HapticNode, SilenceLetsGoUntilEnabledAnew) {
  arm();
  for (int i = 0; i < 300; ++i) {
    command({2, 0, 0}, true, {0.1, 0, 0});
    control();
  }
  EXPECT_NEAR(control().x, 2, 1e-6);
  for (int step = 3; step <= 200; ++step) ASSERT_NEAR(control().x, 2, 1e-6) << step;  // 20 ms
  double before = control().x;
  EXPECT_LT(before, 2);
  for (int step = 0; step < 100; ++step) {
    const double now = control().x;
    ASSERT_GE(now, before - 8.5 / 100 - 1e-6);  // a tenth of the limit in ten steps
    before = now;
  }
  EXPECT_EQ(before, 0);
  EXPECT_EQ(motors_.torque_Nm[0], 0);
  EXPECT_EQ(status().flags & (DeviceFlag::kWatchdog | DeviceFlag::kEnabled), DeviceFlag::kWatchdog);
  command({2, 0, 0});
  EXPECT_EQ(control().x, 0);
  arm();
  command({2, 0, 0});
  EXPECT_GT(control().x, 0);
}

TEST_F(HapticNode, LimitsItsForceAndSaysSo) {
  arm();
  for (int i = 0; i < 300; ++i) {
    command({20, 0, 20});
    control();
  }
  EXPECT_NEAR(norm(control()), 8.5, 1e-5);
  EXPECT_NE(status().flags & DeviceFlag::kSaturated, 0u);
  command({1, 0, 0});
  for (int i = 0; i < 150; ++i) control();
  status();
  control();
  EXPECT_EQ(status().flags & DeviceFlag::kSaturated, 0u);
}

TEST_F(HapticNode, StopAndErrorCutAtOnce) {
  for (const bool stop : {true, false}) {
    arm();
    command({3, 0, 0});
    for (int i = 0; i < 50; ++i) control();
    EXPECT_GT(control().x, 2.9);
    hn_set_stop(&node_, stop);
    hn_set_error(&node_, stop ? 0 : 7);
    EXPECT_EQ(control().x, 0);
    EXPECT_NE(status().flags & (stop ? DeviceFlag::kStopButton : DeviceFlag::kError), 0u);
    hn_set_stop(&node_, false);
    hn_set_error(&node_, 0);
  }
}

TEST_F(HapticNode, RefusesWhatIsNoCommandOfItsOwn) {
  arm();
  const std::uint32_t obeyed = node_.obeyed;
  std::mt19937_64 draw(2);
  for (int i = 0; i < 100000; ++i) {
    std::uint8_t data[64];
    for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(draw());
    const std::uint32_t lengths[] = {0, 1, 8, 20, 32, 48, 64};
    const std::uint32_t identifiers[] = {0x100 + kNode, 0x130 + kNode, 0x104, 0x180 + kNode};
    hn_take(&node_, identifiers[draw() % 4], data, lengths[draw() % 7]);
    control();
  }
  // Two kinds in 28 have the length and identifier of a command; 2^-16 of them the seal: 0.1 expected.
  EXPECT_LE(node_.obeyed, obeyed + 2);
}

TEST(HapticNodeSettings, OutOfRangeRenderNothing) {
  const hn_config wrong[] = {{0, 10000, 8, 0, 0, 0},  {16, 10000, 8, 0, 0, 0}, {1, 999, 8, 0, 0, 0},
                             {1, 20001, 8, 0, 0, 0},  {1, 10000, 0, 0, 0, 0},  {1, 10000, 8, -1, 0, 0},
                             {1, 10000, 8, 0, -1, 0}, {1, 10000, 8, 0, 0, -1}};
  for (const hn_config& config : wrong) {
    hn_node node;
    EXPECT_FALSE(hn_init(&node, &config));
    hn_motors motors{{1, 1, 1}, {1, 1, 1}};
    const std::int32_t position[3] = {};
    hn_control(&node, position, &motors);
    EXPECT_EQ(vector_of(motors.force_N), Vec3{});
  }
}

}  // namespace
}  // namespace palpate
