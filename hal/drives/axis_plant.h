// The mechanics behind simulated drives: the simulated handle and hand, seen through the joints of a linkage. It uses
// the linkage's inverse alone and takes its derivative by differences, so that a mistake in the forward map or in the
// Jacobian the controller uses shows.
#pragma once

#include <utility>

#include "hal/device/arm_profile.h"
#include "hal/device/device_sim.h"

namespace palpate {

class AxisPlant {
 public:
  // `arm` must outlive this. The path is in the device's frame.
  AxisPlant(const ArmProfile& arm, const PlantOptions& options, HandPath path);

  // One period of the device. `motor_Nm` of each motor; one that is not `on` moves freely.
  void step(const double* motor_Nm, const bool* on) noexcept;
  // What an encoder counts, in turns; whole counts.
  double turns(int axis) const noexcept;
  double joint(int axis) const noexcept { return joint_[axis]; }
  DevicePlant& plant() noexcept { return plant_; }
  int count() const noexcept { return count_; }

 private:
  Wrench on_handle(const double* joint_Nm) const noexcept;

  const ArmProfile& arm_;
  DevicePlant plant_;
  int count_;
  double joint_[kMaxAxes] = {}, start_[kMaxAxes] = {};
};

}  // namespace palpate
