// Encoders of drives that freeze or jump in the middle of a press, and positions that come too seldom (docs/faults.md).
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "hal/drives/axis_map.h"
#include "tests/hal/cable_judge.h"

namespace palpate::test {

struct EncoderRow {
  const char* name;
  bool frozen;          // for 100 ticks; otherwise a jump that stays
  int axes;             // how many of them
  double jump_m;        // of the handle, by the first axis
  Mode worst;           // as in CableRow
  std::size_t within;   // ticks
  std::uint32_t fault;  // latched, if not 0
};
inline std::vector<EncoderRow> encoder_rows() {
  return {{"all frozen", true, 3, 0, Mode::kForce, 0, 0},
          {"one frozen", true, 1, 0, Mode::kForce, 0, 0},
          {"a jump of 1 mm", false, 1, 1e-3, Mode::kForce, 0, 0},
          // Believed after as many ticks as a hand of 2 m/s needs, and one in which it is seen.
          {"a jump of 5 mm", false, 1, 5e-3, Mode::kPassive, 4, 0},
          {"a jump of 60 mm", false, 1, 0.06, Mode::kFault, 0, Fault::kSamplesRejected}};
}

template <class Arm>
void set_encoders(Arm& arm, const EncoderRow& row) {
  for (int i = 0; i < row.axes; ++i) {
    double joint[kMaxAxes];
    for (int k = 0; k < kMaxAxes; ++k) joint[k] = arm.axes().joint(k);
    const double lever_m = norm(linkage_at(arm.arm().linkage, joint).along[i]);
    const double turns = row.jump_m / lever_m / joint_per_turn(arm.arm().axes[static_cast<std::size_t>(i)]);
    arm.sim().plant().set_fault(i, {.shift_turns = turns, .frozen = row.frozen});
  }
}

// Force stays within its limits and changes no faster than ever; what passes leaves the hand with its force.
template <class Arm>
void expect_wrong_encoders_are_borne(const std::string& tables) {
  for (const EncoderRow& row : encoder_rows()) {
    SCOPED_TRACE(row.name);
    VirtualClock clock;
    Arm arm(tables, clock);
    ASSERT_EQ(arm.start(), "");
    const auto meddle = [&](const Surroundings& s) {
      if (s.tick == kTick) set_encoders(arm, row);
      for (int i = 0; row.frozen && s.tick == kTick + 100 && i < row.axes; ++i) arm.sim().plant().set_fault(i, {});
    };
    FaultRun run = run_on(arm, clock, 1500, 2e4, meddle, 0, arm.frame());
    run.last_sent = arm.last_sent();
    expect_orderly(run);
    EXPECT_GT(force_N(run, kTick - 1), 0.5);
    EXPECT_EQ(run.summary.faults, row.fault);
    if (row.fault != 0) {
      EXPECT_EQ(arm.rendered_N().back(), Vec3{});
      continue;
    }
    const Disturbance seen = disturbance(run);
    EXPECT_LE(static_cast<int>(seen.worst), static_cast<int>(row.worst));
    EXPECT_LE(seen.ticks, row.within);
    EXPECT_EQ(run.records[1400].output.mode, Mode::kForce);
  }
}

// Every second set of positions is lost for a second: more than 4 ticks in 10 are without one.
template <class Arm>
void expect_sparse_positions_are_a_fault(const std::string& tables) {
  const CableRun cable = run_on_bad_cable<Arm>(tables, {"sparse", BadCable::Fault::kLoseEverySecond, false, 1000});
  expect_orderly(cable.run);
  EXPECT_EQ(cable.run.summary.faults, Fault::kSamplesSparse);
  EXPECT_EQ(cable.rendered_N.back(), Vec3{});
}

// `restart` lets the drive of an axis start anew in the middle of the press, for each of `away` periods without power:
// a fault with `code`, the hand is free, and the fault stays when it is reset and armed again.
template <class Arm, class Restart>
void expect_a_restart_is_a_fault(const std::string& tables, std::uint32_t code, std::initializer_list<int> away,
                                 const Restart& restart) {
  for (const int periods : away) {
    SCOPED_TRACE(periods);
    VirtualClock clock;
    Arm arm(tables, clock);
    ASSERT_EQ(arm.start(), "");
    const auto meddle = [&](const Surroundings& s) {
      if (s.tick == kTick) restart(arm.sim(), 1, periods);
    };
    FaultRun run = run_on(arm, clock, 1500, 2e4, meddle, 0, arm.frame());
    run.last_sent = arm.last_sent();
    expect_orderly(run);
    EXPECT_GT(force_N(run, kTick - 1), 0.5);
    EXPECT_EQ(run.summary.faults & Fault::kDeviceReported, Fault::kDeviceReported);
    EXPECT_EQ(arm.last().error_code, code);
    DeviceCommand command{{1, 1, 1}, {}, 0};
    for (int i = 0; i < 200; ++i) {
      if (i == 20) command.flags = CommandFlag::kEnable;  // an operator's reset, and armed again
      DeviceSample sample;
      clock.advance(1'000'000);
      arm.receive(sample);
      arm.transmit(command);
      ASSERT_EQ(sample.faults & Fault::kDeviceReported, Fault::kDeviceReported) << i;
    }
    // Its heartbeat comes within 20 periods, its absence shows after 10; then the ramp.
    for (std::size_t i = kTick + 60; i < arm.rendered_N().size(); ++i) ASSERT_EQ(arm.rendered_N()[i], Vec3{}) << i;
  }
}

}  // namespace palpate::test
