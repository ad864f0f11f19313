#include "hal/drives/axis_plant.h"

#include <cmath>

#include "hal/drives/axis_map.h"

namespace palpate {
namespace {

// The plant quantises nothing: the encoders are at the motors.
PlantOptions without_encoder(PlantOptions options) {
  options.encoder_m = options.noise_m = 0;
  return options;
}

}  // namespace

AxisPlant::AxisPlant(const ArmProfile& arm, const PlantOptions& options, HandPath path)
    : arm_(arm), plant_(without_encoder(options), std::move(path)), count_(joint_count(arm.linkage)) {
  linkage_to(arm.linkage, plant_.pose(), joint_);
  for (int i = 0; i < count_; ++i)
    start_[i] = arm.home_pose ? joint_[i] : arm.axes[static_cast<std::size_t>(i)].home_joint;
}

double AxisPlant::since_home(int axis) const noexcept {
  return (joint_[axis] - start_[axis]) / joint_per_turn(arm_.axes[static_cast<std::size_t>(axis)]);
}

double AxisPlant::turns(int axis) noexcept {
  const AxisProfile& a = arm_.axes[static_cast<std::size_t>(axis)];
  const AxisFault& f = fault_[axis];
  if (f.frozen) return told_turns_[axis];
  const double turns =
      f.scale * since_home(f.reads < 0 ? axis : f.reads) + f.shift_turns + (arm_.home_pose ? 0.0 : a.home_turns);
  told_turns_[axis] = std::floor(turns * a.counts_per_turn + 0.5) / a.counts_per_turn;
  return told_turns_[axis];
}

void AxisPlant::shift_handle(Vec3 by_m) noexcept {
  double there[kMaxAxes] = {};
  if (!linkage_to(arm_.linkage, {plant_.pose().position_m + by_m, plant_.pose().orientation}, there)) return;
  for (int i = 0; i < count_; ++i)
    fault_[i].shift_turns += (there[i] - joint_[i]) / joint_per_turn(arm_.axes[static_cast<std::size_t>(i)]);
}

// F = (dq/dx)^T tau, M = (dq/dw)^T tau, by central differences of the inverse.
Wrench AxisPlant::on_handle(const double* joint_Nm) const noexcept {
  constexpr double kStep = 1e-6;
  const auto push = [&](Vec3 move, Vec3 turn) {
    double before[kMaxAxes] = {}, after[kMaxAxes] = {};
    const Pose here = plant_.pose();
    const Pose back{here.position_m - kStep * move, small_rotation(-kStep * turn) * here.orientation};
    const Pose forth{here.position_m + kStep * move, small_rotation(kStep * turn) * here.orientation};
    if (!linkage_to(arm_.linkage, back, before) || !linkage_to(arm_.linkage, forth, after)) return 0.0;
    double sum = 0;
    for (int i = 0; i < count_; ++i) sum += joint_Nm[i] * (after[i] - before[i]) / (2 * kStep);
    return sum;
  };
  const Vec3 none{}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Wrench wrench{{push(x, none), push(y, none), push(z, none)}, {}};
  if (arm_.linkage.gimbal) wrench.torque_Nm = {push(none, x), push(none, y), push(none, z)};
  return wrench;
}

void AxisPlant::step(const double* motor_Nm, const bool* on) noexcept {
  double joint_Nm[kMaxAxes] = {};
  for (int i = 0; i < count_; ++i)
    joint_Nm[i] = on[i] ? fault_[i].motor * joint_torque(arm_.axes[static_cast<std::size_t>(i)], motor_Nm[i]) : 0.0;
  const Wrench wrench = on_handle(joint_Nm);
  DeviceCommand command{wrench.force_N, wrench.torque_Nm, CommandFlag::kEnable};
  plant_.step(command);
  linkage_to(arm_.linkage, plant_.pose(), joint_);  // out of reach: the joints stay
}

}  // namespace palpate
