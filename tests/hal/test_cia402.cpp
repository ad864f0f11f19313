// Three CiA 402 drives on a bus, simulated byte by byte: found, proved, mapped, enabled step by step, rendering the
// real tick's force, and every wrong thing noticed before a motor is on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "hal/drives/cia402_drives.h"
#include "hal/drives/cia402_emergency.h"
#include "hal/drives/cia402_sim.h"
#include "hal/drives/drive_link.h"
#include "tests/hal/dissector.h"
#include "tests/hal/encoder_judge.h"

namespace palpate {
namespace {

using namespace canopen;
using test::replaced;
using testing::HasSubstr;
using Cia402Arm = test::WiredArm<Cia402Drives, Cia402Sim>;

// The arm of kArm with other drives; weightless, so that what the hand feels is the tick's force alone.
std::string tables() {
  std::string text = test::kArm;
  const auto drives = text.find("[drives]"), axes = text.find("[[axis]]");
  text = text.substr(0, drives) +
         "[drives]\nprotocol = \"cia402\"\nwatchdog_ms = 20\nvendor_id = 739\nproduct_code = 4660\nrevision = 65538\n" +
         text.substr(axes);
  for (int i = 0; i < 3; ++i) {
    text = replaced(text, "serial = 6192540683166" + std::to_string(5 + i), "serial = 10" + std::to_string(i));
    text = replaced(text, "torque_max_Nm = 0.1\n", "torque_max_Nm = 0.10\nrated_Nm = 0.125\n");
  }
  return replaced(replaced(replaced(text, "scale = 2\n", ""), "weight_z_N = -0.5\n", ""), "gravity_Nm = 0.2\n", "");
}

template <class Meddle>
std::string refusal(Meddle meddle, const std::string& text = tables()) {
  VirtualClock clock;
  Cia402Arm arm(text, clock);
  meddle(arm.sim());
  const std::string wrong = arm.start();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(arm.sim().enabled(i)) << "enabled before it was proved";
  return wrong;
}

TEST(Cia402, ThreeDrivesAreFoundMappedAndWatched) {
  VirtualClock clock;
  Cia402Arm arm(tables(), clock);
  EXPECT_EQ(arm.start(), "");
  for (int i = 0; i < 3; ++i) {
    const auto node = static_cast<std::uint32_t>(i + 1);
    EXPECT_EQ(arm.sim().object(i, kConsumerHeartbeat), 127u << 16 | 20u);
    EXPECT_EQ(arm.sim().object(i, kAbortOption), 1u);
    EXPECT_EQ(arm.sim().object(i, kMaxTorque), 800u) << "0.1 of 0.125 N m";
    EXPECT_EQ(arm.sim().object(i, kRpdoCount + 2), 0x60710010u);
    EXPECT_EQ(arm.sim().object(i, kTpdoCount + 2), 0x60640020u);
    EXPECT_EQ(arm.sim().object(i, kTpdoCob), 0x40000180u + node);
    EXPECT_FALSE(arm.sim().enabled(i));
  }
}

// CANopen as another program reads it: every question of start-up has its answer, what is set is set at each drive
// alike, and in the loop a SYNC has a torque to each drive and a position from each.
TEST(Cia402, AnotherDissectorReadsTheBus) {
  VirtualClock clock;
  Cia402Arm arm(tables(), clock);
  std::vector<Frame> frames;
  arm.cable().tap(frames);
  ASSERT_EQ(arm.start(), "");
  constexpr std::size_t kTicks = 1000;
  test::run_on(arm, clock, kTicks, 2e4, {}, 0, arm.frame());
  const std::string file = testing::TempDir() + "cia402.pcap";
  test::write_capture(file, frames);
  enum Field { kFunction, kNode, kIndex, kSubindex, kClient, kNmt, kState, kMalformed };
  const test::Dissected seen =
      test::dissect(file, "canopen",
                    {"canopen.function_code", "canopen.node_id", "canopen.sdo.main_idx", "canopen.sdo.sub_idx",
                     "canopen.sdo.ccs", "canopen.nmt_ctrl.cd", "canopen.nmt_guard.state", "_ws.malformed"});
  ASSERT_EQ(seen.size(), frames.size()) << "tshark failed or is missing; install the package tshark";
  std::map<int, std::map<int, std::size_t>> count;  // by function code and node
  std::map<int, std::set<std::string>> written;     // objects, by node
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::vector<std::string>& row = seen[i];
    EXPECT_EQ(row[kMalformed], "") << i;
    const int function = std::stoi(row[kFunction], nullptr, 16), node = std::stoi(row[kNode], nullptr, 16);
    count[function][node] += 1;
    if (function == kSdoRequest >> 7) {
      ASSERT_LT(i + 1, seen.size());
      const std::vector<std::string>& reply = seen[i + 1];
      EXPECT_EQ(std::stoi(reply[kFunction], nullptr, 16), kSdoReply >> 7) << i;
      EXPECT_EQ(reply[kNode] + reply[kIndex] + reply[kSubindex], row[kNode] + row[kIndex] + row[kSubindex]) << i;
      if (row[kClient] == "1") written[node].insert(row[kIndex]);
    }
    if (function == kHeartbeat >> 7 && node == kMasterNode) {
      EXPECT_EQ(row[kState], "0x05");
    }
  }
  const std::set<std::string> expected{"0x1016", "0x1400", "0x1600", "0x1800", "0x1a00",
                                       "0x6007", "0x6060", "0x6072", "0x60c2"};
  // The last tick's SYNC and those of the commands that end the run have nobody who waits for an answer.
  const std::size_t unheard = 1 + LoopOptions{}.zero_ticks;
  const std::size_t syncs = count[kSync >> 7][0];
  EXPECT_GE(syncs, kTicks);
  for (int node = 1; node <= 3; ++node) {
    EXPECT_EQ(written[node], expected) << node;
    EXPECT_EQ(count[kRpdo1 >> 7][node], syncs) << node;
    EXPECT_EQ(count[kTpdo1 >> 7][node] + unheard, syncs) << node;
  }
  EXPECT_EQ(std::ranges::count_if(seen, [](const auto& row) { return row[kNmt] == "0x01"; }), 3) << "started";
}

TEST(Cia402, WhatIsWrongIsSaidBeforeAMotorIsEnabled) {
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.mute(1); }), HasSubstr("axis 2 (CANopen node 2): does not answer"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(1, kDeviceType, 0x191); }), HasSubstr("is no CiA 402 drive"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(1, kVendor, 1); }),
              HasSubstr("vendor is 1, the profile says 739"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(1, kRevision, 1); }), HasSubstr("another drive or firmware"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(1, kSerial, 7); }), HasSubstr("serial number 7 is not that"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(1, kSerial, 102); }),
              HasSubstr("of axis 3: the axes are swapped"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(0, kPolarity, 0x80); }),
              HasSubstr("polarity (object 607Eh) is reversed: 0x80"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.hide_object(0, kPolarity); }),
              HasSubstr("polarity (object 607Eh) cannot be read: abort 0x8000000; a reversed sign would not show"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(0, kEncoderIncrements, 4096); }),
              HasSubstr("encoder increments is 4096, the profile says 8192"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(0, kRatedTorque, 250); }),
              HasSubstr("rated torque in mN m is 250"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.set_object(2, kSupportedModes, 1); }),
              HasSubstr("no cyclic synchronous torque"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.freeze_object(2, kModeDisplay); }),
              HasSubstr("stays in mode 0, asked for 10"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.freeze_object(2, kConsumerHeartbeat); }), HasSubstr("its watchdog is off"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.freeze_object(2, kAbortOption); }), HasSubstr("its watchdog is off"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.freeze_object(2, kTpdoCount + 2); }), HasSubstr("object 1A00h:2 holds 0x0"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.freeze_object(2, kMaxTorque); }), HasSubstr("object 6072h:0 holds 0x3E8"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.fail(0, 0x4210); }),
              HasSubstr("axis 1 (CANopen node 1): is in fault, emergency 0x4210 (device too hot; error register 0x09: "
                        "generic, temperature)"));
}

// A drive without that object can reverse nothing; the person is told that nothing was compared.
TEST(Cia402, ADriveWithoutPolarityIsToldOf) {
  VirtualClock clock;
  Cia402Arm arm(tables(), clock);
  arm.sim().remove_object(1, kPolarity);
  EXPECT_EQ(arm.start(), "");
  EXPECT_EQ(arm.axes().remarks(),
            "axis 2 (CANopen node 2): has no polarity object (607Eh): its sign was not compared\n");
}

// Codes and classes as CiA 301 and the drive profile number them, register bits as object 1001h has them.
TEST(Cia402, EmergenciesAreToldInWords) {
  EXPECT_EQ(emergency_text(0x2310, 0x03),
            "0x2310 (continuous over-current at the motor; error register 0x03: generic, current)");
  EXPECT_THAT(emergency_text(0x2311, 0x03), HasSubstr("0x2311 (continuous over-current at the motor;"));
  EXPECT_THAT(emergency_text(0x3210, 0x05), HasSubstr("DC link voltage too high"));
  EXPECT_THAT(emergency_text(0x3220, 0x05), HasSubstr("DC link voltage too low"));
  EXPECT_THAT(emergency_text(0x7300, 0x21),
              HasSubstr("sensor: encoder or its cable; error register 0x21: generic, of "));
  EXPECT_THAT(emergency_text(0x8130, 0x11), HasSubstr("heartbeat: the controller was not heard in time"));
  EXPECT_THAT(emergency_text(0x8130, 0x11), HasSubstr("generic, communication)"));
  EXPECT_THAT(emergency_text(0x8250, 0x10), HasSubstr("an RPDO did not come in time"));
  EXPECT_THAT(emergency_text(0x5FFF, 0x00), HasSubstr("hardware of the drive; error register 0x00)"));
  EXPECT_THAT(emergency_text(0xFF07, 0x80),
              HasSubstr("maker's own: its manual tells; error register 0x80: the maker's"));
  EXPECT_THAT(emergency_text(0xA000, 0xFF), HasSubstr("no known class"));
}

// calibrate = "index": the drives were switched on anywhere, and the joints are right all the same.
std::string indexed() {
  std::string text = replaced(tables(), "calibrate = \"home_pose\"", "calibrate = \"index\"");
  for (const char* home : {"home_deg = 0\n", "home_deg = 80\n", "home_deg = -20\n"})
    text = replaced(text, home, std::string(home) + "home_turns = 0\n");
  return text;
}

TEST(Cia402, EncodersCountFromTheirIndexMarks) {
  VirtualClock clock;
  Cia402Arm arm(indexed(), clock);
  ASSERT_EQ(arm.start(), "");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(arm.sim().object(i, kProbeFunction), 0x15u);
    // Caught a turn before, at and a turn behind the mark that home_turns counts from.
    EXPECT_EQ(arm.sim().object(i, kProbePosition), static_cast<std::uint32_t>(-123456 * (i + 1) + 8192 * (i - 1)));
    EXPECT_FALSE(arm.sim().enabled(i));
  }
  const test::FaultRun run = test::run_on(arm, clock, 1500, 2e4, {}, 0, arm.frame());
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_GT(norm(arm.rendered_N()[1400]), 1.0);
  // Half a count of 8192 behind 1:12.
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(arm.axes().joint(i), arm.sim().plant().joint(i), 1e-3) << i;
}

TEST(Cia402, AnEncoderThatDoesNotPassItsIndexIsRefused) {
  EXPECT_EQ(refusal([](Cia402Sim& s) { s.lay_beside_home(1, -0.24); }, indexed()), "");
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.lay_beside_home(1, 0.3125); }, indexed()),
              HasSubstr("axis 2 (CANopen node 2): lay 0.3125 motor turns from its home pose, which leaves open"));
  EXPECT_THAT(refusal([](Cia402Sim& s) { s.stay_off_mark(1); }, indexed()),
              HasSubstr("encoders of axes 2 have not passed their index marks in 10 s: move the handle"));
  EXPECT_THAT(
      refusal([](Cia402Sim& s) { s.remove_object(2, kProbeFunction); }, indexed()),
      HasSubstr("axis 3 (CANopen node 3): object 60B8h:0 refuses 0x0: abort 0x6020000: it cannot tell an index"));
}

// As for ODrives; torque goes out in thousandths of 0.125 N m: half a step over the lever of 0.2 m, geared up by 12, is
// 4 mN an axis, and the hand feels at most the three together.
TEST(Cia402, TheHandFeelsTheTicksForce) {
  VirtualClock clock;
  Cia402Arm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(arm, clock, 1500, 2e4, {}, 0, arm.frame());
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_EQ(run.summary.stale_ticks + run.summary.gaps + run.summary.send_failures + run.summary.link_drops, 0u);
  EXPECT_EQ(arm.sim().heartbeats_lost(), 0u);
  for (std::size_t i = 1200; i < 1500; ++i) {
    const Vec3 asked = run.records[i].output.device_w.force_N;
    EXPECT_GT(norm(asked), 1.0) << "it presses";
    ASSERT_LT(norm(arm.rendered_N()[i + 1] - asked), 0.015) << i;
  }
  clock.advance(2'000'000);  // the drives take what the loop sent last
  DeviceSample sample;
  arm.receive(sample);
  EXPECT_EQ(arm.rendered_N().back(), Vec3{});
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(arm.sim().enabled(i));
}

// Heartbeats go every 5 ms, drives wait 20 ms: 12 ms of silence cost nothing, after 17 ms each drive has let go by
// itself, and the loop makes the edge that enables anew.
TEST(Cia402, SilenceMakesTheDrivesLetGoAndForceComesBack) {
  for (const std::uint64_t silent_ticks : {12u, 17u}) {
    VirtualClock clock;
    Cia402Arm arm(tables(), clock);
    ASSERT_EQ(arm.start(), "");
    const test::FaultRun run = test::run_on(
        arm, clock, 2500, 2e4,
        [&arm, silent_ticks](const test::Surroundings& s) {
          arm.silence_controller(s.tick >= 800 && s.tick < 800 + silent_ticks);
        },
        0, arm.frame());
    EXPECT_EQ(run.summary.faults, 0u);
    EXPECT_EQ(arm.sim().heartbeats_lost(), silent_ticks == 12 ? 0u : 3u);
    EXPECT_EQ(run.summary.link_drops, silent_ticks == 12 ? 0u : 1u);
    EXPECT_GT(norm(arm.rendered_N()[2400]), 0.5);  // of an object that is met deeper
  }
}

// Without SYNC there are no samples: a controller silent for longer latches that. The drives have let go by then.
TEST(Cia402, ALongSilenceEndsInTheDrivesFaultState) {
  VirtualClock clock;
  Cia402Arm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(
      arm, clock, 1200, 2e4,
      [&arm](const test::Surroundings& s) { arm.silence_controller(s.tick >= 800 && s.tick < 860); }, 0, arm.frame());
  EXPECT_EQ(arm.sim().heartbeats_lost(), 3u);
  EXPECT_GT(norm(arm.rendered_N()[790]), 0.5);
  for (std::size_t i = 822; i < 860; ++i) ASSERT_EQ(arm.rendered_N()[i], Vec3{}) << i;
  EXPECT_EQ(run.summary.faults & Fault::kDeviceSilent, Fault::kDeviceSilent);
}

std::uint32_t fault_after(const std::function<void(Cia402Sim&)>& meddle, std::uint32_t& code,
                          std::string* remarks = nullptr) {
  VirtualClock clock;
  Cia402Arm arm(tables(), clock);
  EXPECT_EQ(arm.start(), "");
  const test::FaultRun run = test::run_on(
      arm, clock, 1500, 2e4,
      [&](const test::Surroundings& s) {
        if (s.tick == 800) meddle(arm.sim());
      },
      0, arm.frame());
  code = arm.last().error_code;
  if (remarks != nullptr) *remarks = arm.axes().remarks();
  EXPECT_EQ(arm.rendered_N().back(), Vec3{}) << "the hand is free";
  return run.summary.faults;
}

TEST(Cia402, AnEmergencyIsAFaultWithItsCode) {
  std::uint32_t code = 0;
  std::string remarks;
  EXPECT_EQ(fault_after([](Cia402Sim& s) { s.fail(1, 0x4210); }, code, &remarks) & Fault::kDeviceReported,
            Fault::kDeviceReported);
  EXPECT_EQ(code, 0x4210u);
  EXPECT_EQ(remarks,
            "axis 2 (CANopen node 2): emergency 0x4210 (device too hot; error register 0x09: generic, temperature)\n");
}

TEST(Cia402, ADriveThatStartsAnewIsAFault) {
  std::uint32_t code = 0;
  std::string remarks;
  const std::uint32_t faults = fault_after([](Cia402Sim& s) { s.restart(2); }, code, &remarks);
  EXPECT_THAT(remarks, HasSubstr("axis 3 (CANopen node 3): started anew and has lost its set-up"));
  EXPECT_EQ(faults & Fault::kDeviceReported, Fault::kDeviceReported);
  EXPECT_EQ(code, Cia402Drives::kRestarted);
}

TEST(Cia402, ATransitionThatIsNotConfirmedIsAFault) {
  VirtualClock clock;
  Cia402Arm arm(tables(), clock);
  ASSERT_EQ(arm.start(), "");
  arm.sim().stick(1);
  const test::FaultRun run = test::run_on(arm, clock, 1500, 2e4, {}, 0, arm.frame());
  EXPECT_EQ(run.summary.faults & Fault::kDeviceReported, Fault::kDeviceReported);
  for (const Vec3 force : arm.rendered_N()) ASSERT_EQ(force, Vec3{}) << "torque before all axes obey";
  EXPECT_THAT(arm.axes().remarks(), HasSubstr("axis 2 (CANopen node 2): did not confirm a step"));
}

TEST(Cia402, BadCablesAreBorneOrNoticed) { test::expect_bad_cables_are_borne<Cia402Arm>(tables()); }
TEST(Cia402, GarbledCommandsEndWithTheCable) { test::expect_garbled_commands_end_with_the_cable<Cia402Arm>(tables()); }
TEST(Cia402, WrongEncodersAreBorneOrNoticed) { test::expect_wrong_encoders_are_borne<Cia402Arm>(tables()); }
TEST(Cia402, SparsePositionsAreAFault) { test::expect_sparse_positions_are_a_fault<Cia402Arm>(tables()); }

// 95 + 115 us an axis, 55 for SYNC, 65 for the heartbeat, 146 for an error: three fit 900 us, six do not.
TEST(DriveBudget, Cia402) {
  ArmProfile arm = *test::arm_profile(tables()).arm;
  const BusVerdict three = check_drives_budget(arm, 1e-3);
  EXPECT_TRUE(three.fits);
  EXPECT_NEAR(three.used_us, 3 * (95 + 115) + 55 + 65 + 31 + 115, 1e-9);
  for (int i = 0; i < 3; ++i) arm.axes.push_back(arm.axes[0]);
  const BusVerdict six = check_drives_budget(arm, 1e-3);
  EXPECT_FALSE(six.fits);
  EXPECT_NEAR(six.used_us, 1526, 1e-9);
  EXPECT_THAT(six.text, HasSubstr("half the rate fits"));
  EXPECT_THAT(six.text, HasSubstr("one node on CAN FD"));
}

}  // namespace
}  // namespace palpate
