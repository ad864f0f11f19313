// Simulated moteus controllers on a bus: the bytes of the real ones, with the misbehaviour that tests ask for.
#pragma once

#include <string>

#include "hal/bus/transport.h"
#include "hal/drives/drive_sim.h"
#include "hal/drives/moteus_wire.h"

namespace palpate {

struct MoteusFault {
  int axis = -1;
  bool mute = false;         // answers nothing
  bool reversed = false;     // motor_position.output.sign is -1
  bool brakes = false;       // servo.timeout_mode stays 12, zero velocity
  bool no_watchdog = false;  // its time-out cannot be set
  bool stays_stopped = false;
  double serial = 0;  // another drive than the profile's
  int firmware_micro = -1, map = moteus::kMapVersion;
  int fault = 0;  // reports it from now on
};

class MoteusSim : public DriveSim {
 public:
  // Both must outlive this.
  MoteusSim(Transport& transport, const ArmProfile& arm, const PlantOptions& plant, HandPath path);

  void step() noexcept override;
  void step_bus() noexcept override;
  void set_fault(const MoteusFault& fault) noexcept { fault_ = fault; }
  // Without power for so many periods, then as it came: stopped, braking after its time-out.
  void restart(int axis, int periods) noexcept;
  bool any_enabled() const noexcept override;
  AxisPlant& plant() noexcept override { return plant_; }
  bool enabled(int axis) const noexcept { return drive_[axis].mode == moteus::kPositionMode; }
  double torque_Nm(int axis) const noexcept;
  std::uint64_t watchdogs() const noexcept { return watchdogs_; }  // times one expired

 private:
  // What a command says; every register it leaves out has its default.
  struct Command {
    double feedforward_Nm = 0, kp = 1, kd = 1, most_Nm = 1e9, timeout_s = 0;
  };
  struct Drive {
    int node = 0, mode = moteus::kStopped, fault = 0;
    Command command;
    int timeout_mode = 12;
    double fed_s = 0;
    int off_periods = 0;      // without power yet
    std::string heard, said;  // of the diagnostic stream
  };
  bool fault_of(int axis) const noexcept { return fault_.axis == axis; }
  bool silent(int axis) const noexcept { return drive_[axis].off_periods > 0 || (fault_of(axis) && fault_.mute); }
  void take(const Frame& frame) noexcept;
  void answer(int axis, const Frame& frame);
  void write(int axis, const moteus::Part& part) noexcept;
  void set_mode(int axis, int mode) noexcept;
  double value_of(int axis, std::uint32_t reg) noexcept;
  void obey(int axis, const std::string& line);
  void watch() noexcept;

  Transport& transport_;
  const ArmProfile& arm_;
  AxisPlant plant_;
  MoteusFault fault_;
  Drive drive_[kMaxAxes];
  unsigned firmware_ = 0;
  std::uint64_t watchdogs_ = 0;
};

}  // namespace palpate
