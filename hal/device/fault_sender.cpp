#include "hal/device/fault_sender.h"

#include <algorithm>

namespace palpate {

void FaultSender::hold(std::span<const Frame> frames) noexcept {
  for (const Frame& frame : frames)
    if (held_count_ < kMaxFramesPerReceive) held_[held_count_++] = frame;
}

void FaultSender::release() noexcept {
  for (int i = 0; i < held_count_; ++i) inner_.send({held_ + i, 1});
  held_count_ = 0;
}

void FaultSender::flip_a_bit(Frame& frame) noexcept {
  if (frame.length == 0) return;
  const int bit = corrupted_++ * 13 % (8 * frame.length);  // 13 and 8 L have no common factor: every bit in turn
  frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1u << (bit % 8)));
}

int FaultSender::receive(std::span<Frame> frames) noexcept {
  const int count = inner_.receive(frames);
  if (miss_ > 0) {
    miss_ -= 1;
    return 0;
  }
  if (garble_ > 0) {
    garble_ -= 1;
    for (int i = 0; i < count; ++i) flip_a_bit(frames[static_cast<std::size_t>(i)]);  // bound: kMaxFramesPerReceive
  }
  return count;
}

int FaultSender::send(std::span<const Frame> frames) noexcept {
  constexpr std::size_t kMostFrames = 2;  // of one sample
  Frame sample[kMostFrames];
  const std::size_t count = std::min(frames.size(), kMostFrames);
  std::copy_n(frames.begin(), count, sample);
  const std::span<const Frame> out(sample, count);
  if (lose_ > 0) {
    lose_ -= 1;
    return static_cast<int>(count);
  }
  if (corrupt_ > 0) {
    corrupt_ -= 1;
    for (Frame& frame : std::span(sample, count)) flip_a_bit(frame);
  }
  if (delay_ > 0) {
    delay_ -= 1;
    hold(out);
    return static_cast<int>(count);
  }
  if (swapped_) {
    swapped_ = false;
    const int sent = inner_.send(out);
    release();
    return sent;
  }
  if (reorder_ > 0) {
    reorder_ -= 1;
    swapped_ = true;
    hold(out);
    return static_cast<int>(count);
  }
  if (held_count_ > 0) release();
  if (duplicate_ > 0) {
    duplicate_ -= 1;
    inner_.send(out);
  }
  return inner_.send(out);
}

}  // namespace palpate
