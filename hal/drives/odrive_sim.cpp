#include "hal/drives/odrive_sim.h"

#include <cstdio>

#include "hal/drives/frame_bytes.h"
#include "hal/drives/odrive_wire.h"

namespace palpate {

using namespace odrive;

ODriveSim::ODriveSim(Transport& transport, const ArmProfile& arm, const PlantOptions& plant, HandPath path)
    : transport_(transport), arm_(arm), plant_(arm, plant, std::move(path)) {
  transport.accept_remote();
  unsigned part[3] = {};
  std::sscanf(arm.firmware.c_str(), "%u.%u.%u", &part[0], &part[1], &part[2]);
  for (int i = 0; i < 3; ++i) firmware_[i] = static_cast<std::uint8_t>(part[i]);
  for (int i = 0; i < plant_.count(); ++i)
    drive_[i].node = static_cast<int>(arm.axes[static_cast<std::size_t>(i)].node);
}

void ODriveSim::send_version(int axis) noexcept {
  Frame frame = classic_frame(frame_id(drive_[axis].node, kGetVersion), 8);
  const std::uint8_t bytes[] = {2, 4, 4, 58, firmware_[0], firmware_[1], firmware_[2], 0};
  for (int i = 0; i < 8; ++i) frame.data[i] = bytes[i];
  if (fault_of(axis) && fault_.firmware_minor != 255) frame.data[5] = fault_.firmware_minor;
  send_frames(transport_, &frame, 1);
}

void ODriveSim::send_address(int axis) noexcept {
  Frame frame = classic_frame(frame_id(drive_[axis].node, kAddress), 8);
  const bool other = fault_of(axis) && fault_.serial > 0;
  const double serial = other ? fault_.serial : arm_.axes[static_cast<std::size_t>(axis)].serial;
  put_bytes(frame, 0, static_cast<std::uint64_t>(serial) << 8 | static_cast<std::uint64_t>(drive_[axis].node));
  send_frames(transport_, &frame, 1);
}

void ODriveSim::take_sdo(int axis, const Frame& frame) noexcept {
  Drive& drive = drive_[axis];
  const double endpoint = get_bytes<std::uint16_t>(frame, 1);
  const DrivesProfile& p = arm_.drives;
  if (frame.data[0] == kWrite) {
    if (endpoint == p.endpoint_watchdog_s) drive.watchdog_s = get_bytes<float>(frame, 4);
    if (endpoint == p.endpoint_watchdog) drive.watchdog = frame.data[4] != 0 && !(fault_of(axis) && fault_.no_watchdog);
    drive.fed_s = 0;
    return;
  }
  Frame reply = classic_frame(frame_id(drive.node, kTxSdo), 8);
  put_bytes(reply, 1, static_cast<std::uint16_t>(endpoint));
  if (endpoint == p.endpoint_watchdog_s) put_bytes(reply, 4, drive.watchdog_s);
  if (endpoint == p.endpoint_watchdog) reply.data[4] = drive.watchdog;
  if (endpoint == p.endpoint_direction) put_bytes(reply, 4, fault_of(axis) && fault_.reversed ? -1.0f : 1.0f);
  send_frames(transport_, &reply, 1);
}

void ODriveSim::answer(int axis, const Frame& frame) noexcept {
  Drive& drive = drive_[axis];
  switch (frame.id & kMessageMask) {
    case kGetVersion:
      return send_version(axis);
    case kAddress:
      return send_address(axis);
    case kRxSdo:
      return take_sdo(axis, frame);
    case kClearErrors:
      drive.error = 0;
      drive.fed_s = 0;
      return;
    case kSetControllerMode:
      drive.torque_mode =
          get_bytes<std::uint32_t>(frame, 0) == kTorqueControl && get_bytes<std::uint32_t>(frame, 4) == kPassthrough;
      return;
    case kSetInputTorque:
      drive.torque_Nm = static_cast<double>(get_bytes<float>(frame, 0));
      drive.fed_s = 0;
      return;
    case kSetAxisState: {
      const bool refused = drive.error != 0 || (fault_of(axis) && fault_.stays_idle);
      drive.state = get_bytes<std::uint32_t>(frame, 0) == kClosedLoop && !refused ? kClosedLoop : kIdle;
      return;
    }
    default:
      return;
  }
}

void ODriveSim::take(const Frame& frame) noexcept {
  for (int i = 0; i < plant_.count(); ++i)
    if (!frame.fd && frame.id >> 5 == static_cast<std::uint32_t>(drive_[i].node) && !silent(i)) answer(i, frame);
}

void ODriveSim::restart(int axis, int periods) noexcept {
  Drive fresh;
  fresh.node = drive_[axis].node;
  fresh.off_periods = periods;
  drive_[axis] = fresh;
}

// Positions that fall into this period. Early or late by chance is uniform, from one draw of a linear congruence
// (Knuth's) each.
int ODriveSim::positions_due(int axis) noexcept {
  Drive& drive = drive_[axis];
  const double length = 1 + 1e-6 * drive.ppm;  // of a period, by its clock
  int count = 0;
  drive.due -= length;
  for (; drive.due + drive.late <= 0; ++count) {
    random_ = 6364136223846793005u * random_ + 1442695040888963407u;
    drive.late = drive.jitter * (static_cast<double>(random_ >> 11) * 0x1p-52 - 1);
    drive.due += fault_of(axis) ? fault_.estimate_periods : 1;
  }
  return count;
}

void ODriveSim::watch() noexcept {
  for (int i = 0; i < plant_.count(); ++i) {
    Drive& drive = drive_[i];
    if (drive.off_periods > 0) drive.off_periods -= 1;
    drive.fed_s += plant_.plant().options().period_s;
    if (fault_of(i)) drive.error |= fault_.error;
    if (drive.watchdog && drive.fed_s > static_cast<double>(drive.watchdog_s) &&
        (drive.error & kWatchdogExpired) == 0) {
      drive.error |= kWatchdogExpired;
      watchdogs_ += 1;
    }
    if (drive.error != 0) drive.state = kIdle;
  }
}

void ODriveSim::send_state() noexcept {
  constexpr std::uint64_t kHeartbeatPeriods = 20;
  for (int i = 0; i < plant_.count(); ++i) {
    if (silent(i)) continue;
    for (int n = positions_due(i); n > 0; --n) {
      Frame frame = classic_frame(frame_id(drive_[i].node, kGetEncoderEstimates), 8);
      put_bytes(frame, 0, static_cast<float>(plant_.turns(i)));
      send_frames(transport_, &frame, 1);
    }
    if (periods_ % kHeartbeatPeriods != static_cast<std::uint64_t>(i)) continue;
    Frame frame = classic_frame(frame_id(drive_[i].node, kHeartbeat), 8);
    put_bytes(frame, 0, drive_[i].error);
    frame.data[4] = drive_[i].state;
    send_frames(transport_, &frame, 1);
  }
}

void ODriveSim::step_bus() noexcept {
  take_frames(transport_, [this](const Frame& frame) noexcept { take(frame); });
  watch();
  send_state();
  periods_ += 1;
}

void ODriveSim::step() noexcept {
  step_bus();
  double torque[kMaxAxes];
  bool driven[kMaxAxes];
  for (int i = 0; i < plant_.count(); ++i) {
    driven[i] = on(i);
    torque[i] = torque_Nm(i);
  }
  plant_.step(torque, driven);
}

}  // namespace palpate
