// A Device made of drives: positions of motors become the handle's pose before the loop sees them, the loop's force
// becomes their torques behind it. What keeps the hand safe here, whatever the drives do: no torque where a joint is
// beyond its limits or the linkage is singular, none that is not a number, none above a motor's limit, and no change
// of more than a tenth of that limit in a millisecond.
#pragma once

#include <string>

#include "hal/device/arm_profile.h"
#include "hal/device/device.h"
#include "hal/drives/axis_drives.h"

namespace palpate {

class AxisDevice {
 public:
  // `drives` and `arm` must outlive this. A tool stands in the world as its scene has it where the handle's axes are
  // the device's (always, without a gimbal): with R the handle in the device's frame and F the frame in the world, the
  // sample says R F^-1, of which the loop makes F R F^-1, the handle's turn as the world sees it.
  AxisDevice(AxisDrives& drives, const ArmProfile& arm, const CartesianKinematics& frame, double period_s) noexcept;

  // drives.start(), then where the joints are: from the home pose the handle must rest in, or the drives' own zeros. ""
  // or why not.
  std::string find(const AxisDrives::Pause& pause);
  // The same, and every joint must lie within its limits: with the wrong zero, a reversed or another axis it often does
  // not.
  std::string start(const AxisDrives::Pause& pause);
  void receive(DeviceSample& sample) noexcept;
  bool transmit(const DeviceCommand& command) noexcept;

  // Error codes of its own, above those of a device's 8 bits.
  static constexpr std::uint32_t kNoHandle = 0x100;  // positions fit no handle
  bool within_limits() const noexcept { return within_limits_; }
  std::uint64_t limited_ticks() const noexcept { return limited_ticks_; }  // enabled, but beyond a limit
  double joint(int axis) const noexcept { return joint_[axis]; }
  double torque_Nm(int axis) const noexcept { return torque_Nm_[axis]; }  // of the motor, as last sent
  std::string remarks() const { return drives_.remarks(); }

  // Of a motor's friction so much is compensated at most.
  static constexpr double kFrictionShare = 0.8;

 private:
  std::string find_home(const AxisDrives::Pause& pause);
  std::string beyond_limits() const;
  void locate() noexcept;
  void wanted_torques(const DeviceCommand& command, double* torque_Nm) noexcept;
  void bound_torques(double* torque_Nm) noexcept;
  void observe_speeds() noexcept;
  double against_friction_Nm(int axis) const noexcept;

  AxisDrives& drives_;
  const ArmProfile& arm_;
  Quat back_;  // F^-1
  double period_s_;
  double share_per_tick_;  // of a motor's limit
  int count_;
  bool turns_handle_;  // motors on the gimbal
  double home_turns_[kMaxAxes] = {}, joint_[kMaxAxes] = {}, torque_Nm_[kMaxAxes] = {};
  double turns_[kMaxAxes] = {}, speed_[kMaxAxes] = {};  // of the motors: last, and turns/s, smoothed
  int periods_ = 0;                                     // since the last set of positions
  AxisSample axes_;
  LinkageState state_;
  DeviceSample sample_;
  bool within_limits_ = false, saturated_ = false;
  std::uint64_t limited_ticks_ = 0;
};

static_assert(Device<AxisDevice>);

}  // namespace palpate
