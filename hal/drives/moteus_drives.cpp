#include "hal/drives/moteus_drives.h"

#include <cmath>
#include <cstring>
#include <string_view>

#include "hal/device/device.h"
#include "hal/device/profile_key.h"
#include "hal/drives/frame_bytes.h"
#include "rt_core/status.h"

namespace palpate {
namespace {

using namespace moteus;

constexpr int kFindWait_ms = 500;
constexpr int kAnswerWait_ms = 100;
constexpr double kEnableTimeout_s = 0.5;
constexpr double kSilent_s = 0.1;        // above any silence that passes by itself
constexpr double kSilentAlone_s = 0.01;  // while others answer: no cable does that

// What every answer tells: mode and position as floats (one sub-frame), the fault code.
void ask_state(Writer& writer) noexcept {
  writer.read(Type::kFloat, kMode, 2);
  writer.read(Type::kInt8, kFault, 1);
}

std::string fault_text(int fault) {
  const char* meaning = "";
  if (fault == 32) meaning = " (calibration)";
  if (fault == 33 || fault == 40) meaning = " (motor driver: most often the supply is too low)";
  if (fault == 35) meaning = " (encoder)";
  if (fault == 36) meaning = " (motor not configured: moteus_tool --calibrate)";
  if (fault == 38) meaning = " (too hot)";
  if (fault == 39) meaning = " (outside servopos.position_min and position_max)";
  return std::to_string(fault) + meaning;
}

std::string version_text(double firmware) {
  const auto word = static_cast<std::uint32_t>(firmware);
  return std::to_string(word >> 16) + "." + std::to_string(word >> 8 & 0xFF) + "." + std::to_string(word & 0xFF);
}

// The lowest 48 bits of 96: a double holds them, and no two of one maker's chips share them.
double serial_of(const double (&words)[3]) {
  const auto low = static_cast<std::uint32_t>(static_cast<std::int64_t>(words[0]));
  const auto next = static_cast<std::uint32_t>(static_cast<std::int64_t>(words[1]));
  return static_cast<double>(static_cast<std::uint64_t>(next & 0xFFFF) << 32 | low);
}

}  // namespace

MoteusDrives::MoteusDrives(Transport& transport, const ArmProfile& arm, double period_s) noexcept
    : transport_(transport), arm_(arm), period_s_(period_s), count_(joint_count(arm.linkage)) {
  transport.accept_extended();
  for (int i = 0; i < count_; ++i) drive_[i].node = static_cast<int>(arm.axes[static_cast<std::size_t>(i)].node);
}

std::string MoteusDrives::axis_text(int axis) const {
  return "axis " + std::to_string(axis + 1) + " (moteus id " + std::to_string(drive_[axis].node) + "): ";
}

void MoteusDrives::apply(Drive& drive, const Part& part) const noexcept {
  const int room = static_cast<int>(sizeof drive.text) - drive.text_bytes;
  if (part.kind == kFromServer && starting_ && part.count <= room) {
    std::memcpy(drive.text + drive.text_bytes, part.bytes, static_cast<std::size_t>(part.count));
    drive.text_bytes += part.count;
  }
  if (part.kind != kReply) return;
  for (int i = 0; i < part.count; ++i) {
    const std::uint32_t reg = part.first + static_cast<std::uint32_t>(i);
    const double value = part.number(i);
    if (!is_finite(value)) continue;
    if (reg == kMode) drive.mode = static_cast<int>(clamp_to(value, -1, 255));
    if (reg == kFault) drive.fault = static_cast<int>(clamp_to(value, -128, 255));
    if (reg == kPosition) {
      drive.turns = value;
      drive.silent = 0;
      drive.moved = true;
    }
    if (reg == kModel) drive.model = value;
    if (reg == kFirmware) drive.firmware = value;
    if (reg == kRegisterMap) drive.map = value;
    drive.known = drive.known || reg == kRegisterMap;
    if (reg >= kSerial && reg < kSerial + 3) drive.serial[reg - kSerial] = value;
    drive.numbered = drive.numbered || reg == kSerial + 2;
    if (reg == kTimeout) drive.timeout_s = value;
    drive.timed = drive.timed || reg == kTimeout;
  }
}

// A frame that is malformed anywhere is used nowhere.
void MoteusDrives::take(const Frame& frame) noexcept {
  if (!frame.fd || frame.remote) return;
  for (int i = 0; i < count_; ++i) {
    if (frame.id != reply_id(drive_[i].node)) continue;
    Part part;
    Reader check(frame);
    while (check.next(part)) {
    }
    if (check.malformed()) return;
    Reader reader(frame);
    while (reader.next(part)) apply(drive_[i], part);
    drive_[i].replies += 1;
  }
}

void MoteusDrives::drain() noexcept {
  take_frames(transport_, [this](const Frame& frame) noexcept { take(frame); });
}

Frame MoteusDrives::stop_frame(int axis) const noexcept {
  Writer writer(request_id(drive_[axis].node));
  writer.write(Type::kInt8, kMode, static_cast<std::int8_t>(kStopped));
  ask_state(writer);
  return writer.finish();
}

// 31 bytes of 32. The place to hold is "where it is" (the least number stands for none), its loops' gains are zero.
Frame MoteusDrives::torque_frame(int axis, double torque_Nm) const noexcept {
  constexpr auto kNone8 = std::numeric_limits<std::int8_t>::min();
  constexpr auto kNone16 = std::numeric_limits<std::int16_t>::min();
  const double most_Nm = arm_.axes[static_cast<std::size_t>(axis)].torque_max_Nm;
  const double most_cNm = min_of(100 * most_Nm + 0.999999, 32767);  // rounded up to its step of 0.01 N m
  Writer writer(request_id(drive_[axis].node));
  writer.write(Type::kInt8, kMode, static_cast<std::int8_t>(kPositionMode));
  writer.write(Type::kInt8, kCommandPosition, kNone8);
  writer.write(Type::kFloat, kFeedforward, static_cast<float>(torque_Nm));
  writer.head(kWrite, Type::kInt8, kKpScale, 2);
  writer.value(std::int8_t{0}), writer.value(std::int8_t{0});
  writer.head(kWrite, Type::kInt16, kMaxTorque, 3);
  writer.value(static_cast<std::int16_t>(most_cNm));
  writer.value(kNone16);
  writer.value(static_cast<std::int16_t>(1e3 * arm_.drives.watchdog_s + 0.5));
  writer.write(Type::kInt8, kIlimitScale, std::int8_t{0});
  ask_state(writer);
  return writer.finish();
}

// Sends the question until what is wanted has been told.
template <class Done>
bool MoteusDrives::ask(int axis, const Frame& question, const Pause& pause, const Done& done) {
  for (int ms = 0; ms < kAnswerWait_ms; ++ms) {
    if (ms % 20 == 0) send_frames(transport_, &question, 1);
    pause();
    drain();
    if (done(drive_[axis])) return true;
  }
  return false;
}

// The first line that a line in the diagnostic stream is answered with; "" if none came.
std::string MoteusDrives::tell(int axis, const std::string& line, const Pause& pause) {
  constexpr int kMostBytes = 48;  // of an answer's frame
  Writer said(request_id(drive_[axis].node)), poll(request_id(drive_[axis].node));
  said.text(kToServer, (line + "\n").c_str(), static_cast<int>(line.size()) + 1);
  poll.byte(kPollServer), poll.byte(kDiagnosticChannel), poll.byte(kMostBytes);
  const Frame command = said.finish(), question = poll.finish();
  const auto heard = [](const Drive& drive) {
    return std::string_view(drive.text, static_cast<std::size_t>(drive.text_bytes));
  };
  drive_[axis].text_bytes = 0;
  send_frames(transport_, &command, 1);
  ask(axis, question, pause, [&](const Drive& drive) { return heard(drive).find('\n') != std::string_view::npos; });
  return std::string(heard(drive_[axis]).substr(0, heard(drive_[axis]).find_first_of("\r\n")));
}

std::string MoteusDrives::find_all(const Pause& pause) {
  bool all = false;
  for (int ms = 0; ms < kFindWait_ms && !all; ++ms) {
    all = true;
    for (int i = 0; i < count_; ++i) {
      Writer writer(request_id(drive_[i].node));
      ask_state(writer);
      if (drive_[i].replies == 0 && ms % 20 == 0) send_frames(transport_, &writer.finish(), 1);
    }
    pause();
    drain();
    for (int i = 0; i < count_; ++i) all = all && drive_[i].replies > 0;
  }
  for (int i = 0; i < count_; ++i)
    if (drive_[i].replies == 0)
      return axis_text(i) +
             "no answer in 0.5 s; is it powered, is its id.id that of the profile, the bus 1 and 5 Mbit/s CAN FD and "
             "terminated?";
  return "";
}

std::string MoteusDrives::identify(int axis, const Pause& pause) {
  Writer what(request_id(drive_[axis].node)), who(request_id(drive_[axis].node));
  what.read(Type::kInt32, kModel, 3);
  who.read(Type::kInt32, kSerial, 3);
  if (!ask(axis, what.finish(), pause, [](const Drive& drive) { return drive.known; }))
    return axis_text(axis) + "does not tell its version";
  const Drive& drive = drive_[axis];
  if (drive.map != kMapVersion)
    return axis_text(axis) + "its registers are of version " + short_text(drive.map) + ", this driver speaks " +
           std::to_string(kMapVersion) + ": change its firmware";
  if (const std::string found = version_text(drive.firmware); found != arm_.firmware)
    return axis_text(axis) + "has firmware " + found + ", the profile is written for " + arm_.firmware;
  if (!ask(axis, who.finish(), pause, [](const Drive& d) { return d.numbered; }))
    return axis_text(axis) + "does not tell its serial number";
  const double serial = serial_of(drive.serial);
  if (serial == arm_.axes[static_cast<std::size_t>(axis)].serial) return "";
  char found[32];
  std::snprintf(found, sizeof found, "%.0f", serial);
  for (int i = 0; i < count_; ++i)
    if (serial == arm_.axes[static_cast<std::size_t>(i)].serial)
      return axis_text(axis) + "serial number " + found + " is that of axis " + std::to_string(i + 1) +
             ": the axes are swapped";
  return axis_text(axis) + "serial number " + found +
         " (its lowest 48 bits) is not that of the profile: another drive than the one measured";
}

// Stopped, counting the right way round, and letting go when commands stop: its default is to brake, which a hand
// feels.
std::string MoteusDrives::prepare(int axis, const Pause& pause) {
  const Frame stop = stop_frame(axis);
  send_frames(transport_, &stop, 1);
  if (const std::string sign = tell(axis, "conf get motor_position.output.sign", pause); sign != "1")
    return axis_text(axis) + "motor_position.output.sign is '" + sign +
           "', not 1; the profile's direction was measured with 1";
  tell(axis, "conf set servo.timeout_mode 0", pause);
  if (const std::string mode = tell(axis, "conf get servo.timeout_mode", pause); mode != "0")
    return axis_text(axis) + "servo.timeout_mode is '" + mode + "' and cannot be set to 0: it would brake, not let go";
  Writer writer(request_id(drive_[axis].node));
  writer.write(Type::kInt8, kMode, static_cast<std::int8_t>(kStopped));
  writer.write(Type::kFloat, kTimeout, static_cast<float>(arm_.drives.watchdog_s));
  writer.read(Type::kFloat, kTimeout, 1);
  drive_[axis].timed = false;
  const bool came = ask(axis, writer.finish(), pause, [](const Drive& drive) { return drive.timed; });
  if (!came || std::abs(drive_[axis].timeout_s - arm_.drives.watchdog_s) > 1e-6)
    return axis_text(axis) + "its watchdog's time cannot be set to " + short_text(1e3 * arm_.drives.watchdog_s) + " ms";
  return "";
}

// An answer once a period of each axis, stopped and without a fault.
std::string MoteusDrives::watch_rate(const Pause& pause) {
  constexpr int kWatched_ms = 200;
  std::uint32_t before[kMaxAxes];
  for (int i = 0; i < count_; ++i) before[i] = drive_[i].replies;
  int asked = 0;
  for (int ms = 0; ms < kWatched_ms; ++ms) {
    const bool due = ms % pauses_in(period_s_) == 0;
    asked += due;
    for (int i = 0; i < count_ && due; ++i) {
      const Frame stop = stop_frame(i);
      send_frames(transport_, &stop, 1);
    }
    pause();
    drain();
  }
  for (int i = 0; i < count_; ++i) {
    const double share = (drive_[i].replies - before[i]) / static_cast<double>(asked);
    if (share < 0.9)
      return axis_text(i) + "answers " + short_text(100 * share) + " of 100 questions: bus load, termination, cable";
    if (drive_[i].mode == kFaulted) return axis_text(i) + "reports fault " + fault_text(drive_[i].fault);
    if (drive_[i].mode != kStopped)
      return axis_text(i) + "is in mode " + std::to_string(drive_[i].mode) + ", not stopped; something else drives it";
  }
  return "";
}

std::string MoteusDrives::start(const Pause& pause) {
  starting_ = true;
  std::string wrong = find_all(pause);
  // Every drive is known before any is written to.
  for (int i = 0; i < count_ && wrong.empty(); ++i) wrong = identify(i, pause);
  for (int i = 0; i < count_ && wrong.empty(); ++i) wrong = prepare(i, pause);
  if (wrong.empty()) wrong = watch_rate(pause);
  starting_ = false;
  for (Drive& drive : drive_) drive.silent = 0;
  restarted_ = false;
  return wrong;
}

std::string MoteusDrives::remarks() const {
  std::string text;
  for (int i = 0; i < count_; ++i)
    if (drive_[i].told != 0) text += axis_text(i) + "reported fault " + fault_text(drive_[i].told) + "\n";
  return text;
}

void MoteusDrives::judge(AxisSample& sample) noexcept {
  sample.flags = sample.error_code = 0;
  bool all = true, others_answer = false;
  for (int i = 0; i < count_; ++i) others_answer = others_answer || drive_[i].silent == 0;
  for (int i = 0; i < count_; ++i) {
    Drive& drive = drive_[i];
    all = all && (drive.mode == kPositionMode || !may_move(i));
    restarted_ = restarted_ || (was_enabled_ && may_move(i) && drive.mode == kStopped) ||
                 drive.silent * period_s_ > (others_answer ? kSilentAlone_s : kSilent_s);
    const bool enabling = enable_ && !was_enabled_;
    if (drive.mode == kTimedOut && !enabling) sample.flags |= DeviceFlag::kWatchdog;
    // Enabling stops it first, which clears a fault: until that was answered, an old one is told.
    if (drive.mode != kFaulted || (enabling && waited_ * period_s_ <= kEnableTimeout_s)) continue;
    sample.flags |= DeviceFlag::kError;
    drive.told = drive.fault;
    if (sample.error_code == 0) sample.error_code = static_cast<std::uint32_t>(drive.fault);
  }
  if (restarted_) {
    sample.flags |= DeviceFlag::kError;
    sample.error_code = kRestarted;
  }
  if (all && enable_) sample.flags |= DeviceFlag::kEnabled;
  was_enabled_ = enable_ && (was_enabled_ || all);
  if (was_enabled_ && !all) sample.flags |= DeviceFlag::kWatchdog;
  if (enable_ && !was_enabled_ && waited_ * period_s_ > kEnableTimeout_s) {
    sample.flags |= DeviceFlag::kError;
    if (sample.error_code == 0) sample.error_code = kNotEnabled;
  }
}

void MoteusDrives::receive(AxisSample& sample) noexcept {
  drain();
  sample.fresh = true;
  for (int i = 0; i < count_; ++i) {
    drive_[i].silent += drive_[i].moved ? 0 : 1;
    sample.fresh = sample.fresh && drive_[i].moved;
  }
  sample.received = sample.fresh ? 1 : 0;
  sample.faults = transport_.state() == TransportState::kBusOff ? std::uint32_t{Fault::kBusOff} : 0u;
  judge(sample);
  if (!sample.fresh) return;
  for (int i = 0; i < count_; ++i) {
    sample.turns[i] = drive_[i].turns;
    drive_[i].moved = false;
  }
}

// One frame an axis: stopped, or (after a stop, which clears what was before) a torque, zero until all are ready.
bool MoteusDrives::transmit(const AxisCommand& command) noexcept {
  constexpr std::uint32_t kStops = 2;
  if (const bool enable = command.enable && !restarted_; enable != enable_) {
    enable_ = enable;
    was_enabled_ = false;
    waited_ = 0;
  }
  waited_ += 1;
  Frame frames[kMaxAxes];
  for (int i = 0; i < count_; ++i) {
    const double torque_Nm = was_enabled_ && is_finite(command.torque_Nm[i]) ? command.torque_Nm[i] : 0.0;
    frames[i] = enable_ && may_move(i) && waited_ > kStops ? torque_frame(i, torque_Nm) : stop_frame(i);
  }
  return send_frames(transport_, frames, count_) == count_;
}

}  // namespace palpate
