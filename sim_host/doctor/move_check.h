// Are signs, axes and scales those of the profile? A person moves the handle along the axes of the world, motors off,
// and what drives and linkage make of it is compared with what was asked.
//
// Encoders alone are seen so: whether a motor pushes the way its encoder counts does not show before there is torque.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hal/drives/axis_device.h"
#include "sim_host/doctor/doctor.h"

namespace palpate {

// One motion that was asked for, and the joints, by the profile, before and after it.
struct HandMove {
  std::string word;  // "forward (x+)"
  // What was asked, over kAskedMove: of the handle in the world, or of a gimbal's joints.
  Vec3 along;
  bool of_gimbal = false;
  double from[kMaxAxes] = {}, to[kMaxAxes] = {};
};
inline constexpr double kAskedMove_m = 0.05, kAskedTurn_rad = kPi / 4;

// How far a joint's motion moves the end of its lever, so that turns and slides compare.
double lever_m(const ArmProfile& arm, int axis);

// Those that the linkage can make: forward, up, right, and of a gimbal three turns.
std::vector<HandMove> asked_moves(const ArmProfile& arm, const CartesianKinematics& frame);

// One row a move, and one that names what is wrong: an axis that is dead, reversed, swapped or of another scale, or a
// frame that stands another way. A person's aim is wide: 35 degrees, and 0.6 to 1.6 times the way.
std::vector<DoctorItem> judge_moves(const ArmProfile& arm, const CartesianKinematics& frame,
                                    const std::vector<HandMove>& moves);

class MoveCheck {
 public:
  using Tell = std::function<void(const std::string& line)>;
  // `device` was found, and outlives this; `pause` lets a millisecond pass.
  MoveCheck(AxisDevice& device, const ArmProfile& arm, const CartesianKinematics& frame, AxisDrives::Pause pause,
            Tell tell);

  // Asks for each move and the way back, waits for it, and judges. No command enables a motor.
  std::vector<DoctorItem> run();

 private:
  bool step();
  std::string await_rest(bool moved);
  double moved_m(const double* from) const;

  AxisDevice& device_;
  const ArmProfile& arm_;
  const CartesianKinematics& frame_;
  AxisDrives::Pause pause_;
  Tell tell_;
  double rest_[kMaxAxes] = {};  // joints where the handle rested last
};

}  // namespace palpate
