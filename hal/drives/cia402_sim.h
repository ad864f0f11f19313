// CiA 402 drives as the bus sees them: network states, an object dictionary behind SDO, PDOs as mapped, the drive's
// state machine one step a SYNC, a consumer of the controller's heartbeat, emergencies; behind them the simulated
// handle.
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "hal/bus/transport.h"
#include "hal/drives/canopen_wire.h"
#include "hal/drives/drive_sim.h"

namespace palpate {

class Cia402Sim : public DriveSim {
 public:
  // Both must outlive this.
  Cia402Sim(Transport& transport, const ArmProfile& arm, const PlantOptions& plant, HandPath path);

  void step() noexcept override;
  void step_bus() noexcept override;
  bool any_enabled() const noexcept override {
    bool any = false;
    for (int i = 0; i < plant_.count(); ++i) any = any || enabled(i);
    return any;
  }
  AxisPlant& plant() noexcept override { return plant_; }

  // What may be wrong with one drive, by axis from 0.
  void mute(int axis) noexcept { drive_[axis].mute = true; }
  void set_object(int axis, std::uint32_t object, std::uint32_t value) noexcept {
    drive_[axis].object[object].value = value;
  }
  // Acknowledges writes to it and keeps what it has.
  void freeze_object(int axis, std::uint32_t object) noexcept { drive_[axis].object[object].frozen = true; }
  void remove_object(int axis, std::uint32_t object) { drive_[axis].object.erase(object); }
  // Answers every question for it with an abort.
  void hide_object(int axis, std::uint32_t object) noexcept { drive_[axis].object[object].hidden = true; }
  void lay_beside_home(int axis, double turns) noexcept { drive_[axis].beside_turns = turns; }  // when switched on
  void stay_off_mark(int axis) noexcept { drive_[axis].stays = true; }  // the hand does not bring it past its index
  void stick(int axis) noexcept { drive_[axis].stuck = true; }          // ready, but not switched on
  void fail(int axis, std::uint16_t emergency) noexcept { enter_fault(axis, emergency); }
  void restart(int axis) noexcept;

  bool enabled(int axis) const noexcept { return drive_[axis].state == canopen::DriveState::kEnabled; }
  std::uint32_t object(int axis, std::uint32_t object) const noexcept;
  std::uint64_t heartbeats_lost() const noexcept { return heartbeats_lost_; }

 private:
  struct Object {
    int bytes = 4;
    std::uint32_t value = 0;
    bool writable = true, frozen = false, hidden = false;
  };
  struct Drive {
    int node = 0;
    std::map<std::uint32_t, Object> object;
    std::uint8_t network = canopen::kIsPreOperational;
    canopen::DriveState state = canopen::DriveState::kDisabled;
    std::uint32_t control = 0, last_control = 0;
    std::int16_t torque = 0;  // thousandths of the rated torque, as the last RPDO has it
    Frame pending;            // RPDO until the next SYNC
    bool has_pending = false, beating = false, mute = false, stuck = false;
    double beat_s = 0;  // since the controller's heartbeat
    int sought = 0;     // periods that the touch probe has waited
    bool stays = false;
    double beside_turns = 0;
  };
  void take(const Frame& frame) noexcept;
  void take_sdo(int axis, const Frame& frame) noexcept;
  std::uint32_t store(int axis, std::uint32_t object, std::uint32_t value) noexcept;
  void synchronise(int axis) noexcept;
  void obey(int axis) noexcept;
  void send_position(int axis) noexcept;
  void enter_fault(int axis, std::uint16_t emergency) noexcept;
  void send_emergency(int axis, std::uint16_t code) noexcept;
  void watch(int axis) noexcept;
  void probe(int axis) noexcept;
  std::int32_t mark(int axis) const noexcept;
  double counts(int axis) noexcept;
  void make_dictionary(int axis);
  std::uint32_t get(int axis, std::uint32_t object) const noexcept;
  std::uint32_t statusword(int axis) const noexcept;

  Transport& transport_;
  const ArmProfile& arm_;
  AxisPlant plant_;
  Drive drive_[kMaxAxes];
  std::uint64_t heartbeats_lost_ = 0;
};

}  // namespace palpate
