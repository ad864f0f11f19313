// Ticks as a log of CAN frames in the format of `candump -L`, which canplayer replays and candump, log2asc and
// Wireshark read.
//
// A recording holds poses and wrenches, not frames: the frames here are RE-ENCODED from it with the wire codec. What a
// recording does not hold is filled in: status and command sequence numbers count ticks (so a tick without a fresh
// sample shows as a gap), the status says calibrated and enabled (and error, when the tick saw the device report one),
// the device clock is the tick's deadline. A frame that the controller refused is not in the log at all. Times are when
// the controller had read the sample and had sent the command, not when the bits were on the wire.
#pragma once

#include <cstdint>
#include <string>

#include "hal/bus/device_bus.h"
#include "rt_core/record.h"

namespace palpate {

struct CandumpOptions {
  std::string interface = "palpate0";  // as written in the log; canplayer maps it: canplayer vcan0=palpate0
  WireProfile profile = WireProfile::kFd;
  int node = 1;
  std::int64_t wall_minus_monotonic_ns = 0;  // makes the deadlines times of day
  CartesianKinematics kinematics;            // of the run
};

// "(1795233705.123456) can0 181##1AABB..." with a line break: seconds and microseconds, interface, identifier, "#" and
// the data of a classic frame or "##", the flags digit (1: bit rate switched) and the data of an FD frame.
std::string candump_line(std::int64_t time_ns, const std::string& interface, const Frame& frame);

class CandumpLog {
 public:
  explicit CandumpLog(CandumpOptions options);
  // Appends the status frames (none without a fresh sample) and the command frames of one tick. Ticks come in order.
  void add(const TickRecord& record, std::string& text);

 private:
  void add_frames(std::int64_t time_ns, const Frame* frames, int count, std::string& text) const;
  int status_frames(const TickRecord& record, Frame (&frames)[2]) const;

  CandumpOptions options_;
  std::uint32_t last_status_ = 0;  // sequence number of the newest status
};

}  // namespace palpate
