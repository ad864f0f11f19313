// Faults that are not the device's: late ticks, a host that dies or writes garbage, numbers that are not finite. Each
// ends in the documented state within the documented time (docs/faults.md), in virtual time with the real tick, loop
// and host port. And the laboratory's fault scripts, natively through the loopback.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include "tests/hal/fault_judge.h"

namespace palpate {
namespace {

using test::expect_latches;
using test::expect_orderly;
using test::expect_passes;
using test::FaultRun;
using test::force_N;
using test::kTick;
using test::Meddle;
using test::Surroundings;

FaultRun run_with(const Meddle& meddle, std::uint64_t ticks = 1500) {
  return test::run_with_faults("", ticks, WireProfile::kFd, 2e4, meddle);
}

// Ticks whose computing takes `periods` and a half: so many slots are missed after each, from 2 on.
Meddle slow_ticks(std::uint64_t number, std::int64_t periods) {
  return [=](const Surroundings& s) {
    if (s.tick >= kTick && s.tick < kTick + number) s.clock.advance(periods * 1'000'000 + 500'000);
  };
}

// Late by 1.2 periods: its slot and the one that has begun meanwhile are gone.
TEST(ControllerFault, AMissedTickLetsTheForceDecayOnceAndPasses) {
  const Meddle late = [](const Surroundings& s) {
    if (s.tick == kTick) s.clock.late(1'200'000);
  };
  expect_passes(run_with(late), Mode::kPassive, 1, 2);
}

TEST(ControllerFault, ATickLateByLessThanAPeriodIsNotNoticed) {
  expect_passes(run_with(slow_ticks(1, 1)), Mode::kForce, 0);
}

TEST(ControllerFault, SeveralTicksMissedAtOnceLetTheForceDecay) {
  expect_passes(run_with(slow_ticks(1, 4)), Mode::kPassive, 1, 4);
}

TEST(ControllerFault, TenMissedInARowLatch) {
  expect_latches(run_with(slow_ticks(10, 2)), Fault::kOverrun, 10, 30, 20);
}

TEST(ControllerFault, NineDoNot) { expect_passes(run_with(slow_ticks(9, 2)), Mode::kPassive, 9, 18); }

TEST(ControllerFault, TwentyMissedAtOnceLatch) {
  expect_latches(run_with(slow_ticks(1, 20)), Fault::kStalled, 1, 21, 20);
}

// Two seconds without a heartbeat, then the ramp; the run ends by itself.
TEST(ControllerFault, AHostThatDiesLatchesAfterTwoSeconds) {
  const FaultRun run = run_with(
      [](const Surroundings& s) {
        if (s.tick == kTick) s.host_lives = false;
      },
      5000);
  expect_orderly(run);
  EXPECT_EQ(run.summary.end, LoopEnd::kStopped);
  constexpr std::size_t kLatest = kTick + test::kHostSilenceTicks + 1;
  ASSERT_GT(run.records.size(), kLatest);
  EXPECT_EQ(run.records[kLatest - 3].output.mode, Mode::kForce);
  EXPECT_EQ(run.records[kLatest].output.fault, Fault::kHostSilent);
  EXPECT_LE(run.records.size(), kLatest + 22);
  EXPECT_EQ(run.records.back().output.device_w, Wrench{});
  EXPECT_EQ(run.last_motor.force_N, Vec3{});
}

TEST(ControllerFault, AHostThatWritesGarbageLatchesAtOnce) {
  const FaultRun run = run_with([](const Surroundings& s) {
    if (s.tick < kTick) return;
    s.host_lives = false;
    s.mailbox.word[1].store(~0ull);
  });
  expect_orderly(run);
  ASSERT_GT(run.records.size(), kTick + 2);
  EXPECT_EQ(run.records[kTick - 1].output.fault, 0u);
  EXPECT_EQ(run.records[kTick + 2].output.fault, Fault::kCommandInvalid);
  EXPECT_LE(run.records.size(), kTick + 24);
  EXPECT_EQ(run.records.back().output.device_w, Wrench{});
}

// The coupling's stiffness is spoilt, as by a bit flipped in memory, so that the force is no number from this tick on.
TEST(ControllerFault, AForceThatIsNotFiniteRampsTheLastGoodOneToZero) {
  const FaultRun run = run_with([](const Surroundings& s) {
    if (s.tick == kTick) s.params.coupling_N_per_m = std::numeric_limits<double>::quiet_NaN();
  });
  expect_latches(run, Fault::kNotFinite, 0, 20);
  // Twenty equal steps from the last good force: half of it after ten.
  EXPECT_NEAR(force_N(run, kTick + 9), 0.5 * force_N(run, kTick - 1), 0.01);
}

// The tool's own pose is spoilt: it starts again from the handle's.
TEST(ControllerFault, AStateThatIsNotFiniteLatches) {
  const FaultRun run = run_with([](const Surroundings& s) {
    if (s.tick == kTick) s.state.safety.tool_corrected_w.position_m.x = std::numeric_limits<double>::quiet_NaN();
  });
  expect_latches(run, Fault::kNotFinite | Fault::kStateCorrupt, 0, 20);
}

std::string name_of(std::uint32_t faults) {
#define PALPATE_NAME(name, bit, cause, remedy) \
  if (faults == 1u << bit) return std::string(#name).substr(1);
  PALPATE_FAULT_BITS(PALPATE_NAME)
#undef PALPATE_NAME
  return faults == 0 ? "none" : "several";
}

// The very scripts that the laboratory's scenario `faults` plays on a real kernel, through the loopback's frames.
TEST(ControllerFault, TheLaboratorysScriptsEndAsTheySay) {
  int scripts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PALPATE_SOURCE_DIR "/tests/lab/faults")) {
    SCOPED_TRACE(entry.path().filename().string());
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    std::string hash, expect, name;
    text >> hash >> expect >> name;
    ASSERT_EQ(hash + expect, "#expect");
    name = name.substr(0, name.find(':'));
    for (const WireProfile profile : {WireProfile::kFd, WireProfile::kClassic}) {
      const FaultRun run = test::run_with_faults(text.str(), name == "none" ? 7500 : 2000, profile);
      expect_orderly(run);
      // The loopback cannot be plugged in again: there the cable stays out.
      const bool stays_out = entry.path().stem() == "replug";
      EXPECT_EQ(name_of(run.summary.faults), stays_out ? "DeviceSilent" : name);
    }
    scripts += 1;
  }
  EXPECT_GE(scripts, 10);
}

}  // namespace
}  // namespace palpate
