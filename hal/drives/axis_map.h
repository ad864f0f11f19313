// One motor and its joint: turns and torques of the one in positions and torques of the other.
#pragma once

#include "hal/device/arm_profile.h"

namespace palpate {

// Joint's radians (or metres of a slide) per turn of the motor, with its sign.
inline double joint_per_turn(const AxisProfile& axis) noexcept {
  return axis.direction * (axis.travel_m > 0 ? axis.travel_m : 2 * kPi / axis.ratio);
}
// Virtual work: motor torque = joint torque * dq / d(motor angle).
inline double motor_torque(const AxisProfile& axis, double joint_torque) noexcept {
  return joint_torque * joint_per_turn(axis) / (2 * kPi);
}
inline double joint_torque(const AxisProfile& axis, double motor_torque) noexcept {
  return motor_torque * 2 * kPi / joint_per_turn(axis);
}

}  // namespace palpate
