// A Falcon behind its serial adapter, simulated byte by byte: found, homed, rendering the real tick's force, and every
// wrong thing noticed before a motor pulls.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "hal/drives/drive_link.h"
#include "hal/drives/falcon_drives.h"
#include "hal/drives/falcon_sim.h"
#include "tests/hal/encoder_judge.h"

namespace palpate {
namespace {

using namespace falcon;
using test::replaced;
using testing::HasSubstr;
using FalconArm = test::WiredArm<FalconDrives, FalconSim>;

// The shipped profile's, but that the place of the base is found by WiredArm.
std::string tables() {
  std::ifstream stream(std::string(PALPATE_SOURCE_DIR) + "/config/devices/example-falcon.toml");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return text.substr(text.find("[linkage]"));
}

std::string refusal(const FalconFault& fault) {
  VirtualClock clock;
  FalconArm arm(tables(), clock);
  arm.sim().set_fault(fault);
  const std::string wrong = arm.start();
  EXPECT_FALSE(arm.sim().any_enabled()) << "enabled before it was proved";
  for (int i = 0; i < 3; ++i) EXPECT_EQ(arm.sim().torque_Nm(i), 0.0);
  return wrong;
}

// By hand: 0x1234, -1 and 0 with the lowest nibble first, the encoders of motors 1 and 3 at home, button 2.
TEST(FalconWire, APacketByHand) {
  const Packet packet{{0x1234, -1, 0}, 0x52};
  const Frame frame = packet_frame(usb::kOut, packet);
  ASSERT_EQ(frame.length, kPacketBytes);
  const std::string bytes(reinterpret_cast<const char*>(frame.data), kPacketBytes);
  EXPECT_EQ(bytes, std::string("<EDCBPPPPAAAA\x93") + "A>");
  PacketReader reader;
  Packet back;
  int whole = 0;
  for (const char c : bytes) whole += reader.take(static_cast<std::uint8_t>(c), back);
  EXPECT_EQ(whole, 1);
  for (int i = 0; i < kMotors; ++i) EXPECT_EQ(back.number[i], packet.number[i]);
  EXPECT_EQ(back.bits, packet.bits);
}

// Cut and joined anywhere, with bytes lost: what comes out is what went in, or nothing.
TEST(FalconWire, AStreamWithHolesGivesWholePacketsOnly) {
  std::mt19937 draw(5);
  PacketReader reader;
  int whole = 0, lost = 0;
  for (int n = 0; n < 20'000; ++n) {
    Packet sent{{}, static_cast<std::uint8_t>(draw() % 0x80)}, got;
    sent.number[0] = static_cast<std::int16_t>(draw());
    sent.number[1] = sent.number[0];
    sent.number[2] = static_cast<std::int16_t>(~sent.number[0]);
    const Frame frame = packet_frame(usb::kIn, sent);
    const int hole = draw() % 4 == 0 ? static_cast<int>(draw() % kPacketBytes) : -1;
    lost += hole >= 0;
    for (int i = 0; i < kPacketBytes; ++i) {
      if (i == hole || !reader.take(frame.data[i], got)) continue;
      whole += 1;
      ASSERT_EQ(got.number[0], got.number[1]) << n;
      ASSERT_EQ(got.number[2], static_cast<std::int16_t>(~got.number[0])) << n;
    }
  }
  EXPECT_EQ(whole, 20'000 - lost);
}

// Any bytes at all: nothing but what a packet may hold.
TEST(FalconWire, NoBytesAreBelievedThatAreNoPacket) {
  std::mt19937 draw(6);
  PacketReader reader;
  Packet got;
  for (int n = 0; n < 2'000'000; ++n)
    if (reader.take(static_cast<std::uint8_t>('<' + draw() % 24), got)) {
      ASSERT_LT(got.bits, 0x80);
    }
}

TEST(Falcon, EveryWrongDeviceIsRefusedBeforeAMotorPulls) {
  EXPECT_THAT(refusal({.no_firmware = true}), HasSubstr("does not answer: it is not powered"));
  EXPECT_THAT(refusal({.other_speech = true}), HasSubstr("not a Falcon's packets"));
  EXPECT_THAT(refusal({.slow_adapter = true}), HasSubstr("holds bytes back for 16 ms and cannot be set to 1"));
  EXPECT_THAT(refusal({.stays_away = true}), HasSubstr("encoders 2 have not passed their index marks"));
  EXPECT_EQ(refusal({}), "");
}

TEST(Falcon, ProfilesThatNoFalconHasAreRefused) {
  const auto error_of = [](const std::string& text) {
    std::string error;
    EXPECT_FALSE(parse_device_profile(test::kArmDevice + text, "falcon.toml", error));
    return error;
  };
  EXPECT_THAT(error_of(replaced(tables(), "node = 3", "node = 4")), HasSubstr("a Falcon's motors are 1 to 3"));
  EXPECT_THAT(error_of(replaced(tables(), "torque_max_Nm = 0.053", "torque_max_Nm = 0.06")),
              HasSubstr("more than rated_Nm"));
  EXPECT_THAT(error_of(replaced(tables(), "rated_Nm = 0.053", "")), HasSubstr("rated_Nm"));
  EXPECT_THAT(error_of(replaced(tables(), "calibrate = \"index\"", "calibrate = \"absolute\"")),
              HasSubstr("calibrate = \"index\""));
  std::string serial = replaced(tables(), "kind = \"delta\"", "kind = \"serial_3r\"");
  for (const char* key : {"base_mm = 37.23\n", "plate_mm = 14\n", "hinge_mm = 22.5\n", "aside_mm = 2.33\n"})
    serial = replaced(serial, key, "");
  EXPECT_THAT(error_of(serial), HasSubstr("goes with kind = \"delta\""));
}

TEST(Falcon, TheHandFeelsTheTicksForce) {
  VirtualClock clock;
  FalconArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  arm.sim().press(0x5);
  const test::FaultRun run = test::run_on(arm, clock, 1200, 2e4, {}, 0, arm.frame());
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_LE(run.summary.stale_ticks, 1u);
  EXPECT_EQ(arm.last().buttons, 0x5u);
  double most_N = 0;
  for (std::size_t i = 600; i < 1100; ++i) {
    const Vec3 told = run.records[i - 1].output.device_w.force_N, felt = arm.rendered_N()[i];
    most_N = std::max(most_N, norm(told));
    // A period later; a step of a motor's 4096 is 1.7 mN at the handle, the joints move on meanwhile, and the Jacobian
    // is that of counted turns.
    EXPECT_LT(norm(felt - told), 0.02 * norm(told) + 0.01) << i;
  }
  EXPECT_GT(most_N, 1.0);
}

// Off and on: its encoders have lost their place, and it says so.
TEST(Falcon, ALostHomeIsAFaultAndFreesTheHand) {
  VirtualClock clock;
  FalconArm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(
      arm, clock, 1500, 2e4,
      [&arm](const test::Surroundings& s) {
        if (s.tick == 800) arm.sim().restart();
      },
      0, arm.frame());
  EXPECT_EQ(run.summary.faults & Fault::kDeviceReported, Fault::kDeviceReported);
  EXPECT_EQ(arm.last().error_code, FalconDrives::kNotHomed);
  for (std::size_t i = 802; i < arm.rendered_N().size(); ++i) ASSERT_EQ(arm.rendered_N()[i], Vec3{}) << i;
}

TEST(Falcon, BadCablesAreBorneOrNoticed) { test::expect_bad_cables_are_borne<FalconArm>(tables()); }
TEST(Falcon, GarbledCommandsEndWithTheCable) { test::expect_garbled_commands_end_with_the_cable<FalconArm>(tables()); }
TEST(Falcon, WrongEncodersAreBorneOrNoticed) { test::expect_wrong_encoders_are_borne<FalconArm>(tables()); }
TEST(Falcon, SparsePositionsAreAFault) { test::expect_sparse_positions_are_a_fault<FalconArm>(tables()); }

TEST(Falcon, IsSpokenToOverUsbAndNothingElse) {
  const DeviceProfile profile = test::arm_profile(tables());
  std::string error;
  EXPECT_EQ(open_drives({TransportKind::kCan, "vcan0"}, *profile.arm, DeviceSide::kController, 1, error), nullptr);
  EXPECT_THAT(error, HasSubstr("a Falcon is spoken to over USB"));
  EXPECT_EQ(open_drives({TransportKind::kUsb, "/dev/null"}, *profile.arm, DeviceSide::kController, 1, error), nullptr);
  EXPECT_THAT(error, HasSubstr("/dev/null is no USB device"));
  EXPECT_EQ(open_drives({TransportKind::kUsb, "/nowhere"}, *profile.arm, DeviceSide::kDevice, 1, error), nullptr);
  EXPECT_THAT(error, HasSubstr("is it a mounted function"));
}

TEST(DriveBudget, AFalconsLine) {
  const DeviceProfile profile = test::arm_profile(tables());
  const BusVerdict verdict = check_drives_budget(*profile.arm, 1e-3);
  EXPECT_NEAR(verdict.used_us, 16 * 10 / 1.5, 1e-9);
  EXPECT_TRUE(verdict.fits);
  EXPECT_FALSE(check_drives_budget(*profile.arm, 1e-4).fits);
}

}  // namespace
}  // namespace palpate
