// A Device behind a transport: the haptic node's wire protocol with sequence numbers, checksums and plausibility. Bad
// frames are dropped and counted, never used; staleness is what the control loop sees and acts on.
#pragma once

#include <cstdint>

#include "hal/bus/codec.h"
#include "hal/bus/transport.h"
#include "hal/device/device.h"
#include "hal/device/kinematics.h"

namespace palpate {

enum class WireProfile : int { kFd = 0, kClassic = 1 };

// Only ever count up. `lost` counts sequence numbers that never came (or came after a newer one).
struct BusCounters {
  std::uint64_t frames = 0;        // handed out by the transport, whatever became of them
  std::uint64_t accepted = 0;      // status samples used or superseded by a newer one
  std::uint64_t lost = 0;          // missing in the sequence
  std::uint64_t duplicates = 0;    // same sequence number again: dropped
  std::uint64_t reordered = 0;     // older than the newest: dropped
  std::uint64_t restarts = 0;      // sequence jumped too far to be loss: the device restarted
  std::uint64_t checksum = 0;      // checksum wrong: dropped
  std::uint64_t identifier = 0;    // not one of this node's status messages: dropped
  std::uint64_t kind = 0;          // right identifier, but a classic frame for FD or the other way round: dropped
  std::uint64_t length = 0;        // wrong length: dropped
  std::uint64_t version = 0;       // another protocol version: dropped
  std::uint64_t orientation = 0;   // four numbers that are no rotation: passed on, the core refuses them
  std::uint64_t unpaired = 0;      // classic profile: half of a sample whose other half never came
  std::uint64_t clock = 0;         // device clock stood still or ran backwards between samples
  std::uint64_t backlog = 0;       // receive queue not emptied in one tick
  std::uint64_t send_dropped = 0;  // commands not handed to the bus
};

// Why a frame was not used; kNone: none was.
enum class DropReason : int { kNone = 0, kIdentifier, kKind, kLength, kChecksum, kVersion, kOrientation };

// Follows a wrapping sequence number. A step forward of up to half the window is loss; a step back of up to a quarter
// is reordering, unless kRestartAfter such numbers come one after the other: a late burst is short, a sender that
// started again goes on. Anything else means the sender restarted.
class SequenceTracker {
 public:
  enum class Step { kNew, kDuplicate, kReordered, kRestart };
  explicit SequenceTracker(int bits) noexcept : bits_(bits) {}
  // `missing` = numbers skipped (0 unless kNew).
  Step follow(std::uint32_t sequence, std::uint32_t& missing) noexcept;
  std::uint32_t last() const noexcept { return last_; }

  static constexpr int kRestartAfter = 4;

 private:
  int bits_;
  bool started_ = false;
  std::uint32_t last_ = 0;
  std::uint32_t old_ = 0;  // newest number taken for reordered, and how many came in a row
  int old_run_ = 0;
};

class DeviceBus {
 public:
  // `transport` must outlive this. node 1..15.
  DeviceBus(Transport& transport, WireProfile profile, int node = 1) noexcept
      : transport_(transport), profile_(profile), node_(node), sequence_(profile == WireProfile::kFd ? 16 : 8) {}

  void receive(DeviceSample& sample) noexcept;
  bool transmit(const DeviceCommand& command) noexcept;
  const BusCounters& counters() const noexcept { return counters_; }
  const TransportCounters& transport_counters() const noexcept { return transport_.counters(); }
  // The first frame that was not used, and why: what a person needs to see to mend it.
  const Frame& first_bad() const noexcept { return first_bad_; }
  DropReason first_reason() const noexcept { return first_reason_; }
  const DeviceSample& newest() const noexcept { return sample_; }  // last one accepted
  WireProfile profile() const noexcept { return profile_; }
  int node() const noexcept { return node_; }
  // Newest command the device says it obeys (classic profile: its low bits), and the newest one sent: their difference
  // is the delay of the whole way there and back in ticks.
  std::uint32_t obeyed_sequence() const noexcept { return obeyed_; }
  std::uint32_t sent_sequence() const noexcept { return sent_; }

 private:
  void take(const Frame& frame) noexcept;
  void take_status(const Frame& frame) noexcept;
  void take_position(const Frame& frame) noexcept;
  void take_orientation(const Frame& frame) noexcept;
  void take_echo(std::uint32_t echo) noexcept;
  bool decoded(const Frame& frame, wire::DecodeResult result) noexcept;
  void drop(const Frame& frame, DropReason reason, std::uint64_t& counter) noexcept;
  void judge_orientation(const Frame& frame, const Quat& orientation) noexcept;
  bool follow(std::uint32_t sequence) noexcept;
  void accept(Vec3 position_m, Quat orientation) noexcept;
  std::uint32_t faults() const noexcept;

  Transport& transport_;
  WireProfile profile_;
  int node_;
  SequenceTracker sequence_;
  DeviceSample sample_;  // newest accepted
  BusCounters counters_;
  Frame first_bad_;
  DropReason first_reason_ = DropReason::kNone;
  wire::ClassicPosition pending_;  // first half of a classic sample
  bool has_pending_ = false;
  bool has_time_ = false;
  std::uint32_t sent_ = 0, obeyed_ = 0;
  std::uint32_t sent_at_echo_ = 0;  // classic profile: newest sent when the last echo came
  bool has_echo_ = false;
};

static_assert(Device<DeviceBus>);

// Identifiers each side must receive, for the transport's filter: `count` of them valid.
struct WireIds {
  std::uint32_t id[2];
  int count;
};
WireIds status_ids(WireProfile profile, int node) noexcept;
WireIds command_ids(WireProfile profile, int node) noexcept;

// Frames of one command or status, ready to send; they return how many.
int make_status_frames(int node, const wire::Status& status, Frame (&frames)[2]) noexcept;
int make_status_frames(int node, const wire::ClassicPosition& position, const wire::ClassicOrientation& orientation,
                       Frame (&frames)[2]) noexcept;
int make_command_frames(WireProfile profile, int node, const wire::Command& command, const DeviceCommand& si,
                        Frame (&frames)[2]) noexcept;

}  // namespace palpate
