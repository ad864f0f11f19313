// Does each motor push the way its encoder counts? Only torque shows it: one motor after another pushes a little until
// its joint moves by a millimetre, and no more than a fifth of what it may.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hal/device/arm_profile.h"
#include "hal/drives/axis_drives.h"
#include "sim_host/doctor/doctor.h"

namespace palpate {

class PushCheck {
 public:
  // `drives` were started, and outlive this as `arm` does; `pause` lets a millisecond pass.
  PushCheck(AxisDrives& drives, const ArmProfile& arm, AxisDrives::Pause pause);

  // One row a motor; it ends with the first that is wrong. The last commands are no torque, drives off.
  std::vector<DoctorItem> run();
  // Of a motor's torque_max_Nm.
  static constexpr double kMostShare = 0.2;

 private:
  std::string enable();
  std::string push(int axis);
  void step(const AxisCommand& command);
  double moved_m(int axis, double from_turns) const;

  AxisDrives& drives_;
  const ArmProfile& arm_;
  AxisDrives::Pause pause_;
  AxisSample sample_;
};

}  // namespace palpate
