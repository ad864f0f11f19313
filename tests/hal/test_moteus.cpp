// Three moteus controllers on a bus, simulated byte by byte: found, proved, enabled, rendering the real tick's force,
// and every wrong thing noticed before a motor is on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "hal/drives/drive_link.h"
#include "hal/drives/moteus_drives.h"
#include "hal/drives/moteus_sim.h"
#include "tests/hal/encoder_judge.h"

namespace palpate {
namespace {

using namespace moteus;
using test::replaced;
using testing::HasSubstr;
using MoteusArm = test::WiredArm<MoteusDrives, MoteusSim>;

// The arm of kArm with other drives.
std::string tables() {
  std::string text = test::kArm;
  const auto drives = text.find("[drives]"), axes = text.find("[[axis]]");
  text = text.substr(0, drives) + "[drives]\nprotocol = \"moteus\"\nfirmware = \"0.1.3\"\nwatchdog_ms = 20\n" +
         text.substr(axes);
  return replaced(text, "scale = 2\n", "");
}

std::string refusal(const MoteusFault& fault, const std::string& text = tables()) {
  VirtualClock clock;
  MoteusArm arm(text, clock);
  arm.sim().set_fault(fault);
  const std::string wrong = arm.start();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(arm.sim().enabled(i)) << "enabled before it was proved";
  return wrong;
}

std::string hex(const Frame& frame) {
  std::string text;
  for (int i = 0; i < frame.length; ++i) {
    char two[3];
    std::snprintf(two, sizeof two, "%02x", frame.data[i]);
    text += two;
  }
  return text;
}

Frame frame_of(std::uint32_t id, const std::string& bytes) {
  Frame frame{.id = id, .length = static_cast<std::uint8_t>(bytes.size() / 2), .fd = true};
  for (std::size_t i = 0; i < bytes.size() / 2; ++i)
    frame.data[i] = static_cast<std::uint8_t>(std::stoi(bytes.substr(2 * i, 2), nullptr, 16));
  return frame;
}

// The worked example of mjbots' reference, "CAN protocol": a command with a question.
TEST(MoteusWire, TheReferencesCommandIsWrittenByteForByte) {
  Writer writer(request_id(1));
  writer.write(Type::kInt8, kMode, std::int8_t{10});
  writer.head(kWrite, Type::kInt16, kCommandPosition, 3);
  writer.value(std::int16_t{0x60}), writer.value(std::int16_t{0x120}), writer.value(std::int16_t{-176});
  writer.read(Type::kInt16, kMode, 4);
  writer.read(Type::kInt8, 0x00D, 3);
  EXPECT_EQ(hex(writer.finish()), "01000a07206000200150ff140400130d");
  EXPECT_EQ(writer.finish().id, 0x8001u);
}

// Its answer: position 0.008 turns, velocity 0.064 Hz, torque -1.44 N m, 12 V, 20 degrees, no fault.
TEST(MoteusWire, TheReferencesAnswerIsRead) {
  const Frame frame = frame_of(reply_id(1), "2404000a005000000170ff230d181400");
  Reader reader(frame);
  Part part;
  ASSERT_TRUE(reader.next(part));
  EXPECT_EQ(part.first, 0u);
  ASSERT_EQ(part.count, 4);
  for (const auto& [i, value] : {std::pair{0, 10.0}, {1, 80.0}, {2, 256.0}, {3, -144.0}})
    EXPECT_EQ(part.number(i), value);
  ASSERT_TRUE(reader.next(part));
  EXPECT_EQ(part.first, 0x00Du);
  for (const auto& [i, value] : {std::pair{0, 24.0}, {1, 20.0}, {2, 0.0}}) EXPECT_EQ(part.number(i), value);
  EXPECT_FALSE(reader.next(part));
  EXPECT_FALSE(reader.malformed());
}

TEST(MoteusWire, FramesHaveLengthsOfCanFdAndAreFilledWithNops) {
  Writer writer(request_id(1));
  writer.read(Type::kInt32, kModel, 3);
  EXPECT_EQ(hex(writer.finish()), "1b8002");  // up to 8 bytes every length is one
  writer.read(Type::kInt32, kSerial, 3);
  writer.read(Type::kFloat, kMode, 2);
  writer.read(Type::kInt8, kFault, 1);
  EXPECT_EQ(hex(writer.finish()), "1b80021ba0021e00110f5050");
  for (int i = 0; i < 60; ++i) writer.byte(kNop);
  EXPECT_FALSE(writer.whole());
}

// Every cut, and bits flipped at random: read without leaving the frame, or refused (the address sanitizer watches).
TEST(MoteusWire, GarbageIsReadWithinTheFrame) {
  std::mt19937 draw(23);
  for (int round = 0; round < 200'000; ++round) {
    Frame frame = frame_of(reply_id(1), "2e00000020410000803f210f00410103310d0a50");
    frame.length = static_cast<std::uint8_t>(draw() % 21);
    for (std::uint32_t flips = draw() % 4; flips > 0; --flips)
      frame.data[draw() % 20] ^= static_cast<std::uint8_t>(1u << draw() % 8);
    Reader reader(frame);
    int parts = 0;
    for (Part part; reader.next(part); ++parts)
      if (part.bytes != nullptr) {
        ASSERT_GE(part.bytes, frame.data);
        ASSERT_LE(part.bytes + part.count * (part.kind == kReply || part.kind == kWrite ? size_of(part.type) : 1),
                  frame.data + frame.length);
      }
    ASSERT_LE(parts, 20);
  }
}

TEST(Moteus, ThreeAreFoundAndLetGoWhenCommandsStop) {
  VirtualClock clock;
  MoteusArm arm(tables(), clock);
  EXPECT_EQ(arm.start(), "");
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(arm.sim().enabled(i));
}

TEST(Moteus, WhatIsWrongIsSaidBeforeAMotorIsEnabled) {
  EXPECT_THAT(refusal({.axis = 1, .mute = true}), HasSubstr("axis 2 (moteus id 2): no answer"));
  EXPECT_THAT(refusal({.axis = 0, .reversed = true}),
              HasSubstr("axis 1 (moteus id 1): motor_position.output.sign is '-1'"));
  EXPECT_THAT(refusal({.axis = 2, .brakes = true}), HasSubstr("axis 3 (moteus id 3): servo.timeout_mode is '12'"));
  EXPECT_THAT(refusal({.axis = 2, .no_watchdog = true}), HasSubstr("its watchdog's time cannot be set to 20 ms"));
  EXPECT_THAT(refusal({.axis = 1, .firmware_micro = 9}),
              HasSubstr("has firmware 0.1.9, the profile is written for 0.1.3"));
  EXPECT_THAT(refusal({.axis = 1, .map = 4}), HasSubstr("registers are of version 4"));
  EXPECT_THAT(refusal({.axis = 1, .serial = 77}), HasSubstr("serial number 77 (its lowest 48 bits) is not that"));
  EXPECT_THAT(refusal({.axis = 0, .serial = 61925406831666}), HasSubstr("is that of axis 2: the axes are swapped"));
  EXPECT_THAT(refusal({.axis = 1, .fault = 35}), HasSubstr("reports fault 35 (encoder)"));
  EXPECT_EQ(refusal({}), "");
}

TEST(Moteus, TheHandFeelsTheTicksForce) {
  VirtualClock clock;
  MoteusArm arm(replaced(replaced(tables(), "weight_z_N = -0.5\n", ""), "gravity_Nm = 0.2\n", ""), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(arm, clock, 1200, 2e4, {}, 0, arm.frame());
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_LE(run.summary.stale_ticks, 1u);
  double most_N = 0;
  for (std::size_t i = 600; i < 1100; ++i) {
    const Vec3 told = run.records[i - 1].output.device_w.force_N, felt = arm.rendered_N()[i];
    most_N = std::max(most_N, norm(told));
    // A period later; torques are floats, the joints move on meanwhile, and the Jacobian is that of counted turns.
    EXPECT_LT(norm(felt - told), 0.02 * norm(told) + 0.01) << i;
  }
  EXPECT_GT(most_N, 1.0);
}

TEST(Moteus, SilenceTripsTheWatchdogsAndForceComesBack) {
  VirtualClock clock;
  MoteusArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(
      arm, clock, 2500, 2e4,
      [&arm](const test::Surroundings& s) {
        if (s.tick == 800) arm.far_cable().set(test::BadCable::Fault::kLose);
        if (s.tick == 819) arm.far_cable().set(test::BadCable::Fault::kNone);
      },
      0, arm.frame());
  EXPECT_EQ(run.summary.faults, 0u) << "19 ms without an answer is silence that passes";
  EXPECT_GT(norm(arm.rendered_N()[2400]), 0.5);  // of an object that is met deeper
  arm.silence_controller(true);
  DeviceSample sample;
  for (int i = 0; i < 60; ++i) {
    clock.advance(1'000'000);
    arm.receive(sample);
  }
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(arm.sim().enabled(i));
}

// The hand is freed at once when a drive lets go, and the drive stays so until it is stopped and enabled anew.
TEST(Moteus, AnExpiredWatchdogIsLatchedInTheDrive) {
  VirtualClock clock;
  MoteusArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(
      arm, clock, 2500, 2e4,
      [&arm](const test::Surroundings& s) { arm.silence_controller(s.tick >= 800 && s.tick < 850); }, 0, arm.frame());
  EXPECT_EQ(arm.sim().watchdogs(), 3u);
  EXPECT_EQ(run.summary.faults & Fault::kDeviceSilent, Fault::kDeviceSilent) << "no question, no answer";
  for (std::size_t i = 822; i < arm.rendered_N().size(); ++i) ASSERT_EQ(arm.rendered_N()[i], Vec3{}) << i;
}

TEST(Moteus, AFaultOfOneDriveIsAFaultAndFreesTheHand) {
  VirtualClock clock;
  MoteusArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(
      arm, clock, 1500, 2e4,
      [&arm](const test::Surroundings& s) {
        if (s.tick == 800) arm.sim().set_fault({.axis = 1, .fault = 33});
      },
      0, arm.frame());
  EXPECT_EQ(run.summary.faults & Fault::kDeviceReported, Fault::kDeviceReported);
  EXPECT_EQ(arm.last().error_code, 33u);
  EXPECT_EQ(arm.rendered_N().back(), Vec3{});
}

TEST(Moteus, ADriveThatStaysStoppedIsAFault) {
  VirtualClock clock;
  MoteusArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  arm.sim().set_fault({.axis = 1, .stays_stopped = true});
  const test::FaultRun run = test::run_on(arm, clock, 1500, 2e4, {}, 0, arm.frame());
  EXPECT_EQ(run.summary.faults & Fault::kDeviceReported, Fault::kDeviceReported);
  for (const Vec3 force : arm.rendered_N()) ASSERT_EQ(force, Vec3{}) << "torque before all axes obey";
}

TEST(Moteus, BadCablesAreBorneOrNoticed) { test::expect_bad_cables_are_borne<MoteusArm>(tables()); }
TEST(Moteus, GarbledCommandsEndWithTheCable) { test::expect_garbled_commands_end_with_the_cable<MoteusArm>(tables()); }
TEST(Moteus, WrongEncodersAreBorneOrNoticed) { test::expect_wrong_encoders_are_borne<MoteusArm>(tables()); }
TEST(Moteus, SparsePositionsAreAFault) { test::expect_sparse_positions_are_a_fault<MoteusArm>(tables()); }

// What start() set is gone with the power: enabling it again would drive it without its watchdog.
TEST(Moteus, ADriveThatStartsAnewIsAFaultUntilTheControllerDoes) {
  test::expect_a_restart_is_a_fault<MoteusArm>(
      tables(), MoteusDrives::kRestarted, {20, 300},
      [](MoteusSim& sim, int axis, int periods) { sim.restart(axis, periods); });
}

// Each axis 32 bytes down with 29 bits of identifier and 16 up, at 1 and 5 Mbit/s: three fit, four do not.
TEST(DriveBudget, Moteus) {
  const DeviceProfile profile = test::arm_profile(tables());
  ArmProfile arm = *profile.arm;
  // ISO 11898-1: 57 + 2 and 34 + 2 bits at 1 Mbit/s, 34 + 320 + 5 and 33 + 160 at 5, for each of three; an error of 31
  // bits and the longer frame again.
  const double down_us = 59 + 359 / 5.0, up_us = 36 + 193 / 5.0;
  const BusVerdict three = check_drives_budget(arm, 1e-3);
  EXPECT_NEAR(three.used_us, 3 * (down_us + up_us) + 31 + down_us, 1e-9) << three.text;
  EXPECT_TRUE(three.fits) << three.text;
  arm.axes.push_back(arm.axes[0]);
  EXPECT_FALSE(check_drives_budget(arm, 1e-3).fits);
  EXPECT_TRUE(check_drives_budget(arm, 2e-3).fits);
}

}  // namespace
}  // namespace palpate
