#include "hal/drives/moteus_sim.h"

#include <algorithm>
#include <cstdio>

#include "hal/drives/frame_bytes.h"

namespace palpate {

using namespace moteus;

namespace {

// Values as the registers' integers scale them; the least integer stands for "none".
double scaled(const Part& part, int i, double unit8, double unit16, double none) noexcept {
  const double raw = part.number(i);
  if (part.type == Type::kFloat) return is_finite(raw) ? raw : none;
  if (part.type == Type::kInt8) return raw == -128 ? none : raw * unit8;
  return raw == -32768 ? none : raw * unit16;
}

constexpr double kDefaultTimeout_s = 0.1, kNoTorqueLimit_Nm = 1e9, kNoTimeout_s = 1e9;

}  // namespace

MoteusSim::MoteusSim(Transport& transport, const ArmProfile& arm, const PlantOptions& plant, HandPath path)
    : transport_(transport), arm_(arm), plant_(arm, plant, std::move(path)) {
  transport.accept_extended();
  unsigned part[3] = {};
  std::sscanf(arm.firmware.c_str(), "%u.%u.%u", &part[0], &part[1], &part[2]);
  firmware_ = part[0] << 16 | part[1] << 8 | part[2];
  for (int i = 0; i < plant_.count(); ++i)
    drive_[i].node = static_cast<int>(arm.axes[static_cast<std::size_t>(i)].node);
}

bool MoteusSim::any_enabled() const noexcept {
  bool any = false;
  for (int i = 0; i < plant_.count(); ++i) any = any || enabled(i);
  return any;
}

// Position mode with its loops' gains scaled to zero is the feed-forward alone, within the command's limit.
double MoteusSim::torque_Nm(int axis) const noexcept {
  const Command& command = drive_[axis].command;
  if (!enabled(axis) || command.kp != 0 || command.kd != 0) return 0;
  return std::clamp(command.feedforward_Nm, -command.most_Nm, command.most_Nm);
}

// From the time-out only a stop leads out; a stop clears faults whose cause has gone.
void MoteusSim::set_mode(int axis, int mode) noexcept {
  Drive& drive = drive_[axis];
  drive.fed_s = 0;
  if (mode == kStopped) {
    drive.fault = fault_of(axis) ? fault_.fault : 0;
    drive.mode = drive.fault != 0 ? kFaulted : kStopped;
  } else if (mode == kPositionMode && drive.mode != kTimedOut && drive.mode != kFaulted) {
    drive.mode = fault_of(axis) && fault_.stays_stopped ? kStopped : kPositionMode;
    drive.command = {};
  }
}

void MoteusSim::write(int axis, const Part& part) noexcept {
  Command& command = drive_[axis].command;
  for (int i = 0; i < part.count; ++i) {
    switch (part.first + static_cast<std::uint32_t>(i)) {
      case kMode:
        set_mode(axis, static_cast<int>(part.number(i)));
        break;
      case kFeedforward:
        command.feedforward_Nm = scaled(part, i, 0.5, 0.01, 0);
        break;
      case kKpScale:
        command.kp = scaled(part, i, 1 / 127.0, 1 / 32767.0, 1);
        break;
      case kKdScale:
        command.kd = scaled(part, i, 1 / 127.0, 1 / 32767.0, 1);
        break;
      case kMaxTorque:
        command.most_Nm = scaled(part, i, 0.5, 0.01, kNoTorqueLimit_Nm);
        break;
      case kTimeout:
        command.timeout_s = fault_of(axis) && fault_.no_watchdog ? 0 : scaled(part, i, 0.01, 0.001, kNoTimeout_s);
        break;
      default:
        break;
    }
  }
}

double MoteusSim::value_of(int axis, std::uint32_t reg) noexcept {
  const Drive& drive = drive_[axis];
  const auto profile = static_cast<std::uint64_t>(arm_.axes[static_cast<std::size_t>(axis)].serial);
  const std::uint64_t serial =
      fault_of(axis) && fault_.serial > 0 ? static_cast<std::uint64_t>(fault_.serial) : profile;
  const auto word = [](std::uint64_t bits) { return static_cast<double>(static_cast<std::int32_t>(bits)); };
  switch (reg) {
    case kMode:
      return drive.mode;
    case kPosition:
      return plant_.turns(axis);
    case kFault:
      return drive.fault;
    case kTimeout:
      return drive.command.timeout_s;
    case kFirmware:
      return fault_of(axis) && fault_.firmware_micro >= 0
                 ? (firmware_ & 0xFFFF00) + static_cast<unsigned>(fault_.firmware_micro)
                 : firmware_;
    case kRegisterMap:
      return fault_of(axis) ? fault_.map : kMapVersion;
    case kSerial:
      return word(serial & 0xFFFFFFFF);
    case kSerial + 1:
      return word((serial >> 32 & 0xFFFF) | 0x51100000);
    default:
      return 0;
  }
}

void MoteusSim::obey(int axis, const std::string& line) {
  Drive& drive = drive_[axis];
  const bool brakes = fault_of(axis) && fault_.brakes;
  if (line == "conf get motor_position.output.sign") {
    drive.said += fault_of(axis) && fault_.reversed ? "-1\r\n" : "1\r\n";
  } else if (line == "conf get servo.timeout_mode") {
    drive.said += std::to_string(drive.timeout_mode) + "\r\n";
  } else if (line == "conf set servo.timeout_mode 0") {
    drive.timeout_mode = brakes ? drive.timeout_mode : 0;
    drive.said += "OK\r\n";
  } else {
    drive.said += "ERR unknown command\r\n";
  }
}

void MoteusSim::answer(int axis, const Frame& frame) {
  Drive& drive = drive_[axis];
  Writer reply(reply_id(drive.node));
  bool any = false;
  Reader reader(frame);
  for (Part part; reader.next(part);) {
    if (part.kind == kWrite) write(axis, part);
    if (part.kind == kRead) {
      any = true;
      reply.head(kReply, part.type, part.first, part.count);
      for (int i = 0; i < part.count; ++i) {
        const double value = value_of(axis, part.first + static_cast<std::uint32_t>(i));
        if (part.type == Type::kFloat) reply.value(static_cast<float>(value));
        if (part.type == Type::kInt32) reply.value(static_cast<std::int32_t>(value));
        if (part.type == Type::kInt16) reply.value(static_cast<std::int16_t>(value));
        if (part.type == Type::kInt8) reply.value(static_cast<std::int8_t>(value));
      }
    }
    if (part.kind == kToServer) {
      drive.heard.append(reinterpret_cast<const char*>(part.bytes), static_cast<std::size_t>(part.count));
      for (std::size_t end; (end = drive.heard.find('\n')) != std::string::npos; drive.heard.erase(0, end + 1))
        obey(axis, drive.heard.substr(0, end));
    }
    if (part.kind == kPollServer) {
      any = true;
      const std::size_t count = std::min(drive.said.size(), static_cast<std::size_t>(part.count));
      reply.text(kFromServer, drive.said.data(), static_cast<int>(count));
      drive.said.erase(0, count);
    }
  }
  if (any && (frame.id & kAnswer) != 0 && reply.whole()) send_frames(transport_, &reply.finish(), 1);
}

void MoteusSim::take(const Frame& frame) noexcept {
  for (int i = 0; i < plant_.count(); ++i)
    if (frame.fd && (frame.id & 0xFF) == static_cast<std::uint32_t>(drive_[i].node) && !silent(i)) answer(i, frame);
}

void MoteusSim::restart(int axis, int periods) noexcept {
  Drive fresh;
  fresh.node = drive_[axis].node;
  fresh.off_periods = periods;
  drive_[axis] = fresh;
}

void MoteusSim::watch() noexcept {
  for (int i = 0; i < plant_.count(); ++i) {
    Drive& drive = drive_[i];
    if (drive.off_periods > 0) drive.off_periods -= 1;
    drive.fed_s += plant_.plant().options().period_s;
    if (fault_of(i) && fault_.fault != 0) {
      drive.mode = kFaulted;
      drive.fault = fault_.fault;
    }
    const double limit_s = drive.command.timeout_s > 0 ? drive.command.timeout_s : kDefaultTimeout_s;
    if (drive.mode == kPositionMode && drive.fed_s > limit_s) {
      drive.mode = kTimedOut;
      watchdogs_ += 1;
    }
  }
}

void MoteusSim::step_bus() noexcept {
  take_frames(transport_, [this](const Frame& frame) noexcept { take(frame); });
  watch();
}

void MoteusSim::step() noexcept {
  step_bus();
  double torque[kMaxAxes];
  bool driven[kMaxAxes];
  for (int i = 0; i < plant_.count(); ++i) {
    driven[i] = enabled(i);
    torque[i] = torque_Nm(i);
  }
  plant_.step(torque, driven);
}

}  // namespace palpate
