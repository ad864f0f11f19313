#include "sim_host/record/candump_log.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

namespace palpate {

namespace {

std::uint32_t low16(std::uint64_t value) { return static_cast<std::uint32_t>(value & 0xFFFFu); }

}  // namespace

std::string candump_line(std::int64_t time_ns, const std::string& interface, const Frame& frame) {
  std::string line = fmt::format("({:010}.{:06}) {} {:03X}#", time_ns / 1'000'000'000, time_ns % 1'000'000'000 / 1000,
                                 interface, frame.id);
  if (frame.fd) line += "#1";
  for (int i = 0; i < frame.length; ++i) fmt::format_to(std::back_inserter(line), "{:02X}", frame.data[i]);
  return line + '\n';
}

CandumpLog::CandumpLog(CandumpOptions options) : options_(std::move(options)) {}

void CandumpLog::add_frames(std::int64_t time_ns, const Frame* frames, int count, std::string& text) const {
  for (int i = 0; i < count; ++i) {
    text += candump_line(time_ns + options_.wall_minus_monotonic_ns, options_.interface, frames[i]);
  }
}

int CandumpLog::status_frames(const TickRecord& record, Frame (&frames)[2]) const {
  const Pose pose = pose_in_device(options_.kinematics, record.input.pose_w);
  std::uint32_t flags = DeviceFlag::kCalibrated | DeviceFlag::kEnabled;
  if ((record.input.device_fault & Fault::kDeviceReported) != 0) flags |= DeviceFlag::kError;
  if (options_.profile == WireProfile::kFd) {
    wire::Status status;
    status.sequence = low16(record.sequence);
    status.command_sequence = low16(record.sequence - 1);
    status.flags = flags;
    status.buttons = record.input.buttons;
    status.time_us = static_cast<std::uint32_t>(record.timing.deadline_ns / 1000);
    wire::set_pose(status, pose.position_m, pose.orientation);
    return make_status_frames(options_.node, status, frames);
  }
  wire::ClassicPosition position;
  wire::ClassicOrientation orientation;
  position.sequence = static_cast<std::uint32_t>(record.sequence & 0xFFu);
  orientation.sequence = position.sequence & wire::kClassicPairMask;
  orientation.command_echo = low16(record.sequence - 1) & wire::kClassicEchoMask;
  orientation.flags = flags;
  orientation.buttons = record.input.buttons & wire::kClassicButtonMask;
  wire::set_pose(position, orientation, pose.position_m, pose.orientation);
  return make_status_frames(options_.node, position, orientation, frames);
}

void CandumpLog::add(const TickRecord& record, std::string& text) {
  const TickTiming& t = record.timing;
  const std::int64_t received_ns = t.deadline_ns + t.wake_latency_ns + t.receive_ns;
  Frame frames[2];
  if (record.input.stale_ticks == 0) {
    add_frames(received_ns, frames, status_frames(record, frames), text);
    last_status_ = low16(record.sequence);
  }
  const DeviceCommand si = to_command(options_.kinematics, record.output, CommandFlag::kEnable);
  wire::Command command;
  command.sequence = low16(record.sequence);
  command.status_sequence = last_status_;
  command.flags = si.flags;
  const int count = make_command_frames(options_.profile, options_.node, command, si, frames);
  add_frames(received_ns + t.compute_ns + t.transmit_ns, frames, count, text);
}

}  // namespace palpate
