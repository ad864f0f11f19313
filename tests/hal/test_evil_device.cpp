// Forty ways for a device to attack its controller, in virtual time with the real loop and tick. Whatever it sends,
// what comes back is finite, within the device's limit, changes by at most a tenth of it in a tick, and is zero within
// the stated time where the attack is a fault. The kinds are those of a review that found four holes (2026-11-22).
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>

#include <cctype>
#include <cmath>
#include <ostream>

#include "tests/hal/evil_device.h"
#include "tests/hal/fault_judge.h"

namespace palpate {
namespace {

using test::Attack;
using test::Attacker;
using test::EvilDevice;
using test::FaultRun;
using test::kTick;

// `fault`: any of these bits must be latched (0: none may be). `zero_ticks`: from the attack until the force stays
// zero.
struct Kind {
  const char* name;
  Attacker attacker;
  std::uint32_t fault = 0;
  std::size_t zero_ticks = 0;
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

// Tick of silence or rejection that latches (20), and the ramp that has begun before: as docs/faults.md has it, with
// the tenth a tick that a full force may need.
constexpr std::size_t kSilentZero = 30;
constexpr std::size_t kReportedZero = 25;                       // ramp_out_s is 20 ticks
constexpr std::size_t kDeafZero = 20 + 20 + 5;                  // lag limit, ramp, reading back
constexpr std::size_t kUnwillingZero = 3 * (20 + 5 + 20) + 10;  // three edges in vain: ramp, rest, waiting
constexpr std::size_t kBuzzZero = 40 + 20;     // swings until they count as unstable (20 at 1 kHz), ramp
constexpr std::size_t kSparseZero = 430 + 20;  // 256 ticks times ln(0.5 / 0.1): half of them, against a share of 0.4
constexpr std::uint32_t kRefused = Fault::kSamplesRejected;
constexpr std::uint32_t kSilent = Fault::kDeviceSilent;

std::uint32_t draw(Attack& a) { return static_cast<std::uint32_t>((*a.random)()); }
std::int32_t count(Attack& a, int bits) { return static_cast<std::int32_t>(draw(a)) >> (32 - bits); }

void turn_half(wire::Status& s) {  // by 180 degrees about x: w x y z -> -x w -z y
  const std::int32_t q[4] = {s.quaternion[0], s.quaternion[1], s.quaternion[2], s.quaternion[3]};
  s.quaternion[0] = -q[1], s.quaternion[1] = q[0], s.quaternion[2] = -q[3], s.quaternion[3] = q[2];
}

void set_turn(wire::Status& s, double angle_rad) {
  s.quaternion[0] = static_cast<std::int32_t>(32767 * std::cos(angle_rad / 2));
  s.quaternion[1] = 0;
  s.quaternion[2] = 0;
  s.quaternion[3] = static_cast<std::int32_t>(32767 * std::sin(angle_rad / 2));
}

Frame garbage(Attack& a) {
  Frame frame;
  frame.id = draw(a) % 4 == 0 ? 0x181u : draw(a) & 0x7FFu;
  frame.fd = true;
  frame.length = draw(a) % 2 == 0 ? 32 : static_cast<std::uint8_t>(draw(a) % 65);
  for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(draw(a));
  return frame;
}

std::vector<Kind> orientation_kinds() {
  return {
      {"one_half_turn",
       [](Attack& a) {
         if (a.since == 0) turn_half(a.status);
       }},
      {"half_turn_every_other_tick",
       [](Attack& a) {
         if (a.since % 2 == 0) turn_half(a.status);
       }},
      {"half_turn_for_good", [](Attack& a) { turn_half(a.status); }, kRefused, kSilentZero},
      {"random_quaternions",
       [](Attack& a) {
         for (auto& q : a.status.quaternion) q = count(a, 16);
       },
       kRefused, kSilentZero},
      {"zero_quaternion",
       [](Attack& a) {
         for (auto& q : a.status.quaternion) q = 0;
       },
       kRefused, kSilentZero},
      {"quaternion_too_short",
       [](Attack& a) {
         for (auto& q : a.status.quaternion) q = q * 9 / 10;
       },
       kRefused, kSilentZero},
      {"spins_at_200_rad_per_s", [](Attack& a) { set_turn(a.status, 0.2 * static_cast<double>(a.since + 1)); },
       kRefused, kSilentZero},
      {"spins_as_fast_as_allowed", [](Attack& a) { set_turn(a.status, 0.029 * static_cast<double>(a.since)); }},
  };
}

std::vector<Kind> position_kinds() {
  const auto shift = [](Attack& a, double x_m) { a.status.position[0] += static_cast<std::int32_t>(x_m * 1e7); };
  return {
      {"random_positions",
       [](Attack& a) {
         for (auto& p : a.status.position) p = count(a, 24);
       },
       kRefused, kSilentZero},
      {"positions_at_the_range",
       [](Attack& a) {
         for (auto& p : a.status.position) p = a.since % 2 == 0 ? 8388607 : -8388608;
       },
       kRefused, kSilentZero},
      {"square_wave_of_1_mm", [=](Attack& a) { shift(a, a.since % 2 == 0 ? 5e-4 : -5e-4); }, Fault::kUnstable,
       kBuzzZero},
      {"square_wave_of_1.9_mm", [=](Attack& a) { shift(a, a.since % 2 == 0 ? 0 : 1.9e-3); }, Fault::kUnstable,
       kBuzzZero},
      {"square_wave_of_8_mm", [=](Attack& a) { shift(a, a.since % 2 == 0 ? 0 : 8e-3); }},
      {"sweeps_at_top_speed", [=](Attack& a) { shift(a, 1.9e-3 * static_cast<double>(a.since % 20)); }},
      {"jumps_by_100_mm", [=](Attack& a) { shift(a, 0.1); }, kRefused, kSilentZero},
      {"jumps_by_10_mm_to_and_fro", [=](Attack& a) { shift(a, a.since % 40 < 20 ? 0.01 : 0); }},
      {"frozen",
       [p = wire::Status{}](Attack& a) mutable {
         if (a.since == 0) p = a.status;
         for (int i = 0; i < 3; ++i) a.status.position[i] = p.position[i];
       }},
  };
}

std::vector<Kind> frame_kinds() {
  return {
      {"silent", [](Attack& a) { a.send = false; }, kSilent, kSilentZero},
      {"silent_10_of_50_ms", [](Attack& a) { a.send = a.since % 50 >= 10; }},
      {"every_other_lost", [](Attack& a) { a.send = a.since % 2 == 0; }, Fault::kSamplesSparse, kSparseZero},
      {"wrong_checksum",
       [](Attack& a) {
         a.frames = {EvilDevice::frame_of(a.status)};
         a.frames[0].data[30] ^= 1;
       },
       kSilent, kSilentZero},
      {"wrong_length",
       [](Attack& a) {
         a.frames = {EvilDevice::frame_of(a.status)};
         a.frames[0].length = 24;
       },
       kSilent, kSilentZero},
      {"longest_length",
       [](Attack& a) {
         a.frames = {EvilDevice::frame_of(a.status)};
         a.frames[0].length = 64;
       },
       kSilent, kSilentZero},
      {"another_node",
       [](Attack& a) {
         a.frames = {EvilDevice::frame_of(a.status)};
         a.frames[0].id = 0x182;
       },
       kSilent, kSilentZero},
      {"another_version", [](Attack& a) { a.status.version = 1; }, kSilent, kSilentZero},
      {"classic_frames",
       [](Attack& a) {
         a.frames = {EvilDevice::frame_of(a.status)};
         a.frames[0].fd = false;
         a.frames[0].length = 8;
       },
       kSilent, kSilentZero},
      {"garbage",
       [](Attack& a) {
         for (int i = 0; i < 60; ++i) a.frames.push_back(garbage(a));
       },
       kSilent, kSilentZero},
      {"garbage_around_honest_samples",
       [](Attack& a) {
         for (int i = 0; i < 15; ++i) a.frames.push_back(garbage(a));
         a.frames.push_back(EvilDevice::frame_of(a.status));
         for (int i = 0; i < 15; ++i) a.frames.push_back(garbage(a));
       }},
      {"bus_off",
       [](Attack& a) {
         Frame frame;
         frame.id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
         frame.length = CAN_ERR_DLC;
         a.frames = {frame};
       },
       Fault::kBusOff, kReportedZero},
  };
}

std::vector<Kind> number_kinds() {
  const auto old = [](Attack& a, std::size_t back) { a.frames = {(*a.sent_before)[a.tick - back]}; };
  return {
      {"replays_a_second_for_ever", [=](Attack& a) { old(a, 500); }, Fault::kDeviceDeaf | kRefused, kDeafZero + 40},
      {"replays_one_frame", [](Attack& a) { a.frames = {(*a.sent_before)[300]}; }, kSilent, kSilentZero},
      {"old_frames_among_honest_ones",
       [=](Attack& a) {
         a.frames = {(*a.sent_before)[a.tick - 30], EvilDevice::frame_of(a.status), (*a.sent_before)[a.tick - 60]};
       }},
      {"number_stands_still", [](Attack& a) { a.status.sequence = 7; }, kSilent, kSilentZero},
      {"random_numbers", [](Attack& a) { a.status.sequence = draw(a) & 0xFFFFu; }},
      {"numbers_run_a_thousand_at_a_time",
       [](Attack& a) { a.status.sequence = static_cast<std::uint32_t>(1000 * a.since) & 0xFFFFu; }},
      {"clock_runs_back", [](Attack& a) { a.status.time_us = 1'000'000 - a.status.time_us; }},
  };
}

std::vector<Kind> state_kinds() {
  return {
      {"emergency_stop", [](Attack& a) { a.status.flags |= DeviceFlag::kStopButton; }, Fault::kDeviceReported,
       kReportedZero},
      {"error", [](Attack& a) { a.status.flags |= DeviceFlag::kError; }, Fault::kDeviceReported, kReportedZero},
      {"lost_calibration", [](Attack& a) { a.status.flags &= ~DeviceFlag::kCalibrated; }, Fault::kNotCalibrated,
       kReportedZero},
      {"calibration_comes_and_goes",
       [](Attack& a) {
         if (a.since % 2 == 0) a.status.flags &= ~DeviceFlag::kCalibrated;
       },
       Fault::kNotCalibrated, kReportedZero},
      {"deaf_for_good", [](Attack& a) { a.hear = false; }, Fault::kDeviceDeaf, kDeafZero},
      {"deaf_for_30_ms", [](Attack& a) { a.hear = a.since >= 30; }},
      {"deaf_30_of_400_ms", [](Attack& a) { a.hear = a.since % 400 >= 30; }},
      {"hears_and_says_it_does_not", [](Attack& a) { a.status.command_sequence = 3; }, Fault::kDeviceDeaf, kDeafZero},
      {"always_let_go", [](Attack& a) { a.status.flags |= DeviceFlag::kWatchdog; }, Fault::kDeviceDeaf, kUnwillingZero},
      {"random_echo", [](Attack& a) { a.status.command_sequence = draw(a) & 0xFFFFu; }, Fault::kDeviceDeaf, kDeafZero},
      {"echo_ahead", [](Attack& a) { a.status.command_sequence += 100; }, Fault::kDeviceDeaf, kDeafZero},
      {"random_buttons_and_flags_that_mean_nothing",
       [](Attack& a) {
         a.status.buttons = draw(a) & 0xFFu;
         a.status.flags |= draw(a) & 0xFFE0u;
       }},
  };
}

class EvilDeviceTest : public testing::TestWithParam<Kind> {};

std::string name_of(const testing::TestParamInfo<Kind>& info) {
  std::string name = info.param.name;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Orientation, EvilDeviceTest, testing::ValuesIn(orientation_kinds()), name_of);
INSTANTIATE_TEST_SUITE_P(Position, EvilDeviceTest, testing::ValuesIn(position_kinds()), name_of);
INSTANTIATE_TEST_SUITE_P(Frames, EvilDeviceTest, testing::ValuesIn(frame_kinds()), name_of);
INSTANTIATE_TEST_SUITE_P(Numbers, EvilDeviceTest, testing::ValuesIn(number_kinds()), name_of);
INSTANTIATE_TEST_SUITE_P(State, EvilDeviceTest, testing::ValuesIn(state_kinds()), name_of);

TEST_P(EvilDeviceTest, IsBoundedSoftAndEndsAsStated) {
  const Kind& kind = GetParam();
  VirtualClock clock;
  EvilDevice device(clock, kTick, kind.attacker);
  const FaultRun run = test::run_on(device, clock, 3000);
  const double most_N = run.limits.force_max_N, step_N = kOutputStepShare * most_N;
  ASSERT_GT(test::force_N(run, kTick - 1), 0.5) << "the attack comes under load";
  double largest_N = 0, felt_N = 0;
  Vec3 last_N;
  for (const TickRecord& record : run.records) {
    const Vec3 now_N = record.output.device_w.force_N;
    ASSERT_TRUE(is_finite(now_N) && is_finite(record.output.device_w.torque_Nm));
    ASSERT_LE(norm(now_N), most_N * (1 + 1e-12));
    largest_N = max_of(largest_N, norm(now_N - last_N));
    last_N = now_N;
  }
  EXPECT_LE(largest_N, step_N * (1 + 1e-9));
  const std::vector<Vec3>& motor_N = device.motor_N();
  for (std::size_t i = 1; i < motor_N.size(); ++i) {
    // What a node does by itself, its watchdog, is not the controller's step.
    const bool lets_go = motor_N[i] == Vec3{};
    if (!lets_go) felt_N = max_of(felt_N, norm(motor_N[i] - motor_N[i - 1]));
  }
  EXPECT_LE(felt_N, step_N + 1e-3 * 2) << "at the device, in counts of 1 mN";
  if (kind.fault == 0) {
    EXPECT_EQ(run.summary.faults, 0u);
    return;
  }
  EXPECT_NE(run.summary.faults & kind.fault, 0u) << run.summary.faults;
  for (std::size_t i = kTick + kind.zero_ticks; i < run.records.size(); ++i)
    ASSERT_EQ(run.records[i].output.device_w, Wrench{}) << i - kTick << " ticks after the attack began";
  EXPECT_EQ(motor_N.back(), Vec3{});
}

}  // namespace
}  // namespace palpate
