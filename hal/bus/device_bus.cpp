#include "hal/bus/device_bus.h"

#include <span>

namespace palpate {
namespace {

// A classic sample carries no device time; nodes send one per period of 1 ms.

std::span<const std::uint8_t> payload(const Frame& frame) noexcept { return {frame.data, frame.length}; }

template <typename Message, std::size_t bytes>
void fill(Frame& frame, std::uint32_t base_id, int node, bool fd, const Message& message) noexcept {
  frame.id = base_id + static_cast<std::uint32_t>(node);
  frame.length = static_cast<std::uint8_t>(bytes);
  frame.fd = fd;
  encode(message, node, std::span<std::uint8_t, bytes>(frame.data, bytes));
}

}  // namespace

SequenceTracker::Step SequenceTracker::follow(std::uint32_t sequence, std::uint32_t& missing) noexcept {
  const std::uint32_t mask = (1u << bits_) - 1u;
  const std::uint32_t ahead = (sequence - last_) & mask;
  const std::uint32_t behind = (last_ - sequence) & mask;
  missing = 0;
  if (started_ && ahead == 0) return Step::kDuplicate;
  if (started_ && behind <= (mask >> 2)) {
    old_run_ = old_run_ > 0 && sequence == ((old_ + 1) & mask) ? old_run_ + 1 : 1;
    old_ = sequence;
    if (old_run_ < kRestartAfter) return Step::kReordered;
    last_ = sequence & mask;
    old_run_ = 0;
    return Step::kRestart;
  }
  old_run_ = 0;
  const bool loss = started_ && ahead <= (mask >> 1);
  const Step step = loss || !started_ ? Step::kNew : Step::kRestart;
  if (loss) missing = ahead - 1;
  started_ = true;
  last_ = sequence & mask;
  return step;
}

void DeviceBus::drop(const Frame& frame, DropReason reason, std::uint64_t& counter) noexcept {
  counter += 1;
  if (first_reason_ != DropReason::kNone) return;
  first_reason_ = reason;
  first_bad_ = frame;
}

bool DeviceBus::decoded(const Frame& frame, wire::DecodeResult result) noexcept {
  if (result == wire::DecodeResult::kBadChecksum) drop(frame, DropReason::kChecksum, counters_.checksum);
  if (result == wire::DecodeResult::kWrongLength) drop(frame, DropReason::kLength, counters_.length);
  return result == wire::DecodeResult::kOk;
}

void DeviceBus::judge_orientation(const Frame& frame, const Quat& q) noexcept {
  const double length2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (!(length2 >= 1 - kQuaternionSlack && length2 <= 1 + kQuaternionSlack))
    drop(frame, DropReason::kOrientation, counters_.orientation);
}

// True if this sequence number is newer than all before.
bool DeviceBus::follow(std::uint32_t sequence) noexcept {
  std::uint32_t missing = 0;
  const SequenceTracker::Step step = sequence_.follow(sequence, missing);
  counters_.duplicates += step == SequenceTracker::Step::kDuplicate;
  counters_.reordered += step == SequenceTracker::Step::kReordered;
  counters_.restarts += step == SequenceTracker::Step::kRestart;
  counters_.lost += missing;
  sample_.gaps += missing;
  return step == SequenceTracker::Step::kNew || step == SequenceTracker::Step::kRestart;
}

void DeviceBus::accept(Vec3 position_m, Quat orientation) noexcept {
  sample_.position_m = position_m;
  sample_.orientation = orientation;
  sample_.sequence = sequence_.last();
  sample_.received += 1;
  counters_.accepted += 1;
}

void DeviceBus::take_status(const Frame& frame) noexcept {
  wire::Status status;
  if (!decoded(frame, wire::decode(payload(frame), node_, status))) return;
  if (status.version != wire::kVersion) return drop(frame, DropReason::kVersion, counters_.version);
  if (!follow(status.sequence)) return;
  const std::uint32_t elapsed_us = status.time_us - sample_.device_time_us;
  const bool forward = has_time_ && elapsed_us > 0 && elapsed_us < (1u << 31);
  if (has_time_ && !forward) counters_.clock += 1;
  has_time_ = true;
  Vec3 position_m;
  Quat orientation;
  wire::get_pose(status, position_m, orientation);
  judge_orientation(frame, orientation);
  accept(position_m, orientation);
  sample_.age_ns = frame.age_ns;
  sample_.device_time_us = status.time_us;
  sample_.flags = status.flags;
  sample_.buttons = status.buttons;
  sample_.error_code = status.error;
  obeyed_ = status.command_sequence;
  sample_.command_lag = (sent_ - obeyed_) & 0xFFFFu;
}

void DeviceBus::take_position(const Frame& frame) noexcept {
  wire::ClassicPosition position;
  if (!decoded(frame, wire::decode(payload(frame), node_, position))) return;
  if (has_pending_) counters_.unpaired += 1;
  pending_ = position;
  has_pending_ = true;
}

void DeviceBus::take_orientation(const Frame& frame) noexcept {
  wire::ClassicOrientation orientation;
  if (!decoded(frame, wire::decode(payload(frame), node_, orientation))) return;
  if (!has_pending_ || (pending_.sequence & wire::kClassicPairMask) != orientation.sequence) {
    counters_.unpaired += 1;
    return;
  }
  has_pending_ = false;
  if (!follow(pending_.sequence)) return;
  Vec3 position_m;
  Quat rotation;
  wire::get_pose(pending_, orientation, position_m, rotation);
  judge_orientation(frame, rotation);
  accept(position_m, rotation);
  sample_.age_ns = frame.age_ns;
  sample_.flags = orientation.flags;
  sample_.buttons = orientation.buttons;
  sample_.error_code = 0;
  take_echo(orientation.command_echo);
}

// Six bits tell a lag only while they move: one that stands still for 64 commands would look fresh again.
void DeviceBus::take_echo(std::uint32_t echo) noexcept {
  if (echo != obeyed_ || !has_echo_) {
    sample_.command_lag = (sent_ - echo) & wire::kClassicEchoMask;
  } else if (sample_.command_lag < 0xFFFFu) {
    sample_.command_lag += (sent_ - sent_at_echo_) & 0xFFFFu;
  }
  obeyed_ = echo;
  sent_at_echo_ = sent_;
  has_echo_ = true;
}

void DeviceBus::take(const Frame& frame) noexcept {
  const std::uint32_t base_id = frame.id - static_cast<std::uint32_t>(node_);
  const bool classic = profile_ == WireProfile::kClassic;
  const bool first = base_id == (classic ? wire::kClassicPositionId : wire::kStatusId);
  const bool second = classic && base_id == wire::kClassicOrientationId;
  if (!first && !second) return drop(frame, DropReason::kIdentifier, counters_.identifier);
  if (frame.fd == classic) return drop(frame, DropReason::kKind, counters_.kind);
  if (!classic) return take_status(frame);
  if (first) return take_position(frame);
  take_orientation(frame);
}

std::uint32_t DeviceBus::faults() const noexcept {
  std::uint32_t faults = 0;
  if (transport_.state() == TransportState::kBusOff) faults |= Fault::kBusOff;
  const bool reported = (sample_.flags & (DeviceFlag::kError | DeviceFlag::kStopButton)) != 0;
  const bool lost_reference = counters_.accepted > 0 && (sample_.flags & DeviceFlag::kCalibrated) == 0;
  if (reported) faults |= Fault::kDeviceReported;
  if (lost_reference) faults |= Fault::kNotCalibrated;
  return faults;
}

void DeviceBus::receive(DeviceSample& sample) noexcept {
  Frame frames[kMaxFramesPerReceive];
  sample_.received = 0;
  sample_.gaps = 0;
  const int count = transport_.receive(frames);
  if (count == kMaxFramesPerReceive) counters_.backlog += 1;
  counters_.frames += static_cast<std::uint64_t>(count);
  for (int i = 0; i < count; ++i) take(frames[i]);  // bound: kMaxFramesPerReceive
  sample_.fresh = sample_.received > 0;
  sample_.faults = faults();
  sample = sample_;
}

int make_command_frames(WireProfile profile, int node, const wire::Command& command, const DeviceCommand& si,
                        Frame (&frames)[2]) noexcept {
  if (profile == WireProfile::kFd && si.local.valid_s > 0) {
    wire::LocalCommand local{command.sequence, command.status_sequence, command.flags, {}, {}, {}, {}, 0};
    wire::set_wrench(local, si.force_N, si.torque_Nm);
    wire::set_local(local, si.local);
    fill<wire::LocalCommand, wire::kLocalCommandBytes>(frames[0], wire::kLocalCommandId, node, true, local);
    return 1;
  }
  if (profile == WireProfile::kFd) {
    wire::Command full = command;
    wire::set_wrench(full, si.force_N, si.torque_Nm);
    fill<wire::Command, wire::kCommandBytes>(frames[0], wire::kCommandId, node, true, full);
    return 1;
  }
  wire::ClassicForce force;
  wire::ClassicTorque torque;
  force.sequence = torque.sequence = command.sequence & 0xFFu;
  torque.flags = command.flags & 0x3Fu;
  wire::set_wrench(force, torque, si.force_N, si.torque_Nm);
  fill<wire::ClassicForce, wire::kClassicForceBytes>(frames[0], wire::kClassicForceId, node, false, force);
  fill<wire::ClassicTorque, wire::kClassicTorqueBytes>(frames[1], wire::kClassicTorqueId, node, false, torque);
  return 2;
}

int make_status_frames(int node, const wire::Status& status, Frame (&frames)[2]) noexcept {
  fill<wire::Status, wire::kStatusBytes>(frames[0], wire::kStatusId, node, true, status);
  return 1;
}

int make_status_frames(int node, const wire::ClassicPosition& position, const wire::ClassicOrientation& orientation,
                       Frame (&frames)[2]) noexcept {
  fill<wire::ClassicPosition, wire::kClassicPositionBytes>(frames[0], wire::kClassicPositionId, node, false, position);
  fill<wire::ClassicOrientation, wire::kClassicOrientationBytes>(frames[1], wire::kClassicOrientationId, node, false,
                                                                 orientation);
  return 2;
}

bool DeviceBus::transmit(const DeviceCommand& command) noexcept {
  wire::Command header;
  sent_ = (sent_ + 1) & 0xFFFFu;
  header.sequence = sent_;
  header.status_sequence = sequence_.last();
  header.flags = command.flags & 0xFFFFu;
  Frame frames[2];
  const int count = make_command_frames(profile_, node_, header, command, frames);
  const int taken = transport_.send({frames, static_cast<std::size_t>(count)});
  if (taken != count) counters_.send_dropped += 1;
  return taken == count;
}

WireIds status_ids(WireProfile profile, int node) noexcept {
  const auto n = static_cast<std::uint32_t>(node);
  if (profile == WireProfile::kFd) return {{wire::kStatusId + n, 0}, 1};
  return {{wire::kClassicPositionId + n, wire::kClassicOrientationId + n}, 2};
}

WireIds command_ids(WireProfile profile, int node) noexcept {
  const auto n = static_cast<std::uint32_t>(node);
  if (profile == WireProfile::kFd) return {{wire::kCommandId + n, wire::kLocalCommandId + n}, 2};
  return {{wire::kClassicForceId + n, wire::kClassicTorqueId + n}, 2};
}

}  // namespace palpate
