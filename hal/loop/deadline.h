// The overrun state machine, apart from any clock or sleep: which slot the next tick belongs to, how many were missed,
// and when missing them becomes a fault.
//
// Slots are period_ns apart on one absolute grid (which may follow the device's, phase_lock.h), so lateness never
// accumulates. A tick late by less than a period runs
// at once. One late by a period or more has missed whole slots: they are counted and skipped, and the tick waits for
// the next slot. It never catches up with a burst, which the hand would feel as several impulses at once.
#pragma once

#include <cstdint>

namespace palpate {

struct DeadlineLimits {
  std::int64_t period_ns = 1'000'000;
  std::uint32_t consecutive_ticks = 10;  // so many ticks in a row that each missed slots: Fault::kOverrun
  std::uint32_t slots_at_once = 20;      // so many slots missed in one go: Fault::kStalled
};

// Phases on the clock's grid of whole periods: of a loop's slots, and of the steps of a simulated device on the same
// clock, half a period apart. When each began where it happened to, samples could arrive just around the tick's
// beginning, and every other tick found none (39 % of a laboratory run on USB, 2026-11-22). Off the grid itself, where
// the kernel's own tick is: there the latest wake-up of that run was 8.3 us after its slot instead of 5.7. A device
// with a clock of its own drifts through every phase.
inline constexpr std::int64_t slot_phase_ns(std::int64_t period_ns) { return period_ns / 4; }
inline constexpr std::int64_t step_phase_ns(std::int64_t period_ns) { return period_ns / 4 + period_ns / 2; }
// First instant of that phase, half a period to one and a half after `now_ns`; a whole one where phase_ns is negative.
inline std::int64_t first_slot_ns(std::int64_t now_ns, std::int64_t period_ns, std::int64_t phase_ns) noexcept {
  if (phase_ns < 0) return now_ns + period_ns;
  return (now_ns - phase_ns + 3 * period_ns / 2) / period_ns * period_ns + phase_ns;
}

class DeadlineTracker {
 public:
  DeadlineTracker(const DeadlineLimits& limits, std::int64_t first_ns) noexcept
      : limits_(limits), deadline_ns_(first_ns) {}

  std::int64_t deadline_ns() const noexcept { return deadline_ns_; }

  // Moves on to the next slot after a tick; missed_ starts again. `correction_ns`: of a PhaseLock.
  void advance(std::int64_t correction_ns = 0) noexcept {
    deadline_ns_ += limits_.period_ns + correction_ns;
    missed_ = 0;
  }
  // True if `now_ns` is a whole period or more past the slot: the slots that passed are counted, and the deadline is
  // now the first slot after now_ns, to be waited for.
  bool skip(std::int64_t now_ns) noexcept {
    const std::int64_t late_ns = now_ns - deadline_ns_;
    if (late_ns < limits_.period_ns) return false;
    const std::int64_t slots = late_ns / limits_.period_ns + 1;
    deadline_ns_ += slots * limits_.period_ns;
    missed_ += static_cast<std::uint32_t>(slots < kMost ? slots : kMost);
    return true;
  }
  // Called once when the tick starts.
  void start() noexcept {
    consecutive_ = missed_ > 0 ? consecutive_ + 1 : 0;
    total_missed_ += missed_;
    overrun_ticks_ += missed_ > 0;
    worst_missed_ = missed_ > worst_missed_ ? missed_ : worst_missed_;
  }
  std::uint32_t missed() const noexcept { return missed_; }  // slots skipped just before this tick
  bool late_too_often() const noexcept { return consecutive_ >= limits_.consecutive_ticks; }
  bool stalled() const noexcept { return missed_ >= limits_.slots_at_once; }
  std::uint64_t total_missed() const noexcept { return total_missed_; }
  std::uint64_t overrun_ticks() const noexcept { return overrun_ticks_; }
  std::uint32_t worst_missed() const noexcept { return worst_missed_; }

 private:
  static constexpr std::int64_t kMost = 1'000'000;
  DeadlineLimits limits_;
  std::int64_t deadline_ns_;
  std::uint32_t missed_ = 0, consecutive_ = 0, worst_missed_ = 0;
  std::uint64_t total_missed_ = 0, overrun_ticks_ = 0;
};

}  // namespace palpate
