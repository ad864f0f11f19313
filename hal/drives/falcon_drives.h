// A Novint Falcon as the drives of a device: three motors behind one serial adapter. Every period one packet of motor
// strengths goes out, and the device answers it with one of encoder counts and buttons.
//
// The device names neither itself nor its firmware, and nothing published says what its motors do when packets stop
// coming: this driver knows of no watchdog to set or to read. docs/devices.md says what follows from that.
#pragma once

#include "hal/bus/transport.h"
#include "hal/device/arm_profile.h"
#include "hal/drives/axis_drives.h"
#include "hal/drives/falcon_wire.h"

namespace palpate {

class FalconDrives : public AxisDrives {
 public:
  // Both must outlive this.
  FalconDrives(Transport& transport, const ArmProfile& arm, double period_s) noexcept;

  std::string start(const Pause& pause) override;
  void receive(AxisSample& sample) noexcept override;
  bool transmit(const AxisCommand& command) noexcept override;

  // Error code where a device that was homed says it is not any more: it was switched off and on.
  static constexpr std::uint32_t kNotHomed = 0xFFFFFFFF;

 private:
  void drain() noexcept;
  bool send(const falcon::Packet& packet) noexcept;
  std::string prepare_line(const Pause& pause);
  std::string watch_rate(const Pause& pause);
  std::string find_home(const Pause& pause);
  bool homed() const noexcept { return (last_.bits & falcon::kHomed) == falcon::kHomed; }

  Transport& transport_;
  const ArmProfile& arm_;
  falcon::PacketReader reader_;
  falcon::Packet last_;
  std::uint32_t packets_ = 0, line_errors_ = 0;
  int latency_ms_ = 0;
  bool fresh_ = false, started_ = false;
};

}  // namespace palpate
