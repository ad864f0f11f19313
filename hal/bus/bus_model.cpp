#include "hal/bus/bus_model.h"

#include <algorithm>
#include <cmath>

namespace palpate {

std::int64_t frame_time_ns(const Frame& frame, const BusRate& rate) {
  const bool extended = frame.id > 0x7FF;
  const double us = frame.fd ? fd_us(frame.length, extended, rate) : classic_us(frame.length, extended, rate);
  return static_cast<std::int64_t>(std::ceil(1e3 * us - 1e-6));  // not one ns up for rounding's sake
}

void BusModel::advance(std::int64_t now_ns) noexcept {
  now_ns_ = now_ns;
  int due = 0;
  while (due < count_ && held_[due].due_ns <= now_ns) inner_.send({&held_[due++].frame, 1});
  std::copy(held_ + due, held_ + count_, held_);
  count_ -= due;
}

int BusModel::send(std::span<const Frame> frames) noexcept {
  int taken = 0;
  for (const Frame& frame : frames) {
    if (count_ == kMaxFramesPerReceive) break;
    free_ns_ = std::max(free_ns_, now_ns_) + frame_time_ns(frame, rate_);
    held_[count_++] = {frame, free_ns_};
    ++taken;
  }
  return taken;
}

}  // namespace palpate
