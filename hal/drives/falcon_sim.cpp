#include "hal/drives/falcon_sim.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "hal/drives/frame_bytes.h"

namespace palpate {

using namespace falcon;

FalconSim::FalconSim(Transport& transport, const ArmProfile& arm, const PlantOptions& plant, HandPath path)
    : transport_(transport), arm_(arm), plant_(arm, plant, std::move(path)) {}

int FalconSim::motor_of(int axis) const noexcept {
  return static_cast<int>(arm_.axes[static_cast<std::size_t>(axis)].node) - 1;
}

// A motor's number pushes against the encoder's count.
double FalconSim::torque_Nm(int axis) const noexcept {
  const AxisProfile& profile = arm_.axes[static_cast<std::size_t>(axis)];
  return -profile.rated_Nm * last_.number[motor_of(axis)] / kMostMotor;
}

void FalconSim::restart() noexcept {
  homed_ = 0;
  sought_ = 0;
  last_ = {};
}

// As the adapter sends them: its two bytes of status first; modem lines up, nothing wrong on the line.
void FalconSim::say(const std::uint8_t* bytes, int count) noexcept {
  Frame frame{.id = usb::kIn, .length = static_cast<std::uint8_t>(kStatusBytes + count), .fd = true};
  frame.data[0] = 0x01;
  frame.data[1] = 0x60;
  std::copy_n(bytes, count, frame.data + kStatusBytes);
  send_frames(transport_, &frame, 1);
  spoke_ = true;
}

void FalconSim::control(const Frame& frame) noexcept {
  std::uint16_t value = 0;
  std::memcpy(&value, frame.data + 2, 2);
  if (frame.data[1] == kLatency && !fault_.slow_adapter) latency_ms_ = value;
  if (frame.data[1] == kBaud) baud_ = value;
  if (frame.data[1] != kGetLatency) return;
  Frame reply{.id = usb::kControlAnswer, .length = 1, .fd = true};
  reply.data[0] = static_cast<std::uint8_t>(latency_ms_);
  send_frames(transport_, &reply, 1);
}

void FalconSim::answer() noexcept {
  if (fault_.other_speech) return say(reinterpret_cast<const std::uint8_t*>("<hello>\r\n"), 9);
  // The hand brings the encoders past their marks, one after another.
  if ((last_.bits & kSeekHome) != 0) sought_ += 1;
  for (int i = 0; i < kMotors; ++i)
    if (sought_ > 10 * (i + 1) && !(fault_.stays_away && i == 1)) homed_ |= 1u << i;
  Packet packet;
  packet.bits = static_cast<std::uint8_t>(homed_ << 4 | (buttons_ & kButtons));
  for (int i = 0; i < plant_.count(); ++i) {
    const double counts = plant_.turns(i) * arm_.axes[static_cast<std::size_t>(i)].counts_per_turn;
    packet.number[motor_of(i)] = static_cast<std::int16_t>(std::lround(counts));
  }
  say(packet_frame(usb::kIn, packet).data, kPacketBytes);
}

void FalconSim::take(const Frame& frame) noexcept {
  if (frame.id == usb::kControl && frame.length == 8) return control(frame);
  if (frame.id != usb::kOut || fault_.no_firmware || baud_ != kFastBaud) return;
  for (int i = 0; i < frame.length; ++i)
    if (reader_.take(frame.data[i], last_)) answer();
}

void FalconSim::step_bus() noexcept {
  spoke_ = false;
  take_frames(transport_, [this](const Frame& frame) noexcept { take(frame); });
  if (!spoke_ && latency_ms_ == kLatency_ms) say(nullptr, 0);  // the adapter's status alone
}

void FalconSim::step() noexcept {
  step_bus();
  double torque[kMaxAxes];
  bool driven[kMaxAxes];
  for (int i = 0; i < plant_.count(); ++i) {
    driven[i] = homed_ == 0x7;
    torque[i] = torque_Nm(i);
  }
  plant_.step(torque, driven);
}

}  // namespace palpate
