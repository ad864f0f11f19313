// The time a real bus needs for its bits, for buses that have none (vcan, the loopback): frames sent are held back
// until their last bit would have been on the wire. One sender's view: its frames queue behind one another, with the
// worst-case stuffing of hal/bus/bus_budget.h; it does not arbitrate against the other side's frames.
#pragma once

#include <cstdint>

#include "hal/bus/bus_budget.h"
#include "hal/bus/transport.h"

namespace palpate {

// Time of one frame on the wire, ns: classic_us or fd_us, rounded up.
std::int64_t frame_time_ns(const Frame& frame, const BusRate& rate);

class BusModel : public Transport {
 public:
  // `inner` must outlive this.
  BusModel(Transport& inner, const BusRate& rate) : inner_(inner), rate_(rate) {}

  // Tells the time, which send() and receive() do not know, and hands on what is due by then.
  void advance(std::int64_t now_ns) noexcept;
  // When the oldest waiting frame is due; negative: nothing waits.
  std::int64_t next_ns() const noexcept { return count_ > 0 ? held_[0].due_ns : -1; }

  int send(std::span<const Frame> frames) noexcept override;  // more than kMaxFramesPerReceive waiting: dropped
  int receive(std::span<Frame> frames) noexcept override { return inner_.receive(frames); }
  TransportState state() const noexcept override { return inner_.state(); }
  const TransportCounters& counters() const noexcept override { return inner_.counters(); }

 private:
  struct Held {
    Frame frame;
    std::int64_t due_ns;
  };
  Transport& inner_;
  BusRate rate_;
  Held held_[kMaxFramesPerReceive];
  int count_ = 0;
  std::int64_t now_ns_ = 0, free_ns_ = 0;  // the bus is free from free_ns_ on
};

}  // namespace palpate
