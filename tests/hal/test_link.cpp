// Both directions of the link: a device that no longer hears is noticed, let go and enabled anew, and nothing that
// happens to commands steps the force on the hand.
#include <gtest/gtest.h>

#include "hal/loop/link_watch.h"
#include "tests/hal/fault_judge.h"

namespace palpate {
namespace {

using test::at_fault;
using test::expect_orderly;
using test::FaultRun;
using test::force_N;
using test::kTick;
using test::run_with_faults;

// A watch that is fed sample by sample.
struct Watch {
  LinkWatch link{LinkLimits{}};
  DeviceSample sample;
  bool step(std::uint32_t lag, std::uint32_t flags, bool armed = true, bool zero = false) {
    sample.fresh = true;
    sample.command_lag = lag;
    sample.flags = flags;
    link.look(sample);
    return link.enable(armed, zero);
  }
};

TEST(LinkWatch, EnablesOnlyWhileArmed) {
  Watch w;
  EXPECT_FALSE(w.step(1, DeviceFlag::kWatchdog, false, true));
  EXPECT_TRUE(w.step(1, DeviceFlag::kWatchdog));
  EXPECT_FALSE(w.link.unheard());
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(w.step(1, 0));
  EXPECT_TRUE(w.step(1, 0, false, false)) << "a force that still falls needs its drives";
  EXPECT_FALSE(w.step(1, 0, false, true));
  EXPECT_EQ(w.link.drops(), 0u);
}

TEST(LinkWatch, AnEchoThatStaysBehindLetsGoAndComesBackThroughAnEdge) {
  Watch w;
  for (int i = 0; i < 10; ++i) w.step(1, 0);
  for (std::uint32_t lag = 2; lag <= 20; ++lag) EXPECT_TRUE(w.step(lag, 0));
  EXPECT_FALSE(w.link.unheard());
  EXPECT_TRUE(w.step(21, 0)) << "drives stay on while the force falls";
  EXPECT_TRUE(w.link.unheard());
  EXPECT_FALSE(w.step(22, 0, true, true));
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(w.step(1, DeviceFlag::kWatchdog, true, true));
  EXPECT_TRUE(w.step(1, DeviceFlag::kWatchdog, true, true)) << "the edge";
  EXPECT_FALSE(w.link.unheard());
  EXPECT_EQ(w.link.drops(), 1u);
  EXPECT_FALSE(w.link.fault());
}

TEST(LinkWatch, AWatchdogFlagAloneLetsGo) {
  Watch w;
  for (int i = 0; i < 10; ++i) w.step(1, 0);
  w.step(1, DeviceFlag::kWatchdog);
  EXPECT_TRUE(w.link.unheard());
}

TEST(LinkWatch, SilenceIsNotItsBusiness) {
  Watch w;
  for (int i = 0; i < 10; ++i) w.step(1, 0);
  w.sample.fresh = false;
  w.sample.command_lag = 1000;
  for (int i = 0; i < 100; ++i) {
    w.link.look(w.sample);
    EXPECT_TRUE(w.link.enable(true, false));
  }
  EXPECT_FALSE(w.link.unheard());
}

TEST(LinkWatch, ADeviceThatStaysDeafOrWillNotIsAFault) {
  Watch deaf;
  for (int i = 0; i < 10; ++i) deaf.step(1, 0);
  std::uint32_t lag = 2;
  for (; !deaf.link.fault() && lag < 200; deaf.step(lag, 0, true, lag > 60)) lag += 1;
  EXPECT_EQ(lag, 20 + 50u);
  Watch unwilling;
  int ticks = 0;
  while (!unwilling.link.fault() && ++ticks < 1000) unwilling.step(1, DeviceFlag::kWatchdog, true, true);
  EXPECT_LT(ticks, 100);
  EXPECT_GT(unwilling.link.drops(), 2u);
  unwilling.step(1, DeviceFlag::kWatchdog, false, true);
  EXPECT_FALSE(unwilling.link.fault()) << "at rest it may be reset";
}

TEST(LinkWatch, IsProvenByEchoesOfOurOwn) {
  Watch w;
  w.step(60'000, DeviceFlag::kWatchdog, false, true);  // what a controller before this one sent
  EXPECT_FALSE(w.link.proven());
  EXPECT_TRUE(w.link.unheard());
  for (int i = 0; i < 5; ++i) w.step(1, DeviceFlag::kWatchdog, false, true);
  EXPECT_FALSE(w.link.unheard());
  EXPECT_FALSE(w.link.proven()) << "and by as many disabled commands as an edge needs";
  w.step(1, DeviceFlag::kWatchdog, false, true);
  EXPECT_TRUE(w.link.proven());
}

// The largest change of the force that the motors rendered in one period.
double largest_step_N(const FaultRun& run) {
  double largest_N = 0;
  for (std::size_t i = 1; i < run.motor_N.size(); ++i)
    largest_N = max_of(largest_N, norm(run.motor_N[i] - run.motor_N[i - 1]));
  return largest_N;
}

void expect_soft(const FaultRun& run) {
  expect_orderly(run);
  EXPECT_LE(largest_step_N(run), 0.1 * run.limits.force_max_N * (1 + 1e-9));
}

TEST(LinkFault, AFewLostCommandsAreNotFelt) {
  for (const char* fault : {"miss 1", "miss 5", "miss 15", "garble 5"}) {
    const FaultRun run = run_with_faults(at_fault(fault));
    expect_soft(run);
    EXPECT_EQ(run.summary.faults, 0u) << fault;
    EXPECT_EQ(run.summary.link_drops, 0u) << fault;
    EXPECT_EQ(test::disturbance(run).ticks, 0u) << fault;
  }
}

// Half a second ago this gave 0 -> 8.5 N in one tick when the link came back.
TEST(LinkFault, ShortDeafnessRampsOutAndInAgain) {
  for (const WireProfile profile : {WireProfile::kFd, WireProfile::kClassic}) {
    for (const char* fault : {"deaf 0.025", "deaf 0.035", "garble 30"}) {
      SCOPED_TRACE(fault);
      const FaultRun run = run_with_faults(at_fault(fault), 1500, profile);
      expect_soft(run);
      EXPECT_EQ(run.summary.faults, 0u);
      EXPECT_EQ(run.summary.link_drops, 1u);
      const test::Disturbance d = test::disturbance(run);
      EXPECT_EQ(d.worst, Mode::kRamp);
      EXPECT_LE(d.ticks, 60u);
      EXPECT_NE(run.records[kTick + 25].output.status & Status::kCommandsUnheard, 0u);
      EXPECT_EQ(run.records[1400].output.mode, Mode::kForce);
      EXPECT_EQ(run.records[1400].output.ramp, 1.0);
      EXPECT_GT(norm(run.motor_N[1400]), 0.5) << "the node was enabled anew";
      // Once it lets go, the hand has no force until the controller ramps in.
      EXPECT_EQ(run.motor_N[kTick + 34], Vec3{});
    }
  }
}

TEST(LinkFault, LongDeafnessLatches) {
  for (const WireProfile profile : {WireProfile::kFd, WireProfile::kClassic}) {
    const FaultRun run = run_with_faults(at_fault("deaf 0.5"), 1500, profile);
    expect_soft(run);
    test::expect_latches(run, Fault::kDeviceDeaf, 20 + 50 + 3, 75);
    for (std::size_t i = kTick + 45; i < run.records.size(); ++i) EXPECT_EQ(force_N(run, i), 0.0) << i;
    for (std::size_t i = kTick + 35; i < run.motor_N.size(); ++i) EXPECT_EQ(run.motor_N[i], Vec3{}) << i;
  }
}

// The last piece of a link that half works: deafness again and again ends in the same soft hands each time.
TEST(LinkFault, DeafnessAgainAndAgainIsSoftEachTime) {
  const FaultRun run = run_with_faults("0.5 deaf 0.03\n0.8 deaf 0.03\n1.1 deaf 0.03\n");
  expect_soft(run);
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_EQ(run.summary.link_drops, 3u);
}

}  // namespace
}  // namespace palpate
