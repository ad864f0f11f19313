#include "hal/drives/cia402_drives.h"

#include "hal/device/device.h"
#include "hal/device/kinematics.h"
#include "hal/device/profile_key.h"
#include "hal/drives/cia402_emergency.h"
#include "rt_core/status.h"

namespace palpate {
namespace {

using namespace canopen;

constexpr int kReplyWait_ms = 100;
// A confirmed transition takes a drive a few periods; power stages that must charge first are given more.
constexpr double kTransition_s = 0.25;
// Heartbeats of the controller within the drives' watchdog: three of four may be lost.
constexpr double kBeatsPerWatchdog = 4;

// An SDO's value by the size its specifier states.
std::uint32_t value_of(const Frame& reply) noexcept {
  const int bytes = 4 - (reply.data[0] >> 2 & 3);
  const auto value = get_bytes<std::uint32_t>(reply, 4);
  return bytes == 4 ? value : value & ((1u << 8 * bytes) - 1);
}

std::string hex(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%X", value);
  return text;
}

std::string object_text(std::uint32_t object) {
  char text[24];
  std::snprintf(text, sizeof text, "object %04Xh:%u", object >> 8, object & 0xFF);
  return text;
}

}  // namespace

Cia402Drives::Cia402Drives(Transport& transport, const ArmProfile& arm, double period_s) noexcept
    : transport_(transport), arm_(arm), period_s_(period_s), count_(joint_count(arm.linkage)) {
  for (int i = 0; i < count_; ++i) drive_[i].node = static_cast<int>(arm.axes[static_cast<std::size_t>(i)].node);
}

std::string Cia402Drives::axis_text(int axis) const {
  return "axis " + std::to_string(axis + 1) + " (CANopen node " + std::to_string(drive_[axis].node) + "): ";
}

void Cia402Drives::take(const Frame& frame) noexcept {
  if (frame.fd || frame.remote) return;
  if (frame.id == awaited_id_ && frame.length == 8) {
    reply_ = frame;
    replied_ = true;
    return;
  }
  const int node = static_cast<int>(frame.id & 0x7F);
  for (int i = 0; i < count_; ++i) {
    Drive& drive = drive_[i];
    if (drive.node != node) continue;
    const std::uint32_t kind = frame.id & ~0x7Fu;
    if (kind == kTpdo1 && frame.length == 6) {
      drive.status = get_bytes<std::uint16_t>(frame, 0);
      drive.position = get_bytes<std::int32_t>(frame, 2);
      drive.moved = true;
      const DriveState state = drive_state(drive.status);
      drive.in_state = state == drive.state ? drive.in_state : 0;
      drive.state = state;
    } else if (kind == kEmergency && frame.length == 8) {
      drive.emergency = get_bytes<std::uint16_t>(frame, 0);  // 0: over
      if (drive.emergency == 0) continue;
      drive.told = drive.emergency;
      drive.told_register = frame.data[2];
    } else if (kind == kHeartbeat && frame.length == 1 && frame.data[0] == kBoot) {
      drive.restarted = true;
    }
  }
}

void Cia402Drives::drain() noexcept {
  take_frames(transport_, [this](const Frame& frame) noexcept { take(frame); });
}

bool Cia402Drives::exchange(int axis, const Frame& request, const Pause& pause) {
  awaited_id_ = kSdoReply + static_cast<std::uint32_t>(drive_[axis].node);
  replied_ = false;
  send_frames(transport_, &request, 1);
  for (int ms = 0; ms < kReplyWait_ms && !replied_; ++ms) {
    pause();
    drain();
  }
  awaited_id_ = 0;
  return replied_ && sdo_object(reply_) == sdo_object(request);
}

bool Cia402Drives::read(int axis, std::uint32_t object, std::uint32_t& value, const Pause& pause) {
  const std::uint32_t id = kSdoRequest + static_cast<std::uint32_t>(drive_[axis].node);
  // Expedited, with its size: 0x43, 47, 4B, 4F.
  if (!exchange(axis, sdo_frame(id, kUpload, object, 0), pause) || (reply_.data[0] & 0xF3) != 0x43) return false;
  value = value_of(reply_);
  return true;
}

// Writes and reads back.
std::string Cia402Drives::write(int axis, std::uint32_t object, int bytes, std::uint32_t value, const Pause& pause) {
  const std::uint32_t id = kSdoRequest + static_cast<std::uint32_t>(drive_[axis].node);
  const std::string what = axis_text(axis) + object_text(object);
  if (!exchange(axis, sdo_frame(id, download_of(bytes), object, value), pause)) return what + ": no answer";
  if (reply_.data[0] == kAborted)
    return what + " refuses " + hex(value) + ": abort " + hex(get_bytes<std::uint32_t>(reply_, 4));
  std::uint32_t now = 0;
  if (reply_.data[0] != kDownloaded || !read(axis, object, now, pause)) return what + ": no answer";
  return now == value ? "" : what + " holds " + hex(now) + " after " + hex(value) + " was written";
}

std::string Cia402Drives::demand(int axis, std::uint32_t object, double expected, const char* what,
                                 const Pause& pause) {
  std::uint32_t value = 0;
  if (!read(axis, object, value, pause))
    return axis_text(axis) + what + " (" + object_text(object) + ") cannot be read";
  if (static_cast<double>(value) == expected) return "";
  char text[80];
  std::snprintf(text, sizeof text, " is %u, the profile says %.0f", value, expected);
  return axis_text(axis) + what + text;
}

void Cia402Drives::command_network(Nmt command, int node) {
  Frame frame = classic_frame(kNmt, 2);
  frame.data[0] = command;
  frame.data[1] = static_cast<std::uint8_t>(node);
  send_frames(transport_, &frame, 1);
}

// Which drive it is. Everything is read, nothing written.
std::string Cia402Drives::identify(int axis, const Pause& pause) {
  const AxisProfile& a = arm_.axes[static_cast<std::size_t>(axis)];
  std::uint32_t value = 0;
  if (!read(axis, kDeviceType, value, pause))
    return axis_text(axis) +
           "does not answer; is it powered, is its node number that of the profile, the bit rate right, the bus "
           "terminated?";
  if ((value & 0xFFFF) != 402) return axis_text(axis) + "is no CiA 402 drive: device type " + hex(value);
  std::string wrong = demand(axis, kVendor, arm_.drives.vendor_id, "vendor", pause);
  if (wrong.empty()) wrong = demand(axis, kProduct, arm_.drives.product_code, "product code", pause);
  if (wrong.empty()) wrong = demand(axis, kRevision, arm_.drives.revision, "revision", pause);
  if (!wrong.empty()) return wrong + ": another drive or firmware than the profile is written for";
  if (!read(axis, kSerial, value, pause)) return axis_text(axis) + "serial number cannot be read";
  if (static_cast<double>(value) == a.serial) return "";
  for (int i = 0; i < count_; ++i)
    if (static_cast<double>(value) == arm_.axes[static_cast<std::size_t>(i)].serial)
      return axis_text(axis) + "its serial number is that of axis " + std::to_string(i + 1) + ": the axes are swapped";
  return axis_text(axis) + "serial number " + std::to_string(value) +
         " is not that of the profile: another drive than the one measured";
}

// Signs. A polarity that is not in the dictionary reverses nothing, which remarks() tells; one that is there and cannot
// be read may.
std::string Cia402Drives::check_polarity(int axis, const Pause& pause) {
  std::uint32_t polarity = 0;
  const std::string what = axis_text(axis) + "its polarity (object 607Eh) ";
  if (read(axis, kPolarity, polarity, pause))
    return polarity == 0 ? ""
                         : what + "is reversed: " + hex(polarity) + "; the profile's direction was measured with 0";
  if (!replied_ || reply_.data[0] != kAborted)
    return what + "cannot be read: no answer; a reversed sign would not show";
  const auto abort = get_bytes<std::uint32_t>(reply_, 4);
  drive_[axis].no_polarity = abort == kNoObject;
  return abort == kNoObject ? "" : what + "cannot be read: abort " + hex(abort) + "; a reversed sign would not show";
}

// What turns numbers into torque and angle, and their signs.
std::string Cia402Drives::check_motor(int axis, const Pause& pause) {
  const AxisProfile& a = arm_.axes[static_cast<std::size_t>(axis)];
  std::uint32_t modes = 0, turns = 1;
  if (!read(axis, kSupportedModes, modes, pause) || (modes & kTorqueModeBit) == 0)
    return axis_text(axis) + "has no cyclic synchronous torque (object 6502h, bit 9)";
  if (std::string wrong = check_polarity(axis, pause); !wrong.empty()) return wrong;
  if (!read(axis, kEncoderTurns, turns, pause) || turns == 0) turns = 1;
  std::string wrong = demand(axis, kEncoderIncrements, a.counts_per_turn * turns, "encoder increments", pause);
  if (wrong.empty())
    wrong =
        demand(axis, kRatedTorque, static_cast<double>(to_counts(a.rated_Nm, 1e-3, 32)), "rated torque in mN m", pause);
  return wrong;
}

// Mode, limits, and what makes the drive let go when the controller is gone.
std::string Cia402Drives::guard(int axis, const Pause& pause) {
  const AxisProfile& a = arm_.axes[static_cast<std::size_t>(axis)];
  const auto beat = static_cast<std::uint32_t>(1e3 * arm_.drives.watchdog_s + 0.5);
  const auto most = static_cast<std::uint32_t>(to_counts(a.torque_max_Nm / a.rated_Nm, 1e-3, 16));
  const auto period_ms = static_cast<std::uint32_t>(1e3 * period_s_ + 0.5);
  struct Setting {
    std::uint32_t object;
    int bytes;
    std::uint32_t value;
  };
  for (const Setting& s : {Setting{kMode, 1, kTorqueMode},
                           {kMaxTorque, 2, most},
                           {kPeriodValue, 1, period_ms},
                           {kPeriodExponent, 1, 0xFD},
                           {kAbortOption, 2, kAbortByFault},
                           {kConsumerHeartbeat, 4, std::uint32_t{kMasterNode} << 16 | beat}})
    if (std::string wrong = write(axis, s.object, s.bytes, s.value, pause); !wrong.empty()) {
      const bool watchdog = s.object == kConsumerHeartbeat || s.object == kAbortOption;
      return wrong + (watchdog ? ": its watchdog is off; it would push on when the controller is gone" : "");
    }
  std::uint32_t mode = 0;
  if (!read(axis, kModeDisplay, mode, pause) || mode != kTorqueMode)
    return axis_text(axis) + "stays in mode " + std::to_string(mode) + ", asked for 10";
  return "";
}

// One PDO each way, changed at every SYNC; while they are mapped they are off.
std::string Cia402Drives::map_pdos(int axis, const Pause& pause) {
  const auto node = static_cast<std::uint32_t>(drive_[axis].node);
  struct Setting {
    std::uint32_t object;
    int bytes;
    std::uint32_t value;
  };
  const std::uint32_t up = kNoRemote | (kTpdo1 + node), down = kRpdo1 + node;
  const Setting settings[] = {{kRpdoCob, 4, kPdoOff | down},
                              {kRpdoType, 1, 1},
                              {kRpdoCount, 1, 0},
                              {kRpdoCount + 1, 4, mapped(kControlword, 16)},
                              {kRpdoCount + 2, 4, mapped(kTargetTorque, 16)},
                              {kRpdoCount, 1, 2},
                              {kRpdoCob, 4, down},
                              {kTpdoCob, 4, kPdoOff | up},
                              {kTpdoType, 1, 1},
                              {kTpdoCount, 1, 0},
                              {kTpdoCount + 1, 4, mapped(kStatusword, 16)},
                              {kTpdoCount + 2, 4, mapped(kPosition, 32)},
                              {kTpdoCount, 1, 2},
                              {kTpdoCob, 4, up}};
  for (const Setting& s : settings)
    if (std::string wrong = write(axis, s.object, s.bytes, s.value, pause); !wrong.empty()) return wrong;
  return "";
}

// A period without torque, as the loop will have them. Its heartbeat is not waited for: questions come in between, and
// the drives count the time these take.
void Cia402Drives::pass_period(const Pause& pause) {
  for (int i = 0; i < pauses_in(period_s_); ++i) {
    pause();
    drain();
  }
  beat_ = static_cast<std::uint32_t>(arm_.drives.watchdog_s / period_s_);
  transmit({});
}

std::string Cia402Drives::seek_mark(int axis, const Pause& pause) {
  std::uint32_t position = 0;
  if (!read(axis, kPosition, position, pause))
    return axis_text(axis) + "does not tell its position (" + object_text(kPosition) + ")";
  drive_[axis].at_home = static_cast<std::int32_t>(position);
  std::string wrong = write(axis, kProbeFunction, 2, 0, pause);  // what it caught before is forgotten
  if (wrong.empty()) wrong = write(axis, kProbeFunction, 2, kCatchIndex, pause);
  return wrong.empty() ? "" : wrong + ": it cannot tell an index mark; use calibrate = \"home_pose\"";
}

// A mark was caught: which of those that a geared motor passes? The handle lay in its home pose, roughly, when the
// search began, which told where the mark of that pose is; whole turns from there are taken off. More than a quarter of
// a turn beside a whole one could be either neighbour's.
std::string Cia402Drives::take_mark(int axis, std::int32_t caught) {
  constexpr double kSurely_turns = 0.25;
  const AxisProfile& a = arm_.axes[static_cast<std::size_t>(axis)];
  const auto since =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(caught) - static_cast<std::uint32_t>(drive_[axis].at_home));
  const double turns = since / a.counts_per_turn + a.home_turns;
  const double whole = static_cast<double>(static_cast<std::int64_t>(turns < 0 ? turns - 0.5 : turns + 0.5));
  if (!(abs_of(turns - whole) <= kSurely_turns))
    return axis_text(axis) + "lay " + short_text(abs_of(turns - whole)) +
           " motor turns from its home pose, which leaves open which of its index marks was passed; lay the handle "
           "into "
           "that pose, start again, and only then move it";
  const auto counts = static_cast<std::int64_t>(whole * a.counts_per_turn);
  drive_[axis].origin =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(caught) - static_cast<std::uint32_t>(counts));
  return "";
}

// Encoders that count from wherever they were switched on: their count at the index mark becomes the zero. The hand
// brings each past its mark; the drive's touch probe catches the count there, so that no motor need turn.
std::string Cia402Drives::find_marks(const Pause& pause) {
  constexpr int kWait_ms = 10'000;
  bool found[kMaxAxes] = {};
  int left = count_;
  for (int ms = 0, axis = 0; ms < kWait_ms && left > 0; ms += pauses_in(period_s_) + 1, axis = (axis + 1) % count_) {
    pass_period(pause);
    std::uint32_t status = 0, position = 0;
    if (found[axis] || !read(axis, kProbeStatus, status, pause) || (status & kCaught) == 0) continue;
    if (!read(axis, kProbePosition, position, pause))
      return axis_text(axis) + "does not tell where its index mark was (object 60BAh)";
    if (std::string wrong = take_mark(axis, static_cast<std::int32_t>(position)); !wrong.empty()) return wrong;
    found[axis] = true;
    left -= 1;
  }
  std::string which;
  for (int i = 0; i < count_; ++i)
    if (!found[i]) which += (which.empty() ? "" : ", ") + std::to_string(i + 1);
  return which.empty() ? ""
                       : "the encoders of axes " + which +
                             " have not passed their index marks in 10 s: move the handle through its whole reach "
                             "while the drives are looked for";
}

std::string Cia402Drives::start(const Pause& pause) {
  if (1e3 * period_s_ != static_cast<double>(static_cast<int>(1e3 * period_s_)))
    return "CiA 402 drives take whole milliseconds as a period; bake the scene with device.period_ms = 1 or 2";
  for (int i = 0; i < count_; ++i) command_network(kPreOperational, drive_[i].node);
  pause();
  // Every drive is known before any is written to.
  for (int i = 0; i < count_; ++i) {
    if (std::string wrong = identify(i, pause); !wrong.empty()) return wrong;
    if (std::string wrong = check_motor(i, pause); !wrong.empty()) return wrong;
  }
  for (int i = 0; i < count_; ++i) {
    if (std::string wrong = guard(i, pause); !wrong.empty()) return wrong;
    if (std::string wrong = map_pdos(i, pause); !wrong.empty()) return wrong;
    if (std::string wrong = arm_.index ? seek_mark(i, pause) : ""; !wrong.empty()) return wrong;
  }
  for (int i = 0; i < count_; ++i) command_network(kStart, drive_[i].node);
  constexpr int kFirst_ms = 50;
  for (int ms = 0; ms < kFirst_ms; ms += pauses_in(period_s_)) pass_period(pause);
  for (int i = 0; i < count_; ++i) {
    drive_[i].restarted = false;
    if (!drive_[i].moved) return axis_text(i) + "sends no position at SYNC";
    if (drive_[i].state == DriveState::kFault && drive_[i].emergency != kHeartbeatLost)
      return axis_text(i) + "is in fault, emergency " + emergency_text(drive_[i].told, drive_[i].told_register);
  }
  if (arm_.index)
    if (std::string wrong = find_marks(pause); !wrong.empty()) return wrong;
  for (int i = 0; i < count_; ++i) {
    drive_[i].told = 0;
    drive_[i].late = false;
  }
  return "";
}

std::string Cia402Drives::remarks() const {
  std::string text;
  for (int i = 0; i < count_; ++i) {
    const Drive& drive = drive_[i];
    const auto add = [&](const std::string& what) { text += axis_text(i) + what + "\n"; };
    if (drive.no_polarity) add("has no polarity object (607Eh): its sign was not compared");
    if (drive.restarted) add("started anew and has lost its set-up: its supply, or its own watchdog");
    if (drive.told != 0) add("emergency " + emergency_text(drive.told, drive.told_register));
    if (drive.late)
      add("did not confirm a step to \"operation enabled\" within 0.25 s; it says \"" +
          std::string(state_name(drive.state)) + "\"");
  }
  return text;
}

bool Cia402Drives::wanted(int axis) const noexcept {
  return arm_.axes[static_cast<std::size_t>(axis)].torque_max_Nm > 0;
}

void Cia402Drives::judge(AxisSample& sample) noexcept {
  sample.flags = sample.error_code = 0;
  bool all = true, late = false;
  for (int i = 0; i < count_; ++i) {
    Drive& drive = drive_[i];
    all = all && (drive.state == DriveState::kEnabled || !wanted(i));
    const bool stays = enable_ && !was_enabled_ && wanted(i) && drive.state != DriveState::kEnabled &&
                       drive.in_state * period_s_ > kTransition_s;
    drive.late = drive.late || stays;
    late = late || stays;
    const bool fault = drive.state == DriveState::kFault || drive.state == DriveState::kFaultReaction;
    if (drive.restarted) sample.error_code = kRestarted;
    if (fault && sample.error_code == 0) sample.error_code = drive.emergency;
    // A heartbeat that failed lets go until it is enabled anew, which resets it; anything else is a fault.
    const bool resetting = enable_ && !was_enabled_;
    if (drive.restarted || (fault && drive.emergency != kHeartbeatLost)) sample.flags |= DeviceFlag::kError;
    if (fault && drive.emergency == kHeartbeatLost && !resetting) sample.flags |= DeviceFlag::kWatchdog;
  }
  if (all && enable_) sample.flags |= DeviceFlag::kEnabled;
  was_enabled_ = enable_ && (was_enabled_ || all);
  if (was_enabled_ && !all) sample.flags |= DeviceFlag::kWatchdog;
  if (late && !was_enabled_) {
    sample.flags |= DeviceFlag::kError;
    sample.error_code = kNotEnabled;
  }
}

void Cia402Drives::receive(AxisSample& sample) noexcept {
  drain();
  sample.fresh = true;
  for (int i = 0; i < count_; ++i) {
    drive_[i].in_state += 1;
    sample.fresh = sample.fresh && drive_[i].moved;
  }
  sample.received = sample.fresh ? 1 : 0;
  sample.faults = transport_.state() == TransportState::kBusOff ? std::uint32_t{Fault::kBusOff} : 0u;
  judge(sample);
  if (!sample.fresh) return;
  for (int i = 0; i < count_; ++i) {
    // Counts wrap, and so does their difference.
    const std::uint32_t from_mark =
        static_cast<std::uint32_t>(drive_[i].position) - static_cast<std::uint32_t>(drive_[i].origin);
    sample.turns[i] = static_cast<std::int32_t>(from_mark) / arm_.axes[static_cast<std::size_t>(i)].counts_per_turn;
    drive_[i].moved = false;
  }
}

// The next step of the way up; each only after the drive has said that it made the one before.
std::uint16_t Cia402Drives::controlword(const Drive& drive) const noexcept {
  if (!enable_) return kDisableVoltage;
  switch (drive.state) {
    case DriveState::kDisabled:
      return kShutdown;
    case DriveState::kReady:
      return kSwitchOn;
    case DriveState::kSwitchedOn:
    case DriveState::kEnabled:
      return kEnableOperation;
    case DriveState::kFault:
      return was_enabled_ ? kDisableVoltage : kFaultReset;  // reset by an edge of enable alone
    default:
      return kDisableVoltage;
  }
}

bool Cia402Drives::transmit(const AxisCommand& command) noexcept {
  if (command.enable != enable_) {
    enable_ = command.enable;
    was_enabled_ = false;
    for (int i = 0; i < count_; ++i) drive_[i].in_state = 0;
  }
  Frame frames[kMaxAxes + 2];
  int count = 0;
  for (; count < count_; ++count) {
    const AxisProfile& axis = arm_.axes[static_cast<std::size_t>(count)];
    Frame& frame = frames[count] = classic_frame(kRpdo1 + static_cast<std::uint32_t>(drive_[count].node), 4);
    const double torque_Nm = enable_ && was_enabled_ ? command.torque_Nm[count] : 0.0;
    put_bytes(frame, 0, wanted(count) ? controlword(drive_[count]) : kDisableVoltage);
    put_bytes(frame, 2, static_cast<std::int16_t>(to_counts(torque_Nm / axis.rated_Nm, 1e-3, 16)));
  }
  if (++beat_ * period_s_ * kBeatsPerWatchdog >= arm_.drives.watchdog_s) {
    beat_ = 0;
    frames[count] = classic_frame(kHeartbeat + kMasterNode, 1);
    frames[count++].data[0] = kOperational;
  }
  frames[count++] = classic_frame(kSync, 0);
  return send_frames(transport_, frames, count) == count;
}

}  // namespace palpate
