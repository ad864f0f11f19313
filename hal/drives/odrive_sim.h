// ODrives as the bus sees them: they answer and send the bytes of CANSimple, keep their watchdogs, and drive the
// simulated handle through its joints. For tests and palpate-device; a drive's current loop is taken to be ideal.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "hal/bus/transport.h"
#include "hal/drives/drive_sim.h"

namespace palpate {

// What may be wrong with one drive.
struct ODriveFault {
  int axis = -1;                      // of the joints, from 0; -1: none
  bool mute = false;                  // not there
  bool reversed = false;              // its position mapper's scale is negative
  bool no_watchdog = false;           // acknowledges, but leaves it off
  bool stays_idle = false;            // takes no closed loop
  double serial = 0;                  // another drive than the profile's
  std::uint8_t firmware_minor = 255;  // another firmware
  int estimate_periods = 1;           // sends positions every so many periods
  std::uint32_t error = 0;            // reports it from now on
};

class ODriveSim : public DriveSim {
 public:
  // Both must outlive this.
  ODriveSim(Transport& transport, const ArmProfile& arm, const PlantOptions& plant, HandPath path);

  void step() noexcept override;
  void step_bus() noexcept override;
  void set_fault(const ODriveFault& fault) noexcept { fault_ = fault; }
  bool any_enabled() const noexcept override {
    bool any = false;
    for (int i = 0; i < plant_.count(); ++i) any = any || on(i);
    return any;
  }
  AxisPlant& plant() noexcept override { return plant_; }
  // Without power for so many periods, then as it came: idle, its watchdog off.
  void restart(int axis, int periods) noexcept;
  // Each drive sends by its own crystal, so many parts per million fast, and a little early or late by chance.
  void set_clock(int axis, double ppm, double jitter_periods = 0) noexcept {
    drive_[axis].ppm = ppm;
    drive_[axis].jitter = jitter_periods;
  }
  double torque_Nm(int axis) const noexcept { return on(axis) ? drive_[axis].torque_Nm : 0.0; }
  bool closed_loop(int axis) const noexcept { return drive_[axis].state == 8; }
  bool watchdog_on(int axis) const noexcept { return drive_[axis].watchdog; }
  std::uint64_t watchdogs() const noexcept { return watchdogs_; }  // times one expired

 private:
  struct Drive {
    int node = 0;
    std::uint8_t state = 1;
    std::uint32_t error = 0;
    double torque_Nm = 0;
    bool torque_mode = false, watchdog = false;
    float watchdog_s = 0;
    double fed_s = 0;
    int off_periods = 0;                              // without power yet
    double ppm = 0, jitter = 0, due = 0.5, late = 0;  // periods until its next position
  };
  bool on(int axis) const noexcept { return drive_[axis].state == 8 && drive_[axis].torque_mode; }
  bool fault_of(int axis) const noexcept { return fault_.axis == axis; }
  bool silent(int axis) const noexcept { return drive_[axis].off_periods > 0 || (fault_of(axis) && fault_.mute); }
  int positions_due(int axis) noexcept;
  void take(const Frame& frame) noexcept;
  void answer(int axis, const Frame& question) noexcept;
  void take_sdo(int axis, const Frame& frame) noexcept;
  void send_version(int axis) noexcept;
  void send_address(int axis) noexcept;
  void send_state() noexcept;
  void watch() noexcept;

  Transport& transport_;
  const ArmProfile& arm_;
  AxisPlant plant_;
  ODriveFault fault_;
  Drive drive_[kMaxAxes];
  std::uint8_t firmware_[3] = {};
  std::uint64_t periods_ = 0, watchdogs_ = 0;
  std::uint64_t random_ = 1;
};

}  // namespace palpate
