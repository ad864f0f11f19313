#include "hal/drives/falcon_drives.h"

#include "hal/device/device.h"
#include "hal/device/profile_key.h"
#include "hal/drives/frame_bytes.h"
#include "rt_core/status.h"

namespace palpate {

using namespace falcon;

namespace {

// Which motor an axis is, from 0.
int motor_of(const ArmProfile& arm, int axis) noexcept {
  return static_cast<int>(arm.axes[static_cast<std::size_t>(axis)].node) - 1;
}

}  // namespace

FalconDrives::FalconDrives(Transport& transport, const ArmProfile& arm, double) noexcept
    : transport_(transport), arm_(arm) {}

void FalconDrives::drain() noexcept {
  take_frames(transport_, [this](const Frame& frame) noexcept {
    if (frame.id == usb::kControlAnswer && frame.length == 1) latency_ms_ = frame.data[0];
    if (frame.id != usb::kIn || frame.length < kStatusBytes) return;
    line_errors_ += (frame.data[1] & kLineErrors) != 0;
    for (int i = kStatusBytes; i < frame.length; ++i) {
      if (!reader_.take(frame.data[i], last_)) continue;
      packets_ += 1;
      fresh_ = true;
    }
  });
}

bool FalconDrives::send(const Packet& packet) noexcept {
  const Frame frame = packet_frame(usb::kOut, packet);
  return send_frames(transport_, &frame, 1) == 1;
}

// The adapter's speed, and that it hands bytes over after 1 ms; it waits 16 by itself.
std::string FalconDrives::prepare_line(const Pause& pause) {
  const Frame set_up[] = {usb::control_frame(kReset, kReceived, 0),
                          usb::control_frame(kReset, kUnsent, 0),
                          usb::control_frame(kLatency, kLatency_ms, 0),
                          usb::control_frame(kBaud, kFastBaud, 0),
                          usb::control_frame(kData, 8, 0),
                          usb::control_frame(kFlow, 0, 0),
                          usb::control_frame(kGetLatency, 0, 0, 1)};
  constexpr int kCount = static_cast<int>(std::size(set_up));
  latency_ms_ = 0;
  if (send_frames(transport_, set_up, kCount) != kCount) return "the serial adapter refuses to be set up";
  for (int ms = 0; ms < 100 && latency_ms_ == 0; ++ms) {
    pause();
    drain();
  }
  if (latency_ms_ == kLatency_ms) return "";
  return "the serial adapter holds bytes back for " + std::to_string(latency_ms_) + " ms and cannot be set to " +
         std::to_string(kLatency_ms) + ": not an FT232R?";
}

// A packet back for each, with motors off.
std::string FalconDrives::watch_rate(const Pause& pause) {
  constexpr int kWatched_ms = 200;
  const std::uint32_t before = packets_;
  const std::uint64_t spoilt = reader_.spoilt();
  for (int ms = 0; ms < kWatched_ms; ++ms) {
    send({.bits = kBlue});
    pause();
    drain();
  }
  if (packets_ == before)
    return reader_.spoilt() == spoilt
               ? "the Falcon does not answer: it is not powered (both lamps of its supply), or it has no firmware, "
                 "which it forgets without power; docs/devices.md says how it is loaded"
               : "what comes from the device is not a Falcon's packets";
  const double share = (packets_ - before) / static_cast<double>(kWatched_ms);
  if (share >= 0.9) return "";
  return "the Falcon answers " + short_text(100 * share) + " of 100 packets: another program at the device, a hub?";
}

// Encoders count from their index marks, which the hand brings them past.
std::string FalconDrives::find_home(const Pause& pause) {
  constexpr int kWait_ms = 10'000;
  for (int ms = 0; ms < kWait_ms && !homed(); ++ms) {
    send({.bits = kSeekHome | kRed});
    pause();
    drain();
  }
  if (homed()) return "";
  std::string which;
  for (int i = 0; i < kMotors; ++i)
    if ((last_.bits >> (4 + i) & 1) == 0) which += (which.empty() ? "" : ", ") + std::to_string(i + 1);
  return "the Falcon's encoders " + which +
         " have not passed their index marks in 10 s: while the red light is on, pull the handle out to its stop and "
         "push it in to the other, then start again";
}

std::string FalconDrives::start(const Pause& pause) {
  started_ = false;
  std::string wrong = prepare_line(pause);
  if (wrong.empty()) wrong = watch_rate(pause);
  if (wrong.empty()) wrong = find_home(pause);
  started_ = wrong.empty();
  return wrong;
}

void FalconDrives::receive(AxisSample& sample) noexcept {
  drain();
  sample.fresh = fresh_;
  sample.received = fresh_ ? 1 : 0;
  sample.faults = transport_.state() == TransportState::kBusOff ? std::uint32_t{Fault::kBusOff} : 0u;
  sample.flags = sample.error_code = 0;
  sample.buttons = last_.bits & kButtons;
  if (started_ && homed()) {
    sample.flags = DeviceFlag::kEnabled;
  } else if (started_) {
    sample.flags = DeviceFlag::kError;
    sample.error_code = kNotHomed;
  }
  fresh_ = false;
  for (int i = 0; i < joint_count(arm_.linkage); ++i)
    sample.turns[i] = last_.number[motor_of(arm_, i)] / arm_.axes[static_cast<std::size_t>(i)].counts_per_turn;
}

// A motor's number turns it against its encoder's count.
bool FalconDrives::transmit(const AxisCommand& command) noexcept {
  Packet packet;
  const bool obey = command.enable && started_ && homed();
  packet.bits = obey ? kGreen : kBlue;
  for (int i = 0; i < joint_count(arm_.linkage); ++i) {
    const AxisProfile& axis = arm_.axes[static_cast<std::size_t>(i)];
    const double wanted = -kMostMotor * command.torque_Nm[i] / axis.rated_Nm;
    const double number = obey && is_finite(wanted) ? clamp_to(wanted, -kMostMotor, kMostMotor) : 0.0;
    packet.number[motor_of(arm_, i)] = static_cast<std::int16_t>(number < 0 ? number - 0.5 : number + 0.5);
  }
  return send(packet);
}

}  // namespace palpate
