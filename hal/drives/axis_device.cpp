#include "hal/drives/axis_device.h"

#include <cstdio>

#include "hal/drives/axis_map.h"
#include "rt_core/math.h"

namespace palpate {

AxisDevice::AxisDevice(AxisDrives& drives, const ArmProfile& arm, const CartesianKinematics& frame,
                       double period_s) noexcept
    : drives_(drives),
      arm_(arm),
      back_(conjugate(frame.orientation_w)),
      period_s_(period_s),
      share_per_tick_(0.1 * 1e3 * period_s),
      count_(joint_count(arm.linkage)),
      turns_handle_(arm.linkage.gimbal) {
  for (int i = arm_joint_count(arm.linkage); i < count_; ++i)
    turns_handle_ = turns_handle_ && arm.axes[static_cast<std::size_t>(i)].torque_max_Nm > 0;
}

std::string AxisDevice::find(const AxisDrives::Pause& pause) {
  if (std::string wrong = drives_.start(pause); !wrong.empty()) return wrong;
  return find_home(pause);
}

std::string AxisDevice::start(const AxisDrives::Pause& pause) {
  std::string wrong = find(pause);
  return wrong.empty() ? beyond_limits() : wrong;
}

// Of where the joints are now.
std::string AxisDevice::beyond_limits() const {
  for (int i = 0; i < count_; ++i) {
    const AxisProfile& axis = arm_.axes[static_cast<std::size_t>(i)];
    if (joint_[i] >= axis.lowest && joint_[i] <= axis.highest) continue;
    const bool slide = axis.travel_m > 0;
    const double unit = slide ? 1e-3 : kPi / 180;
    char text[160];
    std::snprintf(text, sizeof text, "axis %d stands at %.4g %s, its limits are %.4g to %.4g: ", i + 1,
                  joint_[i] / unit, slide ? "mm" : "degrees", axis.lowest / unit, axis.highest / unit);
    return text + std::string(
                      "bring the handle within them and start again; if it is, home, direction or ratio are "
                      "wrong or axes are swapped: palpate device-test ADDRESS --profile FILE --move");
  }
  return "";
}

// A tenth of a second of positions: there must be some, and in the home pose the handle must lie still.
std::string AxisDevice::find_home(const AxisDrives::Pause& pause) {
  constexpr int kWatched_ms = 100;
  constexpr double kStill_rad = 0.01;
  double lowest[kMaxAxes] = {}, highest[kMaxAxes] = {};
  int samples = 0;
  for (int ms = 0; ms < kWatched_ms; ++ms) {
    pause();
    if (ms % pauses_in(period_s_) == 0) drives_.transmit({});
    drives_.receive(axes_);
    if (!axes_.fresh) continue;
    for (int i = 0; i < count_; ++i) {
      lowest[i] = samples == 0 ? axes_.turns[i] : min_of(lowest[i], axes_.turns[i]);
      highest[i] = samples == 0 ? axes_.turns[i] : max_of(highest[i], axes_.turns[i]);
    }
    samples += 1;
  }
  if (samples == 0) return "the drives sent no positions of all axes within 0.1 s";
  for (int i = 0; i < count_; ++i) {
    const AxisProfile& axis = arm_.axes[static_cast<std::size_t>(i)];
    const double moved = (highest[i] - lowest[i]) * abs_of(joint_per_turn(axis));
    if (arm_.home_pose && !(moved < kStill_rad))
      return "axis " + std::to_string(i + 1) +
             " moved while its home was taken: lay the handle into its home pose and start again";
    home_turns_[i] = arm_.home_pose ? axes_.turns[i] : axis.home_turns;
    turns_[i] = axes_.turns[i];
  }
  locate();
  return "";
}

// Joints and pose of the newest positions.
void AxisDevice::locate() noexcept {
  within_limits_ = true;
  for (int i = 0; i < count_; ++i) {
    const AxisProfile& axis = arm_.axes[static_cast<std::size_t>(i)];
    joint_[i] = axis.home_joint + joint_per_turn(axis) * (axes_.turns[i] - home_turns_[i]);
    within_limits_ = within_limits_ && joint_[i] >= axis.lowest && joint_[i] <= axis.highest;
  }
  state_ = linkage_at(arm_.linkage, joint_);
  within_limits_ = within_limits_ && state_.place == LinkagePlace::kGood;
}

// An encoder's counts come one at a time: over 5 ms they make a speed. No number, or one beyond all bounds, is none.
void AxisDevice::observe_speeds() noexcept {
  constexpr double kSmoothed_s = 5e-3;
  const double elapsed_s = periods_ * period_s_, share = elapsed_s / (elapsed_s + kSmoothed_s);
  for (int i = 0; i < count_; ++i) {
    const double speed = (axes_.turns[i] - turns_[i]) / elapsed_s;
    speed_[i] = is_finite(speed) ? speed_[i] + share * (speed - speed_[i]) : 0.0;
    turns_[i] = axes_.turns[i];
  }
}

// Torque of the motor against its own Coulomb friction f: kFrictionShare of it at most, whatever the speed told. At the
// true speed v friction takes f |v| and this gives kFrictionShare f |v| at most, so the two together never give energy,
// and a motor at rest is held by more than this pushes with: neither delay nor noise of the speed can make the handle
// move by itself. Around rest, where the speed is the encoder's steps and would make it buzz, it grows with the speed.
double AxisDevice::against_friction_Nm(int axis) const noexcept {
  constexpr double kFull_counts_per_s = 500;
  const AxisProfile& a = arm_.axes[static_cast<std::size_t>(axis)];
  if (!(a.friction_Nm > 0)) return 0;
  return kFrictionShare * a.friction_Nm * clamp_to(speed_[axis] * a.counts_per_turn / kFull_counts_per_s, -1, 1);
}

void AxisDevice::receive(DeviceSample& sample) noexcept {
  drives_.receive(axes_);
  periods_ += 1;
  sample_.fresh = axes_.fresh;
  sample_.received = axes_.received;
  sample_.faults = axes_.faults;
  sample_.buttons = axes_.buttons;
  if (axes_.fresh) {
    observe_speeds();
    periods_ = 0;
    locate();
    sample_.sequence = (sample_.sequence + 1) & 0xFFFFu;
    if (state_.place != LinkagePlace::kUnreachable) {
      sample_.position_m = state_.pose.position_m;
      sample_.orientation = state_.pose.orientation * back_;
    }
  }
  const bool lost = sample_.sequence > 0 && state_.place == LinkagePlace::kUnreachable;
  sample_.flags = axes_.flags | DeviceFlag::kCalibrated | (saturated_ ? DeviceFlag::kSaturated : 0u);
  sample_.error_code = axes_.error_code;
  if (lost) {
    sample_.flags |= DeviceFlag::kError;
    sample_.error_code = kNoHandle;
  }
  constexpr std::uint32_t kReported = DeviceFlag::kError | DeviceFlag::kStopButton;
  if ((sample_.flags & kReported) != 0) sample_.faults |= Fault::kDeviceReported;
  sample = sample_;
}

// Torques of the motors: the wrench by virtual work, the handle's weight, and what holds each link.
void AxisDevice::wanted_torques(const DeviceCommand& command, double* torque_Nm) noexcept {
  const Wrench wrench{command.force_N - arm_.weight_N, turns_handle_ ? command.torque_Nm : Vec3{}};
  double joint_Nm[kMaxAxes] = {};
  joint_torques(arm_.linkage, state_, wrench, joint_Nm);
  for (int i = 0; i < count_; ++i) {
    const AxisProfile& axis = arm_.axes[static_cast<std::size_t>(i)];
    const double held_Nm = axis.gravity_Nm != 0 ? axis.gravity_Nm * math::cos(joint_[i]) : 0.0;
    torque_Nm[i] = axis.torque_max_Nm > 0 ? motor_torque(axis, joint_Nm[i] + held_Nm) + against_friction_Nm(i) : 0.0;
  }
}

// All are shortened together where one exceeds its motor: the force keeps its direction.
void AxisDevice::bound_torques(double* torque_Nm) noexcept {
  double share = 1;
  for (int i = 0; i < count_; ++i) {
    const double most = arm_.axes[static_cast<std::size_t>(i)].torque_max_Nm;
    if (!is_finite(torque_Nm[i])) share = 0;
    if (abs_of(torque_Nm[i]) > most) share = min_of(share, most / abs_of(torque_Nm[i]));
  }
  saturated_ = share < 1;
  for (int i = 0; i < count_; ++i) torque_Nm[i] = share > 0 ? share * torque_Nm[i] : 0.0;
}

bool AxisDevice::transmit(const DeviceCommand& command) noexcept {
  AxisCommand out;
  out.enable = (command.flags & CommandFlag::kEnable) != 0;
  const bool obey = out.enable && (axes_.flags & DeviceFlag::kEnabled) != 0;
  limited_ticks_ += obey && !within_limits_;
  double wanted_Nm[kMaxAxes] = {};
  saturated_ = false;
  if (obey && within_limits_) {
    wanted_torques(command, wanted_Nm);
    bound_torques(wanted_Nm);
  }
  // Approached together, so that the force turns no corner on its way.
  double share = 1;
  for (int i = 0; i < count_; ++i) {
    const double step = abs_of(wanted_Nm[i] - torque_Nm_[i]);
    const double most = share_per_tick_ * arm_.axes[static_cast<std::size_t>(i)].torque_max_Nm;
    if (step > most) share = min_of(share, most / step);
  }
  for (int i = 0; i < count_; ++i) {
    torque_Nm_[i] = obey ? torque_Nm_[i] + share * (wanted_Nm[i] - torque_Nm_[i]) : 0.0;
    out.torque_Nm[i] = torque_Nm_[i];
  }
  return drives_.transmit(out);
}

}  // namespace palpate
