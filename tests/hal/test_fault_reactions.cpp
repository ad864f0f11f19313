// Every fault a device can commit ends in the documented state within the documented time (docs/faults.md), in virtual
// time with the real tick: no force step above the rate limit, zero force at the end of latched ones, no record lost.
#include <gtest/gtest.h>

#include "tests/hal/fault_bench.h"

namespace palpate {
namespace {

using test::FaultRun;
using test::run_with_faults;

// Tick of the fault: 800, in the middle of a slide under load.
constexpr std::size_t kTick = 800;
std::string at_fault(const std::string& fault) { return "0.8 " + fault; }

// What holds whatever happens.
void expect_orderly(const FaultRun& run) {
  const ModelParams& limits = run.limits;
  const double step_N = limits.force_rate_max_N_per_s * limits.period_s;
  ASSERT_EQ(run.records.size(), run.summary.ticks);
  for (std::size_t i = 0; i < run.records.size(); ++i) {
    const Output& output = run.records[i].output;
    EXPECT_EQ(run.records[i].sequence, i + 1);
    EXPECT_LE(norm(output.device_w.force_N), limits.force_max_N * (1 + 1e-12)) << i;
    if (i > 0) {
      EXPECT_LE(norm(output.device_w.force_N - run.records[i - 1].output.device_w.force_N), step_N * (1 + 1e-9)) << i;
    }
  }
  EXPECT_EQ(run.summary.missed_slots, 0u);
  EXPECT_EQ(run.last_sent.force_N, Vec3{});
  EXPECT_EQ(run.last_sent.flags & CommandFlag::kEnable, 0u);
}

double force_N(const FaultRun& run, std::size_t tick) { return norm(run.records[tick].output.device_w.force_N); }

// Ticks from the first one that was not in Mode::kForce until the last such one; 0: none.
struct Disturbance {
  std::size_t first = 0, ticks = 0;
  Mode worst = Mode::kForce;
  double largest_step_N = 0;
};
Disturbance disturbance(const FaultRun& run) {
  Disturbance d;
  for (std::size_t i = kTick - 100; i < run.records.size() - 100; ++i) {
    const Mode mode = run.records[i].output.mode;
    d.largest_step_N = max_of(
        d.largest_step_N, norm(run.records[i].output.device_w.force_N - run.records[i - 1].output.device_w.force_N));
    if (mode == Mode::kForce) continue;
    if (d.ticks == 0) d.first = i;
    d.ticks = i - d.first + 1;
    if (static_cast<int>(mode) > static_cast<int>(d.worst)) d.worst = mode;
  }
  return d;
}

// Passes by itself: the worst mode seen, for how many ticks force was not rendered normally, and no fault.
void expect_passes(const FaultRun& run, Mode worst, std::size_t ticks) {
  expect_orderly(run);
  const Disturbance d = disturbance(run);
  EXPECT_EQ(d.worst, worst);
  EXPECT_EQ(d.ticks, ticks);
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_GT(force_N(run, kTick - 1), 0.5);
  EXPECT_EQ(run.records[run.records.size() - 100].output.mode, Mode::kForce);
  EXPECT_EQ(run.records[run.records.size() - 100].output.ramp, 1.0);
}

// Latches `fault` after at most `ticks` ticks and keeps zero force from `zero_ticks` after the cause on.
void expect_latches(const FaultRun& run, std::uint32_t fault, std::size_t ticks, std::size_t zero_ticks) {
  expect_orderly(run);
  ASSERT_GT(run.records.size(), kTick + zero_ticks);
  EXPECT_GT(force_N(run, kTick - 1), 0.5);
  std::size_t latched = 0;
  while (latched < run.records.size() && run.records[latched].output.fault == 0) ++latched;
  ASSERT_LT(latched, run.records.size());
  EXPECT_EQ(run.records[latched].output.fault, fault);
  EXPECT_LE(latched, kTick + ticks);
  for (std::size_t i = kTick + zero_ticks; i < run.records.size(); ++i) {
    EXPECT_EQ(run.records[i].output.device_w, Wrench{}) << i;
    EXPECT_EQ(run.records[i].output.mode, Mode::kFault) << i;
  }
  EXPECT_EQ(run.last_motor.force_N, Vec3{});
}

TEST(FaultReaction, WithoutOneTheHandPressesAndSlides) {
  const FaultRun run = run_with_faults("");
  expect_passes(run, Mode::kForce, 0);
  EXPECT_EQ(run.summary.stale_ticks, 0u);
  EXPECT_LT(disturbance(run).largest_step_N, 0.1);
}

TEST(FaultReaction, OneLostSampleIsHeld) {
  const FaultRun run = run_with_faults(at_fault("lose 1"));
  expect_passes(run, Mode::kHold, 1);
  EXPECT_EQ(run.records[kTick].output.ramp, 1.0);
  EXPECT_LT(disturbance(run).largest_step_N, 0.1);
}

TEST(FaultReaction, TwoAndFiveLostSamplesLetTheForceDecay) {
  expect_passes(run_with_faults(at_fault("lose 2")), Mode::kPassive, 2);
  const FaultRun run = run_with_faults(at_fault("lose 5"));
  expect_passes(run, Mode::kPassive, 5);
  // The gain is what four passive ticks leave: 0.8^4.
  EXPECT_NEAR(run.records[kTick + 4].output.ramp, 0.4096, 1e-12);
}

TEST(FaultReaction, TwentyLostSamplesLatch) {
  const FaultRun run = run_with_faults(at_fault("lose 20"));
  expect_latches(run, Fault::kDeviceSilent, 20, 27);
}

TEST(FaultReaction, NineteenDoNot) {
  const FaultRun run = run_with_faults(at_fault("lose 19"));
  expect_passes(run, Mode::kRamp, 19);
}

TEST(FaultReaction, DuplicatesAreNotNoticed) {
  const FaultRun run = run_with_faults(at_fault("duplicate 20"));
  expect_passes(run, Mode::kForce, 0);
  EXPECT_EQ(run.counters.duplicates, 20u);
}

TEST(FaultReaction, AReorderedSampleIsHeldForOneTick) {
  const FaultRun run = run_with_faults(at_fault("reorder 1"));
  expect_passes(run, Mode::kHold, 1);
  EXPECT_EQ(run.counters.reordered, 1u);
}

TEST(FaultReaction, DelayedSamplesLetTheForceDecayThenTheNewestCounts) {
  const FaultRun run = run_with_faults(at_fault("delay 4"));
  expect_passes(run, Mode::kPassive, 4);
  EXPECT_EQ(run.counters.lost, 0u);
}

TEST(FaultReaction, CorruptedSamplesAreAsGoodAsLost) {
  const FaultRun run = run_with_faults(at_fault("corrupt 3"));
  expect_passes(run, Mode::kPassive, 3);
  EXPECT_EQ(run.counters.checksum, 3u);
}

// A hand at rest and a frozen encoder look the same to the controller; what it renders stays within every limit.
TEST(FaultReaction, AFrozenEncoderKeepsTheForceAndIsFollowedAgain) {
  const FaultRun run = run_with_faults(at_fault("freeze 0.05"));
  expect_orderly(run);
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_NEAR(force_N(run, kTick + 40), force_N(run, kTick + 1), 1e-3);
  EXPECT_EQ(run.records[1400].output.mode, Mode::kForce);
}

// 5 mm in one tick is faster than the 2 m/s of the scene: rejected for two ticks, after which a hand could be there.
TEST(FaultReaction, ASmallEncoderJumpIsRejectedUntilAHandCouldHaveMovedSoFar) {
  const FaultRun run = run_with_faults(at_fault("jump 5"));
  expect_orderly(run);
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_EQ(run.records[kTick].output.status & Status::kInputRejected, Status::kInputRejected);
  EXPECT_EQ(run.records[kTick + 1].output.status & Status::kInputRejected, Status::kInputRejected);
  EXPECT_EQ(run.records[kTick + 2].output.status & Status::kInputRejected, 0u);
  EXPECT_EQ(disturbance(run).worst, Mode::kPassive);
}

// The same with a fault limiter far below the change the jump asks for: 0.3 N a tick, and it says so.
TEST(FaultReaction, TheForceLimiterBoundsWhatAJumpDoes) {
  const FaultRun run = run_with_faults(at_fault("jump -5"), 1500, WireProfile::kFd, 300);
  expect_orderly(run);
  EXPECT_NEAR(disturbance(run).largest_step_N, 0.3, 1e-9);
  std::uint32_t status = 0;
  for (const TickRecord& record : run.records) status |= record.output.status;
  EXPECT_NE(status & Status::kRateLimited, 0u);
}

TEST(FaultReaction, ALargeEncoderJumpLatches) {
  const FaultRun run = run_with_faults(at_fault("jump 100"));
  expect_latches(run, Fault::kDeviceSilent, 20, 27);
}

// 800 samples into the run the numbers fall back by less than a quarter of their range.
TEST(FaultReaction, SampleNumbersFromZeroAreFollowedAgainWithinThreeTicks) {
  const FaultRun run = run_with_faults(at_fault("sequence"));
  expect_passes(run, Mode::kPassive, 3);
  EXPECT_EQ(run.counters.restarts, 1u);
}

TEST(FaultReaction, AShortRestartInMotionIsPassiveAndPasses) {
  const FaultRun run = run_with_faults(at_fault("restart 0.01"));
  expect_passes(run, Mode::kRamp, 13);  // 10 without power and 3 until the new numbers are believed
  EXPECT_EQ(run.counters.restarts, 1u);
}

TEST(FaultReaction, ALongRestartLatches) {
  expect_latches(run_with_faults(at_fault("restart 0.3")), Fault::kDeviceSilent, 20, 27);
}

// A clock that runs slow leaves a tick without a sample once in 1/ppm ticks: held, and nothing is felt.
TEST(FaultReaction, ASlowDeviceClockCostsASingleHeldTickNowAndThen) {
  const FaultRun run = run_with_faults("0 drift -4000");
  expect_orderly(run);
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_EQ(run.summary.worst_stale, 1u);
  EXPECT_NEAR(static_cast<double>(run.summary.stale_ticks), 6.0, 1.0);  // 1500 ticks x 0.4 %
  EXPECT_LT(disturbance(run).largest_step_N, 0.1);
}

TEST(FaultReaction, AFastDeviceClockIsNotNoticed) {
  const FaultRun run = run_with_faults("0 drift 4000");
  expect_passes(run, Mode::kForce, 0);
}

TEST(FaultReaction, BusOffLatchesAtOnce) {
  expect_latches(run_with_faults(at_fault("bus-off")), Fault::kBusOff, 0, 20);
}

TEST(FaultReaction, AnUnpluggedCableLatchesAsSilence) {
  expect_latches(run_with_faults(at_fault("unplug 1")), Fault::kDeviceSilent, 20, 27);
}

TEST(FaultReaction, SilenceLatches) {
  expect_latches(run_with_faults(at_fault("silence 1")), Fault::kDeviceSilent, 20, 27);
}

// The node cuts the force itself; the controller hears of it one tick later at most.
TEST(FaultReaction, TheEmergencyStopLatchesAtOnce) {
  expect_latches(run_with_faults(at_fault("stop 0.1")), Fault::kDeviceReported, 0, 20);
}

TEST(FaultReaction, ClassicFramesReactTheSame) {
  const auto classic = [](const std::string& fault) { return run_with_faults(fault, 1500, WireProfile::kClassic); };
  expect_passes(classic(at_fault("lose 2")), Mode::kPassive, 2);
  expect_passes(classic(at_fault("corrupt 1")), Mode::kHold, 1);
  expect_latches(classic(at_fault("lose 20")), Fault::kDeviceSilent, 20, 27);
}

TEST(FaultReaction, IsTheSameEveryTime) {
  const std::string script = "0.4 lose 3\n0.5 reorder 2\n0.6 corrupt 2\n0.7 drift 300\n0.8 jump 3\n1.0 sequence";
  const FaultRun a = run_with_faults(script), b = run_with_faults(script);
  ASSERT_EQ(a.records.size(), b.records.size());
  for (std::size_t i = 0; i < a.records.size(); ++i) EXPECT_EQ(a.records[i].state_hash, b.records[i].state_hash) << i;
}

}  // namespace
}  // namespace palpate
