// Keeps the loop's slots half a period behind the samples of a device that has a clock of its own.
//
// Two crystals differ by up to 100 parts per million or so. A loop on its own grid then meets the samples in every
// phase: every 10 s and more there is a while in which jitter puts two samples before one tick and none before the
// next. Where the bus tells when a sample arrived, the slots follow instead, half a period after it: the largest
// distance from both edges, and on average no older than samples are without.
//
// A loop of second order, critically damped: what is added to the period is -(e / 64 + sum(e) / 16384) for the phase
// error e, so k_i = k_p^2 / 4, and both roots are at 1 - 1/128 (time constant 128 samples). Integers: the same in every
// build. The core's period stays what the scene says; true ones differ from it by at most kMostShare.
#pragma once

#include <algorithm>
#include <cstdint>

namespace palpate {

class PhaseLock {
 public:
  static constexpr std::int64_t kMostShare = 100;  // of the period, 1 / it: the largest change of a slot's length

  explicit PhaseLock(std::int64_t period_ns) noexcept : period_ns_(period_ns), limit_ns_(period_ns / kMostShare) {}

  // Age of the newest sample at the beginning of the slot, negative if it came after it.
  void see(std::int64_t age_ns) noexcept {
    const std::int64_t error_ns = wrapped(age_ns - period_ns_ / 2);
    sum_ns_ = std::clamp(sum_ns_ + error_ns, -limit_ns_ * kIntegral, limit_ns_ * kIntegral);
    proportional_ns_ = error_ns / kProportional;
    const std::int64_t off_ns = error_ns < 0 ? -error_ns : error_ns;
    calm_ = off_ns < period_ns_ / 8 ? calm_ + 1 : 0;
    locked_ = locked_ || calm_ >= kCalm;
    if (locked_) worst_ns_ = std::max(worst_ns_, off_ns);
  }
  // To be added to the period before the next slot. Without a sample since the last call the clocks' difference alone.
  std::int64_t correction_ns() noexcept {
    const std::int64_t wanted_ns = proportional_ns_ + sum_ns_ / kIntegral;
    proportional_ns_ = 0;
    return -std::clamp(wanted_ns, -limit_ns_, limit_ns_);
  }

  bool locked() const noexcept { return locked_; }              // kCalm samples in a row lay well, once
  std::int64_t worst_ns() const noexcept { return worst_ns_; }  // furthest from half a period since then
  double device_ppm() const noexcept {                          // by which the device's clock is fast
    const double shorter = static_cast<double>(sum_ns_) / static_cast<double>(kIntegral * period_ns_);
    return 1e6 * shorter / (1 - shorter);
  }

 private:
  static constexpr std::int64_t kProportional = 64, kIntegral = 4 * kProportional * kProportional;
  static constexpr int kCalm = 256;  // two time constants

  // Within half a period either way: which of two samples is the newest is what jitter decides.
  std::int64_t wrapped(std::int64_t ns) const noexcept {
    const std::int64_t inside_ns = ns % period_ns_;
    if (inside_ns > period_ns_ / 2) return inside_ns - period_ns_;
    return inside_ns < -period_ns_ / 2 ? inside_ns + period_ns_ : inside_ns;
  }

  std::int64_t period_ns_, limit_ns_;
  std::int64_t sum_ns_ = 0, proportional_ns_ = 0, worst_ns_ = 0;
  int calm_ = 0;
  bool locked_ = false;
};

}  // namespace palpate
