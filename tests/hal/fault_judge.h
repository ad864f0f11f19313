// Judgements of a run with a fault at tick 800: what docs/faults.md promises of every fault, of those that pass by
// themselves and of those that latch.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/hal/fault_bench.h"

namespace palpate::test {

// Tick of the fault: in the middle of a slide under load.
constexpr std::size_t kTick = 800;
inline std::string at_fault(const std::string& fault) { return "0.8 " + fault; }

// What holds whatever happens.
inline void expect_orderly(const FaultRun& run, std::uint64_t missed_slots = 0) {
  const ModelParams& limits = run.limits;
  const double step_N = min_of(limits.force_rate_max_N_per_s * limits.period_s, kOutputStepShare * limits.force_max_N);
  ASSERT_EQ(run.records.size(), run.summary.ticks);
  for (std::size_t i = 0; i < run.records.size(); ++i) {
    const Output& output = run.records[i].output;
    EXPECT_EQ(run.records[i].sequence, i + 1);
    EXPECT_LE(norm(output.device_w.force_N), limits.force_max_N * (1 + 1e-12)) << i;
    if (i > 0) {
      EXPECT_LE(norm(output.device_w.force_N - run.records[i - 1].output.device_w.force_N), step_N * (1 + 1e-9)) << i;
    }
  }
  EXPECT_EQ(run.summary.missed_slots, missed_slots);
  EXPECT_EQ(run.last_sent.force_N, Vec3{});
  EXPECT_EQ(run.last_sent.flags & CommandFlag::kEnable, 0u);
}

inline double force_N(const FaultRun& run, std::size_t tick) { return norm(run.records[tick].output.device_w.force_N); }

// Ticks from the first one that was not in Mode::kForce until the last such one; 0: none.
struct Disturbance {
  std::size_t first = 0, ticks = 0;
  Mode worst = Mode::kForce;
  double largest_step_N = 0;
};
inline Disturbance disturbance(const FaultRun& run) {
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
inline void expect_passes(const FaultRun& run, Mode worst, std::size_t ticks, std::uint64_t missed_slots = 0) {
  expect_orderly(run, missed_slots);
  const Disturbance d = disturbance(run);
  EXPECT_EQ(d.worst, worst);
  EXPECT_EQ(d.ticks, ticks);
  EXPECT_EQ(run.summary.faults, 0u);
  EXPECT_GT(force_N(run, kTick - 1), 0.5);
  EXPECT_EQ(run.records[run.records.size() - 100].output.mode, Mode::kForce);
  EXPECT_EQ(run.records[run.records.size() - 100].output.ramp, 1.0);
}

// Latches `fault` after at most `ticks` ticks and keeps zero force from `zero_ticks` after the cause on.
inline void expect_latches(const FaultRun& run, std::uint32_t fault, std::size_t ticks, std::size_t zero_ticks,
                           std::uint64_t missed_slots = 0) {
  expect_orderly(run, missed_slots);
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

}  // namespace palpate::test
