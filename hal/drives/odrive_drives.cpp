#include "hal/drives/odrive_drives.h"

#include <cstring>

#include "hal/device/device.h"
#include "hal/device/profile_key.h"
#include "hal/drives/frame_bytes.h"
#include "rt_core/status.h"

namespace palpate {
namespace {

using namespace odrive;

constexpr int kHeartbeatWait_ms = 500;  // a drive's default is 100
constexpr int kAnswerWait_ms = 100;
constexpr int kEnableFrames = 3, kDisableFrames = 1;  // of each axis
constexpr int kDisableAtOnce = 2;                     // a period: six axes within the five commands that end a run
constexpr double kEnableTimeout_s = 0.5;              // heartbeats of 100 ms, and the current loop's start
constexpr double kSilent_s = 0.1;                     // above any silence that passes by itself
constexpr double kSilentAlone_s = 0.01;               // while others speak: no cable does that

Frame make(int node, Message message, int length) noexcept { return classic_frame(frame_id(node, message), length); }

Frame remote(int node, Message message) noexcept {
  Frame frame = make(node, message, 0);
  frame.remote = true;
  return frame;
}

Frame state_frame(int node, State state) noexcept {
  Frame frame = make(node, kSetAxisState, 4);
  put_bytes<std::uint32_t>(frame, 0, state);
  return frame;
}

Frame mode_frame(int node) noexcept {
  Frame frame = make(node, kSetControllerMode, 8);
  put_bytes(frame, 0, kTorqueControl);
  put_bytes(frame, 4, kPassthrough);
  return frame;
}

Frame torque_frame(int node, double torque_Nm) noexcept {
  Frame frame = make(node, kSetInputTorque, 4);
  put_bytes(frame, 0, static_cast<float>(torque_Nm));
  return frame;
}

Frame sdo_frame(int node, std::uint8_t opcode, double endpoint, int bytes) noexcept {
  Frame frame = make(node, kRxSdo, 4 + bytes);
  put_bytes(frame, 0, opcode);
  put_bytes(frame, 1, static_cast<std::uint16_t>(endpoint));
  return frame;
}

std::string error_text(std::uint32_t error) {
  char text[32];
  std::snprintf(text, sizeof text, "0x%X", error);
  const char* meaning = "";
  if ((error & kMissingEstimate) != 0) meaning = " (no position estimate: calibrate its encoder)";
  if ((error & kUnderVoltage) != 0) meaning = " (supply voltage too low)";
  if ((error & kMotorOverTemperature) != 0) meaning = " (motor too hot)";
  if ((error & kEstopRequested) != 0) meaning = " (emergency stop)";
  return text + std::string(meaning);
}

}  // namespace

ODriveDrives::ODriveDrives(Transport& transport, const ArmProfile& arm, double period_s) noexcept
    : transport_(transport), arm_(arm), period_s_(period_s), count_(joint_count(arm.linkage)) {
  for (int i = 0; i < count_; ++i) drive_[i].node = static_cast<int>(arm.axes[static_cast<std::size_t>(i)].node);
}

std::string ODriveDrives::axis_text(int axis) const {
  return "axis " + std::to_string(axis + 1) + " (ODrive node " + std::to_string(drive_[axis].node) + "): ";
}

void ODriveDrives::take(const Frame& frame) noexcept {
  if (frame.fd || frame.remote) return;
  for (int i = 0; i < count_; ++i) {
    Drive& drive = drive_[i];
    if (frame.id >> 5 != static_cast<std::uint32_t>(drive.node)) continue;
    if (frame.id == awaited_id_ && i == awaiting_) {
      drive.answer = frame;
      drive.answered = true;
    }
    const std::uint32_t command = frame.id & kMessageMask;
    if (command == kHeartbeat && frame.length >= 5) {
      drive.error = get_bytes<std::uint32_t>(frame, 0);
      if (drive.error != 0) drive.told = drive.error;
      drive.state = get_bytes<std::uint8_t>(frame, 4);
      drive.heard = true;
    } else if (command == kGetEncoderEstimates && frame.length == 8) {
      const double turns = static_cast<double>(get_bytes<float>(frame, 0));
      if (!is_finite(turns)) return;
      drive.turns = turns;
      drive.estimates += 1;
      drive.moved = true;
    }
  }
}

void ODriveDrives::drain() noexcept {
  take_frames(transport_, [this](const Frame& frame) noexcept { take(frame); });
}

// Sends the question until an answer comes.
bool ODriveDrives::ask(int axis, const Frame& question, Message reply, const Pause& pause) {
  awaited_id_ = frame_id(drive_[axis].node, reply);
  awaiting_ = axis;
  drive_[axis].answered = false;
  for (int ms = 0; ms < kAnswerWait_ms && !drive_[axis].answered; ++ms) {
    if (ms % 20 == 0) send_frames(transport_, &question, 1);
    pause();
    drain();
  }
  awaited_id_ = 0;
  return drive_[axis].answered;
}

bool ODriveDrives::read_endpoint(int axis, double endpoint, const Pause& pause) {
  const bool came = ask(axis, sdo_frame(drive_[axis].node, kRead, endpoint, 0), kTxSdo, pause);
  return came && get_bytes<std::uint16_t>(drive_[axis].answer, 1) == static_cast<std::uint16_t>(endpoint);
}

void ODriveDrives::write_endpoint(int axis, double endpoint, const void* value, int bytes) {
  Frame frame = sdo_frame(drive_[axis].node, kWrite, endpoint, bytes);
  std::memcpy(frame.data + 4, value, static_cast<std::size_t>(bytes));
  send_frames(transport_, &frame, 1);
}

std::string ODriveDrives::find_all(const Pause& pause) {
  for (int ms = 0; ms < kHeartbeatWait_ms; ++ms) {
    pause();
    drain();
  }
  for (int i = 0; i < count_; ++i)
    if (!drive_[i].heard)
      return axis_text(i) +
             "no heartbeat in 0.5 s; is it powered, is its node_id that of the profile, the bit rate right, the bus "
             "terminated?";
  return "";
}

// Which drive answers, and with which firmware: the numbers of endpoints hold for that one alone.
std::string ODriveDrives::identify(int axis, const Pause& pause) {
  const int node = drive_[axis].node;
  if (!ask(axis, remote(node, kGetVersion), kGetVersion, pause) || drive_[axis].answer.length < 7)
    return axis_text(axis) + "does not tell its version";
  const Frame& version = drive_[axis].answer;
  const std::string firmware =
      std::to_string(version.data[4]) + "." + std::to_string(version.data[5]) + "." + std::to_string(version.data[6]);
  if (firmware != arm_.firmware)
    return axis_text(axis) + "has firmware " + firmware + ", the profile is written for " + arm_.firmware +
           "; its endpoints differ by version: look them up and state both";
  if (!ask(axis, remote(node, kAddress), kAddress, pause) || drive_[axis].answer.length < 7)
    return axis_text(axis) + "does not tell its serial number";
  const double serial = static_cast<double>(get_bytes<std::uint64_t>(drive_[axis].answer, 1) & 0xFFFFFFFFFFFFull);
  if (serial == arm_.axes[static_cast<std::size_t>(axis)].serial) return "";
  char found[32];
  std::snprintf(found, sizeof found, "%.0f", serial);
  for (int i = 0; i < count_; ++i)
    if (serial == arm_.axes[static_cast<std::size_t>(i)].serial)
      return axis_text(axis) + "serial number " + found + " is that of axis " + std::to_string(i + 1) +
             ": the axes are swapped";
  return axis_text(axis) + "serial number " + found +
         " is not that of the profile: another drive than the one measured";
}

// Idle, without errors, counting the right way round, and with a watchdog that was read back.
std::string ODriveDrives::prepare(int axis, const Pause& pause) {
  const DrivesProfile& p = arm_.drives;
  const int node = drive_[axis].node;
  if (!read_endpoint(axis, p.endpoint_direction, pause)) return axis_text(axis) + "endpoint_direction cannot be read";
  if (!(get_bytes<float>(drive_[axis].answer, 4) > 0))
    return axis_text(axis) +
           "its position mapper is reversed (scale below 0); the profile's direction was measured with a positive one";
  const auto wanted_s = static_cast<float>(p.watchdog_s);
  const std::uint8_t on = 1;
  write_endpoint(axis, p.endpoint_watchdog_s, &wanted_s, sizeof wanted_s);
  write_endpoint(axis, p.endpoint_watchdog, &on, sizeof on);
  if (!read_endpoint(axis, p.endpoint_watchdog_s, pause) || get_bytes<float>(drive_[axis].answer, 4) != wanted_s)
    return axis_text(axis) + "its watchdog's time cannot be set to " + short_text(1e3 * p.watchdog_s) + " ms";
  if (!read_endpoint(axis, p.endpoint_watchdog, pause) || drive_[axis].answer.data[4] != 1)
    return axis_text(axis) + "its watchdog stays disabled: it would push on when commands stop";
  const Frame quiet[] = {state_frame(node, kIdle), torque_frame(node, 0), make(node, kClearErrors, 1)};
  send_frames(transport_, quiet, 3);
  return "";
}

// Positions once a period of each axis, and no error left.
std::string ODriveDrives::watch_rate(const Pause& pause) {
  constexpr int kWatched_ms = 200;
  std::uint32_t before[kMaxAxes];
  for (int i = 0; i < count_; ++i) before[i] = drive_[i].estimates;
  for (int ms = 0; ms < kWatched_ms; ++ms) {
    for (int i = 0; i < count_ && ms % pauses_in(period_s_) == 0; ++i) {  // keeps the watchdogs content
      const Frame zero = torque_frame(drive_[i].node, 0), clear = make(drive_[i].node, kClearErrors, 1);
      send_frames(transport_, &zero, 1);
      // They may have expired while the others were asked.
      if (ms == pauses_in(period_s_)) send_frames(transport_, &clear, 1);
    }
    pause();
    drain();
  }
  for (int i = 0; i < count_; ++i) {
    const double rate_Hz = (drive_[i].estimates - before[i]) / (1e-3 * kWatched_ms);
    if (rate_Hz < 0.9 / period_s_)
      return axis_text(i) + "positions come " + short_text(rate_Hz) + " times a second, needed are " +
             short_text(1 / period_s_) + ": set its encoder_msg_rate_ms";
    if (drive_[i].error != 0) return axis_text(i) + "reports error " + error_text(drive_[i].error);
    if (drive_[i].state != kIdle)
      return axis_text(i) + "is in state " + std::to_string(drive_[i].state) + ", not idle; something else drives it";
  }
  return "";
}

std::string ODriveDrives::start(const Pause& pause) {
  if (std::string wrong = find_all(pause); !wrong.empty()) return wrong;
  // Every drive is known before any is written to.
  for (int i = 0; i < count_; ++i)
    if (std::string wrong = identify(i, pause); !wrong.empty()) return wrong;
  for (int i = 0; i < count_; ++i)
    if (std::string wrong = prepare(i, pause); !wrong.empty()) return wrong;
  std::string wrong = watch_rate(pause);
  for (Drive& drive : drive_) drive.silent = 0, drive.told = 0;
  restarted_ = false;
  return wrong;
}

std::string ODriveDrives::remarks() const {
  std::string text;
  for (int i = 0; i < count_; ++i)
    if (drive_[i].told != 0) text += axis_text(i) + "reported error " + error_text(drive_[i].told) + "\n";
  return text;
}

void ODriveDrives::judge(AxisSample& sample) noexcept {
  sample.flags = sample.error_code = 0;
  bool all = !enable_ || setup_ >= count_ * kEnableFrames, others_speak = false;
  for (int i = 0; i < count_; ++i) others_speak = others_speak || drive_[i].silent == 0;
  for (int i = 0; i < count_; ++i) {
    Drive& drive = drive_[i];
    const bool may_move = arm_.axes[static_cast<std::size_t>(i)].torque_max_Nm > 0;
    all = all && (drive.state == kClosedLoop || !may_move);
    // One that lets go by itself says why.
    const bool left = was_enabled_ && may_move && drive.state != kClosedLoop && drive.error == 0;
    restarted_ = restarted_ || left || drive.silent * period_s_ > (others_speak ? kSilentAlone_s : kSilent_s);
    if (drive.error == 0) continue;
    if (sample.error_code == 0) sample.error_code = drive.error;
    if ((drive.error & kEstopRequested) != 0) {
      sample.flags |= DeviceFlag::kStopButton;
    } else {
      // An expired watchdog lets go until it is enabled anew; anything else is a fault. While that goes on, heartbeats
      // still tell of the old one.
      const bool enabling = enable_ && !was_enabled_;
      if (drive.error != kWatchdogExpired) sample.flags |= DeviceFlag::kError;
      if (drive.error == kWatchdogExpired && !enabling) sample.flags |= DeviceFlag::kWatchdog;
    }
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
    sample.error_code = kNotEnabled;
  }
}

// Drives send unasked, each by its own clock: one whose position is still under way is taken where it was a period
// before. Otherwise three that slip past the loop's slots at once, with jitter, leave too few whole sets.
void ODriveDrives::receive(AxisSample& sample) noexcept {
  constexpr std::uint32_t kOldest = 1;
  drain();
  bool any = false, recent = true;
  for (int i = 0; i < count_; ++i) {
    Drive& drive = drive_[i];
    drive.silent = drive.moved ? 0 : drive.silent + 1;
    any = any || drive.moved;
    recent = recent && drive.silent <= kOldest;
    drive.moved = false;
  }
  sample.fresh = any && recent;
  sample.received = sample.fresh ? 1 : 0;
  sample.faults = transport_.state() == TransportState::kBusOff ? std::uint32_t{Fault::kBusOff} : 0u;
  judge(sample);
  for (int i = 0; i < count_ && sample.fresh; ++i) sample.turns[i] = drive_[i].turns;
}

// Enabling: for each axis its errors cleared, its mode, its state; disabling: its state.
Frame ODriveDrives::next_setup() noexcept {
  const int each = enable_ ? kEnableFrames : kDisableFrames;
  const int axis = setup_ / each, step = setup_ % each;
  const int node = drive_[axis].node;
  setup_ += 1;
  if (!enable_) return state_frame(node, kIdle);
  if (step == 0) return make(node, kClearErrors, 1);
  return step == 1 ? mode_frame(node) : state_frame(node, kClosedLoop);
}

bool ODriveDrives::transmit(const AxisCommand& command) noexcept {
  if (const bool enable = command.enable && !restarted_; enable != enable_) {
    enable_ = enable;
    was_enabled_ = false;
    setup_ = 0;
    waited_ = 0;
  }
  waited_ += 1;
  Frame frames[kMaxAxes + kDisableAtOnce];
  int count = 0;
  for (; count < count_; ++count) {
    const double torque_Nm = enable_ && was_enabled_ ? command.torque_Nm[count] : 0.0;
    frames[count] = torque_frame(drive_[count].node, is_finite(torque_Nm) ? torque_Nm : 0.0);
  }
  const int due = count_ * (enable_ ? kEnableFrames : kDisableFrames);
  for (int i = 0; i < (enable_ ? 1 : kDisableAtOnce) && setup_ < due; ++i) {
    frames[count++] = next_setup();
    // What heartbeats told before is of another enabling.
    for (int k = 0; k < count_ && enable_ && setup_ == due; ++k) drive_[k].state = 0;
  }
  return send_frames(transport_, frames, count) == count;
}

}  // namespace palpate
