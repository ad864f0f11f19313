// Moves CAN frames. A small virtual interface, because which transport is used is chosen at run time by the user: two
// virtual calls per tick cost nanoseconds beside the system calls behind them, and everything above stays one object
// file instead of one per transport. Every call is bounded: it never waits and never allocates.
#pragma once

#include <cstdint>
#include <span>

namespace palpate {

struct Frame {
  std::uint32_t id = 0;     // identifier; above 0x7FF one of 29 bits
  std::uint8_t length = 0;  // bytes of data: 0..8, or an FD length up to 64
  bool fd = false;
  bool remote = false;  // asks for the frame of this identifier; carries no data
  std::uint8_t data[64] = {};
  std::int64_t age_ns = -1;  // since it arrived, when it was received; negative: not known
};

// What a transport noticed since it was opened; only ever counts up.
struct TransportCounters {
  std::uint64_t received = 0;      // frames handed out
  std::uint64_t sent = 0;          // frames handed to the kernel
  std::uint64_t send_dropped = 0;  // frames the kernel did not take (queue full, link down): dropped, never retried
  std::uint64_t overflow = 0;      // frames lost in the receive queue before they were read
  std::uint64_t error_frames = 0;  // bus errors reported by the controller chip
  std::uint64_t malformed = 0;     // datagrams of a wrong size
  std::uint64_t failures = 0;      // unexpected errors of the system calls
};

enum class TransportState : int {
  kUp = 0,
  kDown,    // the interface went down or the other end closed; nothing will arrive
  kBusOff,  // the CAN controller left the bus: stays until the transport is opened again
};

// Frames drained by one receive() at most. A 1 kHz device sends 2 frames a tick, so 64 is the backlog of 32 ticks; what
// is beyond it is read next tick and counted by the device layer as a backlog.
inline constexpr int kMaxFramesPerReceive = 64;

class Transport {
 public:
  virtual ~Transport() = default;
  // Hands over all frames or drops the rest; returns how many were taken.
  virtual int send(std::span<const Frame> frames) noexcept = 0;
  // Reads what has arrived, at most frames.size() and at most kMaxFramesPerReceive; returns how many, 0 if none.
  virtual int receive(std::span<Frame> frames) noexcept = 0;
  // Remote frames are handed out from now on; by default they are counted as malformed.
  virtual void accept_remote() noexcept {}
  // Frames with identifiers of 29 bits are handed out from now on; by default they are counted as malformed.
  virtual void accept_extended() noexcept {}
  // Received frames tell their age from now on, where the system knows it (sockets; hidraw does not).
  virtual void stamp_arrivals() noexcept {}
  virtual TransportState state() const noexcept = 0;
  virtual const TransportCounters& counters() const noexcept = 0;
};

}  // namespace palpate
