// A simulated Falcon behind its serial adapter: the bytes of the real one as far as they are known, with the
// misbehaviour that tests ask for. Its motors hold the last packet for ever: whether the real one's do is not known,
// and nothing that is safe on this one needs a watchdog.
#pragma once

#include "hal/bus/transport.h"
#include "hal/drives/drive_sim.h"
#include "hal/drives/falcon_wire.h"

namespace palpate {

struct FalconFault {
  bool no_firmware = false;   // says nothing at all
  bool other_speech = false;  // a serial device that is no Falcon
  bool slow_adapter = false;  // its latency stays 16 ms
  bool stays_away = false;    // the hand does not bring motor 2's encoder past its mark
};

class FalconSim : public DriveSim {
 public:
  // Both must outlive this.
  FalconSim(Transport& transport, const ArmProfile& arm, const PlantOptions& plant, HandPath path);

  void step() noexcept override;
  void step_bus() noexcept override;
  bool any_enabled() const noexcept override { return (last_.bits & falcon::kGreen) != 0; }
  AxisPlant& plant() noexcept override { return plant_; }
  bool enabled(int) const noexcept { return any_enabled(); }
  double torque_Nm(int axis) const noexcept;
  void set_fault(const FalconFault& fault) noexcept { fault_ = fault; }
  void press(unsigned buttons) noexcept { buttons_ = buttons; }
  // Switched off and on: it has its firmware back, but not its home.
  void restart() noexcept;

 private:
  void take(const Frame& frame) noexcept;
  void control(const Frame& frame) noexcept;
  void answer() noexcept;
  void say(const std::uint8_t* bytes, int count) noexcept;
  int motor_of(int axis) const noexcept;

  Transport& transport_;
  const ArmProfile& arm_;
  AxisPlant plant_;
  FalconFault fault_;
  falcon::PacketReader reader_;
  falcon::Packet last_;
  int latency_ms_ = 16, baud_ = 0, sought_ = 0;
  unsigned homed_ = 0, buttons_ = 0;
  bool spoke_ = false;
};

}  // namespace palpate
