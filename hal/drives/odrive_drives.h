// ODrives over CAN as the drives of a device: one node an axis, torque in, turns out, every period.
//
// Nothing on the way back says which command a drive obeys: that commands arrive is guarded by the drive's own
// watchdog, which start() sets and reads back. One frame of set-up a period goes out beside the torques.
#pragma once

#include "hal/bus/transport.h"
#include "hal/device/arm_profile.h"
#include "hal/drives/axis_drives.h"
#include "hal/drives/odrive_wire.h"

namespace palpate {

class ODriveDrives : public AxisDrives {
 public:
  // Both must outlive this.
  ODriveDrives(Transport& transport, const ArmProfile& arm, double period_s) noexcept;

  std::string start(const Pause& pause) override;
  void receive(AxisSample& sample) noexcept override;
  bool transmit(const AxisCommand& command) noexcept override;
  std::string remarks() const override;

  // Error code where drives do not reach the state asked for in time.
  static constexpr std::uint32_t kNotEnabled = 0xFFFFFFFF;
  // A drive that was silent for too long, or left closed loop without an error, has most likely started anew: what
  // start() set, its watchdog above all, may be gone, and its position may count from elsewhere. It is not enabled any
  // more; only a new start ends this.
  static constexpr std::uint32_t kRestarted = 0xFFFFFFFE;

 private:
  struct Drive {
    int node = 0;
    double turns = 0;
    std::uint32_t error = 0, state = 0, estimates = 0;
    std::uint32_t told = 0;             // last error since start()
    std::uint32_t silent = 0;           // periods since the last position
    bool heard = false, moved = false;  // a heartbeat ever; a position since the last call
    Frame answer;                       // newest of what start() waits for
    bool answered = false;
  };
  void drain() noexcept;
  void take(const Frame& frame) noexcept;
  void judge(AxisSample& sample) noexcept;
  Frame next_setup() noexcept;
  std::string find_all(const Pause& pause);
  std::string identify(int axis, const Pause& pause);
  std::string prepare(int axis, const Pause& pause);
  std::string watch_rate(const Pause& pause);
  bool ask(int axis, const Frame& question, odrive::Message reply, const Pause& pause);
  bool read_endpoint(int axis, double endpoint, const Pause& pause);
  void write_endpoint(int axis, double endpoint, const void* value, int bytes);
  std::string axis_text(int axis) const;

  Transport& transport_;
  const ArmProfile& arm_;
  double period_s_;
  int count_;
  Drive drive_[kMaxAxes];
  std::uint32_t awaited_id_ = 0;  // of the answer start() waits for; 0: none
  int awaiting_ = 0;
  bool enable_ = false, was_enabled_ = false, restarted_ = false;
  int setup_ = 0;             // set-up frames sent since `enable_` changed
  std::uint32_t waited_ = 0;  // periods since then
};

}  // namespace palpate
