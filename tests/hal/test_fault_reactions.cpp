// Every fault a device can commit ends in the documented state within the documented time (docs/faults.md), in virtual
// time with the real tick: no force step above the rate limit, zero force at the end of latched ones, no record lost.
#include <gtest/gtest.h>

#include "tests/hal/fault_judge.h"

namespace palpate {
namespace {

using test::at_fault;
using test::disturbance;
using test::expect_latches;
using test::expect_orderly;
using test::expect_passes;
using test::FaultRun;
using test::force_N;
using test::kTick;
using test::run_with_faults;

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

TEST(FaultReaction, TwentyDelayedOrCorruptedSamplesLatchToo) {
  expect_latches(run_with_faults(at_fault("delay 20")), Fault::kDeviceSilent, 20, 27);
  expect_latches(run_with_faults(at_fault("corrupt 20")), Fault::kDeviceSilent, 20, 27);
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

// 1.5 mm in one tick a hand could do: believed at once, and the force follows within its rate limit.
TEST(FaultReaction, AJumpThatAHandCouldMakeIsBelieved) {
  const FaultRun run = run_with_faults(at_fault("jump 1.5"));
  expect_passes(run, Mode::kForce, 0);
  for (const TickRecord& record : run.records) EXPECT_EQ(record.output.status & Status::kInputRejected, 0u);
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
  EXPECT_EQ(disturbance(run).ticks, 2u);
}

// The believed distance grows by 2 mm a tick, from 2 mm on: J mm take the whole part of J / 2 ticks.
TEST(FaultReaction, ALargerJumpTakesHalfATickPerMillimetre) {
  expect_passes(run_with_faults(at_fault("jump 15")), Mode::kRamp, 7);
  expect_passes(run_with_faults(at_fault("jump 31")), Mode::kRamp, 15);
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

TEST(FaultReaction, AJumpBeyondFortyMillimetresLatches) {
  expect_latches(run_with_faults(at_fault("jump 45")), Fault::kSamplesRejected, 20, 27);
  expect_latches(run_with_faults(at_fault("jump 100")), Fault::kSamplesRejected, 20, 27);
}

// 800 samples into the run the numbers fall back by less than a quarter of their range.
TEST(FaultReaction, SampleNumbersFromZeroAreFollowedAgainWithinThreeTicks) {
  const FaultRun run = run_with_faults(at_fault("sequence"));
  expect_passes(run, Mode::kPassive, 3);
  EXPECT_EQ(run.counters.restarts, 1u);
}

TEST(FaultReaction, AShortRestartInMotionIsPassiveAndPasses) {
  const FaultRun run = run_with_faults(at_fault("restart 0.01"));
  // 10 without power, 3 until the new numbers are believed, 6 for the enable edge that a node asks for after power-up.
  expect_passes(run, Mode::kRamp, 19);
  EXPECT_EQ(run.counters.restarts, 1u);
}

TEST(FaultReaction, ALongRestartLatches) {
  expect_latches(run_with_faults(at_fault("restart 0.3")), Fault::kDeviceSilent, 20, 27);
}

// A clock that runs slow and is not followed (nobody tells arrivals in virtual time) leaves a tick without a sample
// once in 1/ppm ticks: held, and nothing is felt.
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
