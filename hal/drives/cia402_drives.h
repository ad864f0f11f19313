// CiA 402 drives in cyclic synchronous torque over CANopen. Each period the loop sends every drive its torque and then
// the SYNC, at which drives take their torques over and send their positions; these are read a period later. A
// heartbeat of the controller goes with it: drives that miss it fault by themselves (object 1016h, read back at start).
#pragma once

#include "hal/bus/transport.h"
#include "hal/device/arm_profile.h"
#include "hal/drives/axis_drives.h"
#include "hal/drives/canopen_wire.h"

namespace palpate {

class Cia402Drives : public AxisDrives {
 public:
  // Both must outlive this.
  Cia402Drives(Transport& transport, const ArmProfile& arm, double period_s) noexcept;

  std::string start(const Pause& pause) override;
  void receive(AxisSample& sample) noexcept override;
  bool transmit(const AxisCommand& command) noexcept override;
  std::string remarks() const override;

  // Error codes beyond an emergency's 16 bits.
  static constexpr std::uint32_t kNotEnabled = 0x10000;  // a transition was not confirmed in time
  static constexpr std::uint32_t kRestarted = 0x20000;   // a drive started anew and has lost its set-up

 private:
  struct Drive {
    int node = 0;
    std::int32_t position = 0;
    std::uint32_t status = 0, emergency = 0;
    canopen::DriveState state = canopen::DriveState::kNotReady;
    std::uint32_t in_state = 0;  // periods
    bool moved = false, restarted = false;
    std::uint32_t told = 0, told_register = 0;  // last emergency since start()
    bool late = false;                          // a transition was not confirmed in time
    bool no_polarity = false;                   // it has no such object
    std::int32_t at_home = 0, origin = 0;       // calibrate = "index": what it counted at start, and at the mark
  };
  void drain() noexcept;
  void take(const Frame& frame) noexcept;
  void judge(AxisSample& sample) noexcept;
  std::uint16_t controlword(const Drive& drive) const noexcept;
  bool wanted(int axis) const noexcept;

  // Start-up: "" or what is wrong.
  std::string identify(int axis, const Pause& pause);
  std::string check_motor(int axis, const Pause& pause);
  std::string check_polarity(int axis, const Pause& pause);
  std::string guard(int axis, const Pause& pause);
  std::string map_pdos(int axis, const Pause& pause);
  void pass_period(const Pause& pause);
  std::string seek_mark(int axis, const Pause& pause);
  std::string find_marks(const Pause& pause);
  std::string take_mark(int axis, std::int32_t caught);
  std::string write(int axis, std::uint32_t object, int bytes, std::uint32_t value, const Pause& pause);
  std::string demand(int axis, std::uint32_t object, double expected, const char* what, const Pause& pause);
  bool exchange(int axis, const Frame& request, const Pause& pause);
  bool read(int axis, std::uint32_t object, std::uint32_t& value, const Pause& pause);
  void command_network(canopen::Nmt command, int node);
  std::string axis_text(int axis) const;

  Transport& transport_;
  const ArmProfile& arm_;
  double period_s_;
  int count_;
  Drive drive_[kMaxAxes];
  Frame reply_;
  std::uint32_t awaited_id_ = 0;
  bool replied_ = false;
  bool enable_ = false, was_enabled_ = false;
  std::uint32_t beat_ = 0;  // periods since the last heartbeat
};

}  // namespace palpate
