#include "hal/device/device_node.h"

#include <span>
#include <utility>

namespace palpate {

DeviceNode::DeviceNode(Transport& transport, const NodeOptions& options, const PlantOptions& plant, HandPath path)
    : transport_(transport),
      options_(options),
      plant_(plant, std::move(path)),
      sequence_(options.profile == WireProfile::kFd ? 16 : 8) {}

void DeviceNode::obey(std::uint32_t sequence, const DeviceCommand& command, std::int64_t now_ns) noexcept {
  std::uint32_t missing = 0;
  const SequenceTracker::Step step = sequence_.follow(sequence, missing);
  if (step == SequenceTracker::Step::kDuplicate || step == SequenceTracker::Step::kReordered) {
    counters_.refused += 1;
    return;
  }
  counters_.lost += missing;
  counters_.commands += 1;
  const bool enable = (command.flags & CommandFlag::kEnable) != 0;
  if (enable && !enabled_) latched_ = false;
  enabled_ = enable;
  command_ = command;
  command_.number = static_cast<std::uint32_t>(counters_.commands);
  last_command_ns_ = now_ns;
  expired_ = false;
}

void DeviceNode::take(const Frame& frame, std::int64_t now_ns) noexcept {
  const std::uint32_t base_id = frame.id - static_cast<std::uint32_t>(options_.node);
  const std::span<const std::uint8_t> payload{frame.data, frame.length};
  const bool fd = options_.profile == WireProfile::kFd;
  wire::Command full;
  wire::ClassicTorque torque;
  DeviceCommand command;
  if (fd && frame.fd && base_id == wire::kCommandId &&
      wire::decode(payload, options_.node, full) == wire::DecodeResult::kOk) {
    wire::get_wrench(full, command.force_N, command.torque_Nm);
    command.flags = full.flags;
    return obey(full.sequence, command, now_ns);
  }
  wire::LocalCommand local;
  if (fd && frame.fd && base_id == wire::kLocalCommandId && plant_.options().local_Hz > 0 &&
      wire::decode(payload, options_.node, local) == wire::DecodeResult::kOk) {
    wire::get_wrench(local, command.force_N, command.torque_Nm);
    command.local = wire::get_local(local);
    command.flags = local.flags;
    return obey(local.sequence, command, now_ns);
  }
  if (!fd && !frame.fd && base_id == wire::kClassicForceId &&
      wire::decode(payload, options_.node, pending_) == wire::DecodeResult::kOk) {
    has_pending_ = true;
    return;
  }
  if (!fd && !frame.fd && base_id == wire::kClassicTorqueId && has_pending_ &&
      wire::decode(payload, options_.node, torque) == wire::DecodeResult::kOk && torque.sequence == pending_.sequence) {
    has_pending_ = false;
    wire::get_wrench(pending_, torque, command.force_N, command.torque_Nm);
    command.flags = torque.flags;
    return obey(torque.sequence, command, now_ns);
  }
  counters_.bad += 1;
}

std::uint32_t DeviceNode::flags() const noexcept {
  std::uint32_t flags = DeviceFlag::kCalibrated;
  if (enabled_ && !latched_) flags |= DeviceFlag::kEnabled;
  if (stop_pressed_) flags |= DeviceFlag::kStopButton;
  if (error_ != 0) flags |= DeviceFlag::kError;
  if (latched_) flags |= DeviceFlag::kWatchdog;
  if (plant_.saturated()) flags |= DeviceFlag::kSaturated;
  if (plant_.options().local_Hz > 0 && options_.profile == WireProfile::kFd) flags |= DeviceFlag::kLocalModel;
  return flags;
}

void DeviceNode::send_status() noexcept {
  const Vec3 position_m = plant_.measured_m();
  const Quat orientation = plant_.pose().orientation;
  Frame frames[2];
  int count = 0;
  if (options_.profile == WireProfile::kFd) {
    wire::Status status;
    status.sequence = status_sequence_;
    status.command_sequence = sequence_.last();
    status.flags = flags();
    status.buttons = buttons();
    status.error = error_;
    status.time_us = static_cast<std::uint32_t>(static_cast<std::uint64_t>(1e6 * (plant_.time_s() - started_s_) + 0.5));
    wire::set_pose(status, position_m, orientation);
    count = make_status_frames(options_.node, status, frames);
  } else {
    wire::ClassicPosition p;
    wire::ClassicOrientation o;
    p.sequence = status_sequence_ & 0xFFu;
    o.sequence = p.sequence & wire::kClassicPairMask;
    o.flags = flags() & 0x3Fu;
    o.buttons = buttons() & wire::kClassicButtonMask;
    o.command_echo = sequence_.last() & wire::kClassicEchoMask;
    wire::set_pose(p, o, position_m, orientation);
    count = make_status_frames(options_.node, p, o, frames);
  }
  status_sequence_ = (status_sequence_ + 1) & 0xFFFFu;
  if (transport_.send({frames, static_cast<std::size_t>(count)}) != count) counters_.send_dropped += 1;
}

void DeviceNode::set_powered(bool powered) noexcept {
  if (powered && !powered_) {
    status_sequence_ = 0;
    started_s_ = plant_.time_s();
    sequence_ = SequenceTracker(options_.profile == WireProfile::kFd ? 16 : 8);
    command_ = rendered_ = {};
    has_pending_ = false;
    expired_ = latched_ = enabled_ = true;
  }
  powered_ = powered;
}

namespace {

Vec3 moved_towards(Vec3 from, Vec3 to, double most) noexcept {
  const Vec3 step = to - from;
  const double length = norm(step);
  return length <= most ? to : from + (most / length) * step;
}

}  // namespace

// What the motors are told: the newest command, or nothing. Its force is approached by at most the slew limit: here, or
// by a device that evaluates the local model in its own loop (next_force_N).
void DeviceNode::render() noexcept {
  const PlantOptions& plant = plant_.options();
  if (stop_pressed_ || error_ != 0) {
    rendered_ = {};
    return plant_.step(rendered_);
  }
  const DeviceCommand wanted = latched_ || !enabled_ ? DeviceCommand{} : command_;
  const double share = options_.slew_share_per_ms * plant.period_s * 1e3;
  const bool finite = is_finite(wanted.force_N) && is_finite(wanted.torque_Nm);
  const Wrench target = finite ? Wrench{wanted.force_N, wanted.torque_Nm} : Wrench{};
  rendered_.force_N =
      plant.local_Hz > 0 ? target.force_N : moved_towards(rendered_.force_N, target.force_N, share * plant.force_max_N);
  rendered_.torque_Nm = moved_towards(rendered_.torque_Nm, target.torque_Nm, share * plant.torque_max_Nm);
  rendered_.local = finite ? wanted.local : LocalModel{};
  rendered_.number = wanted.number;
  rendered_.flags = CommandFlag::kEnable;  // what ends is a slope to nothing
  plant_.step(rendered_);
}

void DeviceNode::step(std::int64_t now_ns) noexcept {
  Frame frames[kMaxFramesPerReceive];
  const int count = transport_.receive(frames);
  if (!powered_) return plant_.step({});                    // the hand still moves the handle
  for (int i = 0; i < count; ++i) take(frames[i], now_ns);  // bound: kMaxFramesPerReceive
  if (!expired_ && now_ns - last_command_ns_ > options_.watchdog_ns) {
    expired_ = latched_ = enabled_ = true;
    counters_.watchdog += 1;
  }
  if (expired_) command_ = {};
  render();
  if (!silent_) {
    send_status();
  } else {
    status_sequence_ = (status_sequence_ + 1) & 0xFFFFu;
  }
}

}  // namespace palpate
