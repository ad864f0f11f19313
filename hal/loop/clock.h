// Time for the control loop: integer nanoseconds, injected, so that the same loop runs against the real clock and
// against a scripted one.
#pragma once

#include <time.h>

#include <concepts>
#include <cstdint>

namespace palpate {

// wait_until returns at or after `deadline_ns`; at once if it has passed.
template <typename T>
concept Clock = requires(T clock, const T constant, std::int64_t deadline_ns) {
  { constant.now_ns() }
  noexcept->std::same_as<std::int64_t>;
  { clock.wait_until(deadline_ns) }
  noexcept->std::same_as<void>;
};

// CLOCK_MONOTONIC with absolute sleeps: no drift, immune to changes of the wall clock.
class MonotonicClock {
 public:
  std::int64_t now_ns() const noexcept {
    timespec now;
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
  }
  void wait_until(std::int64_t deadline_ns) noexcept {
    const timespec deadline{static_cast<time_t>(deadline_ns / 1'000'000'000),
                            static_cast<long>(deadline_ns % 1'000'000'000)};
    // Interrupted by a signal: sleep on, the deadline is absolute. The bound: more interruptions in one period mean
    // that something floods this thread with signals; the loop then ticks early rather than hang here.
    for (int tries = 0; tries < 16; ++tries)
      if (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == 0) return;
  }
};

// Scripted time: it moves only when waited on or advanced. `late` makes the next wake-up late.
class VirtualClock {
 public:
  std::int64_t now_ns() const noexcept { return now_ns_; }
  void wait_until(std::int64_t deadline_ns) noexcept {
    if (now_ns_ < deadline_ns) now_ns_ = deadline_ns;
    now_ns_ += late_ns_;
    late_ns_ = 0;
  }
  void advance(std::int64_t ns) noexcept { now_ns_ += ns; }
  void late(std::int64_t ns) noexcept { late_ns_ = ns; }

 private:
  std::int64_t now_ns_ = 0;
  std::int64_t late_ns_ = 0;
};

static_assert(Clock<MonotonicClock> && Clock<VirtualClock>);

}  // namespace palpate
