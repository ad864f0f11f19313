// A whole device of drives in virtual time: simulated hand, handle, joints and drives on one end of a loopback, the
// driver, the axis layer, the control loop and the real tick() on the other.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "hal/device/device_profile.h"
#include "hal/drives/axis_device.h"
#include "tests/hal/arm_text.h"
#include "tests/hal/bad_cable.h"
#include "tests/hal/fault_bench.h"

namespace palpate::test {

inline constexpr char kArmDevice[] = R"([device]
name = "arm"
mass_kg = 0.1
inertia_kg_m2 = 1e-4
damping_Ns_per_m = 2.5
damping_Nms_per_rad = 0.001
friction_N = 0.06
friction_Nm = 5e-4
encoder_step_mm = 0.03
encoder_step_rad = 0.001
delay_ms = 1
force_max_N = 8.5
torque_max_Nm = 0
)";

inline DeviceProfile arm_profile(const std::string& tables) {
  std::string error;
  const auto profile = parse_device_profile(kArmDevice + tables, "arm.toml", error);
  EXPECT_TRUE(profile && profile->arm) << error;
  return profile.value_or(DeviceProfile{});
}

inline std::string replaced(std::string text, const std::string& old, const std::string& fresh) {
  const auto at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? text : text.replace(at, old.size(), fresh);
}

// The arm's home pose lies where the hand begins; no turn, no scale.
inline CartesianKinematics frame_of(const ArmProfile& arm, const HandPath& hand_w) {
  double home[kMaxAxes] = {};
  for (std::size_t i = 0; i < arm.axes.size(); ++i) home[i] = arm.axes[i].home_joint;
  CartesianKinematics frame;
  frame.position_w = hand_w.at(0).pose.position_m - linkage_at(arm.linkage, home).pose.position_m;
  return frame;
}

// The hand's path of pressing_hand(), seen from the device.
inline HandPath pressing_arm_hand(Vec3 origin_w_m) {
  std::vector<HandPose> poses;
  for (const double at_s : {0.0, 0.1, 0.3, 1.2, 4.0}) {
    const Pose pose = pressing_hand().at(at_s).pose;
    poses.push_back({at_s, {pose.position_m - origin_w_m, pose.orientation}});
  }
  return HandPath(poses);
}

template <class Drives, class Sim>
class WiredArm {
 public:
  // The period is the plant's.
  WiredArm(const std::string& tables, const VirtualClock& clock, const PlantOptions& plant = {})
      : clock_(clock),
        period_s_(plant.period_s),
        profile_(arm_profile(tables)),
        frame_(frame_of(*profile_.arm, pressing_hand())),
        ends_(open_loopback_pair(error_)),
        cable_(*ends_.first),
        far_cable_(*ends_.second),
        drives_(cable_, *profile_.arm, period_s_),
        sim_(far_cable_, *profile_.arm, plant, pressing_arm_hand(frame_.position_w)),
        device_(drives_, *profile_.arm, frame_, period_s_) {}

  // The hand stands still while the drives are set up: simulated time of the hand begins with the loop's.
  std::string start() {
    return device_.start([this, ms = 0]() mutable {
      if (++ms % pauses_in(period_s_) == 0) sim_.step_bus();
    });
  }
  void receive(DeviceSample& sample) noexcept {
    while (due_ns_ <= clock_.now_ns()) {
      sim_.step();
      rendered_.push_back(sim_.plant().plant().motor());
      rendered_N_.push_back(rendered_.back().force_N);
      due_ns_ += period_ns();
    }
    device_.receive(sample);
    last_ = sample;
  }
  bool transmit(const DeviceCommand& command) noexcept {
    last_sent_ = command;
    return silent_ || device_.transmit(command);
  }
  void silence_controller(bool silent) { silent_ = silent; }
  Sim& sim() { return sim_; }
  BadCable& cable() { return cable_; }          // at the controller
  BadCable& far_cable() { return far_cable_; }  // at the drives
  AxisDevice& axes() { return device_; }
  const ArmProfile& arm() const { return *profile_.arm; }
  const CartesianKinematics& frame() const { return frame_; }
  const DeviceCommand& last_sent() const { return last_sent_; }
  const DeviceSample& last() const { return last_; }
  const std::vector<Vec3>& rendered_N() const { return rendered_N_; }  // in each period
  const std::vector<Wrench>& rendered() const { return rendered_; }

 private:
  std::int64_t period_ns() const { return static_cast<std::int64_t>(1e9 * period_s_ + 0.5); }

  const VirtualClock& clock_;
  double period_s_;
  std::string error_;
  DeviceProfile profile_;
  CartesianKinematics frame_;
  std::pair<std::unique_ptr<Transport>, std::unique_ptr<Transport>> ends_;
  BadCable cable_, far_cable_;
  Drives drives_;
  Sim sim_;
  AxisDevice device_;
  DeviceCommand last_sent_;
  DeviceSample last_;
  std::vector<Vec3> rendered_N_;
  std::vector<Wrench> rendered_;
  bool silent_ = false;
  std::int64_t due_ns_ = period_ns();
};

}  // namespace palpate::test
