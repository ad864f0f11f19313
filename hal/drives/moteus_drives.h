// moteus controllers over CAN FD as the drives of a device: one node an axis; every period a command with a question
// out to each, and its answer back.
//
// Torque is the feed-forward of position mode with the controller's own loops scaled to zero, so that its time-out and
// its torque limit hold, which its current mode does not have. Each command carries both. A drive whose time-out has
// passed lets go (start() sees to that, its default is to brake) and stays so until it is stopped and enabled anew.
#pragma once

#include "hal/bus/transport.h"
#include "hal/device/arm_profile.h"
#include "hal/drives/axis_drives.h"
#include "hal/drives/moteus_wire.h"

namespace palpate {

class MoteusDrives : public AxisDrives {
 public:
  // Both must outlive this.
  MoteusDrives(Transport& transport, const ArmProfile& arm, double period_s) noexcept;

  std::string start(const Pause& pause) override;
  void receive(AxisSample& sample) noexcept override;
  bool transmit(const AxisCommand& command) noexcept override;
  std::string remarks() const override;

  // Error code where drives do not reach the mode asked for in time.
  static constexpr std::uint32_t kNotEnabled = 0xFFFFFFFF;
  // A drive that was silent for too long, or stopped by itself without a fault, has most likely started anew: what
  // start() set is gone, and its position may count from elsewhere. It is not enabled any more; only a new start ends
  // this. (It obeys the next command at once: one away for a few milliseconds does not show, but no computer starts so
  // fast.)
  static constexpr std::uint32_t kRestarted = 0xFFFFFFFE;

 private:
  struct Drive {
    int node = 0;
    double turns = 0;
    int mode = 0, fault = 0, told = 0;  // told: fault that let go of the hand
    std::uint32_t replies = 0;
    std::uint32_t silent = 0;  // periods since the last position
    bool moved = false;        // a position since the last whole set
    double model = 0, firmware = 0, map = 0, serial[3] = {}, timeout_s = 0;
    bool known = false, numbered = false, timed = false;  // the above was told
    char text[256] = {};                                  // of the diagnostic stream; start-up alone
    int text_bytes = 0;
  };
  void drain() noexcept;
  void take(const Frame& frame) noexcept;
  void apply(Drive& drive, const moteus::Part& part) const noexcept;
  void judge(AxisSample& sample) noexcept;
  bool may_move(int axis) const noexcept { return arm_.axes[static_cast<std::size_t>(axis)].torque_max_Nm > 0; }
  Frame stop_frame(int axis) const noexcept;
  Frame torque_frame(int axis, double torque_Nm) const noexcept;
  template <class Done>
  bool ask(int axis, const Frame& question, const Pause& pause, const Done& done);
  std::string tell(int axis, const std::string& line, const Pause& pause);
  std::string find_all(const Pause& pause);
  std::string identify(int axis, const Pause& pause);
  std::string prepare(int axis, const Pause& pause);
  std::string watch_rate(const Pause& pause);
  std::string axis_text(int axis) const;

  Transport& transport_;
  const ArmProfile& arm_;
  double period_s_;
  int count_;
  Drive drive_[kMaxAxes];
  bool starting_ = false;  // text is collected
  bool enable_ = false, was_enabled_ = false, restarted_ = false;
  std::uint32_t waited_ = 0;  // periods since `enable_` changed
};

}  // namespace palpate
