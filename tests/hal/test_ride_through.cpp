// On the simulated device a machine that stood still is no fault: the force ramps out, waits until ticks come in time
// again, and ramps in; on anything real the same stall latches. In virtual time with the real tick and a scripted
// clock.
#include "tests/hal/fault_judge.h"

namespace palpate {
namespace {

using test::expect_latches;
using test::expect_orderly;
using test::FaultRun;
using test::force_N;
using test::kTick;
using test::Meddle;
using test::Surroundings;

constexpr std::uint32_t kCalm = 50;

FaultRun ridden(const std::string& script, const Meddle& meddle, std::uint64_t ticks = 1500,
                std::uint32_t ride_through_ticks = kCalm) {
  return test::run_with_faults(script, ticks, WireProfile::kFd, 2e4, meddle, ride_through_ticks);
}

// The clock jumps by so many periods and a half after one tick.
Meddle stall(std::uint64_t tick, std::int64_t periods) {
  return [=](const Surroundings& s) {
    if (s.tick == tick) s.clock.advance(periods * 1'000'000 + 500'000);
  };
}

struct Ride {
  std::size_t first = 0, ticks = 0, calm = 0;  // of Command::kStall
  std::size_t back = 0;                        // first tick after it in Mode::kForce
};
Ride ride_of(const FaultRun& run) {
  Ride ride;
  for (std::size_t i = 0; i < run.records.size(); ++i) {
    const TickRecord& r = run.records[i];
    if ((r.input.commands & Command::kStall) != 0) {
      if (ride.ticks++ == 0) ride.first = i;
      EXPECT_EQ(r.input.commands & Command::kArm, 0u);
    } else if (ride.ticks > 0 && ride.back == 0 && r.output.mode == Mode::kForce) {
      ride.back = i;
    }
  }
  return ride;
}

// 31 and 127 ms: the stalls the demo met; 127 ms is beyond the silence limit as well.
TEST(RideThrough, AStallRampsOutWaitsAndComesBack) {
  const FaultRun undisturbed = ridden("", {});
  for (const std::int64_t periods : {31, 127}) {
    const FaultRun run = ridden("", stall(kTick, periods));
    expect_orderly(run, static_cast<std::uint64_t>(periods));
    EXPECT_EQ(run.summary.faults, 0u) << periods;
    EXPECT_EQ(run.summary.stalls, 1u);
    const Ride ride = ride_of(run);
    EXPECT_EQ(ride.first, kTick + 1);
    EXPECT_EQ(ride.ticks, kCalm + 1);
    EXPECT_EQ(run.records[ride.first + 25].output.device_w, Wrench{});  // ramp_out_s is 20 ticks
    EXPECT_LE(ride.back, ride.first + kCalm + 3);
    // As strong as without the stall at the same time, but for friction, which begins anew.
    const std::size_t later = ride.back + 250;
    const double expected_N = force_N(undisturbed, later + static_cast<std::size_t>(periods));
    EXPECT_NEAR(force_N(run, later), expected_N, 0.1 * expected_N);
  }
}

TEST(RideThrough, TheSameStallLatchesWithoutIt) {
  const FaultRun run = ridden("", stall(kTick, 31), 1500, 0);
  expect_orderly(run, 31);
  EXPECT_EQ(run.summary.faults, Fault::kStalled);
  EXPECT_EQ(run.summary.stalls, 0u);
  EXPECT_EQ(ride_of(run).ticks, 0u);
}

TEST(RideThrough, LateTicksInARowAreRiddenThroughOnce) {
  const FaultRun run = ridden("", [](const Surroundings& s) {
    if (s.tick >= kTick && s.tick < kTick + 30) s.clock.advance(2'500'000);
  });
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_EQ(run.summary.stalls, 1u);
  EXPECT_GE(ride_of(run).ticks, kCalm + 20);
  EXPECT_GT(ride_of(run).back, 0u);
}

// A second stall while it waits starts the wait anew: 50 ticks in time, in a row.
TEST(RideThrough, AStallDuringTheWaitStartsItAnew) {
  const FaultRun run = ridden("", [](const Surroundings& s) {
    if (s.tick == kTick || s.tick == kTick + 30) s.clock.advance(40'500'000);
  });
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_EQ(ride_of(run).ticks, 30 + kCalm + 1);
}

TEST(RideThrough, ADeviceThatIsSilentForLongComesBackToo) {
  const FaultRun run = ridden("0.8 silence 0.1", {});
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_EQ(run.summary.stalls, 1u);
  EXPECT_GT(ride_of(run).back, 0u);
}

// What is the device's or the host's own fault is not ridden through.
TEST(RideThrough, OtherFaultsLatchAsEver) {
  const FaultRun run = ridden("0.8 stop", {});
  EXPECT_EQ(run.summary.faults, Fault::kDeviceReported);
  EXPECT_EQ(run.records.back().output.mode, Mode::kFault);
}

}  // namespace
}  // namespace palpate
