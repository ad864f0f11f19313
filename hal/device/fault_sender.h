// Breaks what a device sends, sample by sample (one call of send() is one sample, of one or two frames), and what it
// receives, tick by tick (one call of receive()).
#pragma once

#include "hal/bus/transport.h"

namespace palpate {

class FaultSender : public Transport {
 public:
  explicit FaultSender(Transport& inner) noexcept : inner_(inner) {}

  // From the next sample on.
  void lose(int samples) noexcept { lose_ = samples; }
  void duplicate(int samples) noexcept { duplicate_ = samples; }
  void reorder(int samples) noexcept { reorder_ = samples; }  // each is sent after the one that follows
  void delay(int ticks) noexcept { delay_ = ticks; }          // samples wait, then go all at once and in order
  void corrupt(int samples) noexcept { corrupt_ = samples; }

  void miss(int ticks) noexcept { miss_ = ticks; }
  void garble(int ticks) noexcept { garble_ = ticks; }

  int send(std::span<const Frame> frames) noexcept override;
  int receive(std::span<Frame> frames) noexcept override;
  TransportState state() const noexcept override { return inner_.state(); }
  const TransportCounters& counters() const noexcept override { return inner_.counters(); }

 private:
  void flip_a_bit(Frame& frame) noexcept;
  void hold(std::span<const Frame> frames) noexcept;
  void release() noexcept;

  Transport& inner_;
  int lose_ = 0, duplicate_ = 0, reorder_ = 0, delay_ = 0, corrupt_ = 0, miss_ = 0, garble_ = 0;
  int corrupted_ = 0;  // bits flipped so far; decides which is next
  Frame held_[kMaxFramesPerReceive];
  int held_count_ = 0;
  bool swapped_ = false;  // what is held goes after the sample at hand
};

}  // namespace palpate
