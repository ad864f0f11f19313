// The mechanics behind simulated drives: the simulated handle and hand, seen through the joints of a linkage. It uses
// the linkage's inverse alone and takes its derivative by differences, so that a mistake in the forward map or in the
// Jacobian the controller uses shows.
#pragma once

#include <utility>

#include "hal/device/arm_profile.h"
#include "hal/device/device_sim.h"

namespace palpate {

// What may be wrong with what a drive counts, or with its motor's leads; for tests.
struct AxisFault {
  int reads = -1;          // the axis whose encoder is wired to this drive; -1: its own
  double scale = 1;        // -1: leads swapped, 0: nothing is counted, 2: another number of counts
  double shift_turns = 0;  // counts that were lost or made up
  bool frozen = false;     // tells the last position for ever
  double motor = 1;        // -1: leads of the motor swapped
};

class AxisPlant {
 public:
  // `arm` must outlive this. The path is in the device's frame.
  AxisPlant(const ArmProfile& arm, const PlantOptions& options, HandPath path);

  // One period of the device. `motor_Nm` of each motor; one that is not `on` moves freely.
  void step(const double* motor_Nm, const bool* on) noexcept;
  // What a drive counts, in turns; whole counts.
  double turns(int axis) noexcept;
  void set_fault(int axis, const AxisFault& fault) noexcept { fault_[axis] = fault; }
  void freeze_encoders(bool frozen) noexcept {
    for (AxisFault& fault : fault_) fault.frozen = frozen;
  }
  // Counts are lost by which the handle seems to stand elsewhere, so far away; nothing where it cannot.
  void shift_handle(Vec3 by_m) noexcept;
  double joint(int axis) const noexcept { return joint_[axis]; }
  DevicePlant& plant() noexcept { return plant_; }
  int count() const noexcept { return count_; }

 private:
  Wrench on_handle(const double* joint_Nm) const noexcept;
  double since_home(int axis) const noexcept;

  const ArmProfile& arm_;
  DevicePlant plant_;
  int count_;
  double joint_[kMaxAxes] = {}, start_[kMaxAxes] = {}, told_turns_[kMaxAxes] = {};
  AxisFault fault_[kMaxAxes];
};

}  // namespace palpate
