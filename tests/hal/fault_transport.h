// Breaks a transport on purpose, by script: what is received, what is sent, or the state. For tests of everything
// above.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "hal/bus/transport.h"

namespace palpate {

enum class TransportFault : int {
  kLose,       // received frames vanish (several calls in a row: silence)
  kDuplicate,  // received frames come twice
  kReorder,    // received frames are held and delivered after the next call's
  kDelay,      // received frames are held for `argument` calls (frames behind them wait too)
  kCorrupt,    // bit `argument` of the received frames' data is flipped
  kLoseSent,   // sent frames vanish without being reported
  kFullQueue,  // sent frames are refused, as by a full queue
  kBusOff,     // the transport reports bus-off from here on
};

// Active in calls [from, from + count) of receive(); the first call is number 0. send() belongs to the last receive().
struct FaultEvent {
  std::uint64_t from = 0;
  std::uint64_t count = 1;
  TransportFault fault = TransportFault::kLose;
  int argument = 0;
};

class FaultTransport : public Transport {
 public:
  FaultTransport(Transport& inner, std::vector<FaultEvent> script) : inner_(inner), script_(std::move(script)) {}

  int send(std::span<const Frame> frames) noexcept override;
  int receive(std::span<Frame> frames) noexcept override;
  TransportState state() const noexcept override { return bus_off_ ? TransportState::kBusOff : inner_.state(); }
  const TransportCounters& counters() const noexcept override { return inner_.counters(); }

 private:
  struct Held {
    Frame frame;
    std::uint64_t due;  // call at which it may be delivered
  };
  const FaultEvent* active(TransportFault fault) const noexcept;
  void hold(const Frame& frame, std::uint64_t due) noexcept;
  int release(std::span<Frame> frames, int count) noexcept;

  Transport& inner_;
  std::vector<FaultEvent> script_;
  Held held_[kMaxFramesPerReceive];
  int held_count_ = 0;
  std::uint64_t call_ = 0;  // number of the next receive()
  bool queued_ = false;     // held frames wait in order behind a delay
  bool bus_off_ = false;
};

}  // namespace palpate
