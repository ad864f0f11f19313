// The drives of a device whose joints are driven one by one, whatever their protocol: what AxisDevice asks of a driver.
// The simulated drives are asked through the same bytes (see odrive_sim.h, cia402_sim.h): one path for both.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "hal/device/linkage.h"

namespace palpate {

struct AxisSample {
  double turns[kMaxAxes] = {};   // of the motors, as the drives count them
  std::uint32_t flags = 0;       // DeviceFlag: kEnabled once every motor obeys
  std::uint32_t buttons = 0;     // of the handle, where the drives read them
  std::uint32_t error_code = 0;  // of the first drive that reports one
  std::uint32_t faults = 0;      // Fault
  std::uint32_t received = 0;    // whole sets of positions since the last call
  bool fresh = false;            // every axis has sent a position since the last fresh sample
};

struct AxisCommand {
  double torque_Nm[kMaxAxes] = {};  // of the motors
  bool enable = false;
};

class AxisDrives {
 public:
  // Lets a millisecond pass. Start-up only.
  using Pause = std::function<void()>;

  virtual ~AxisDrives() = default;
  // Before the loop: finds every drive, proves that it is the one the profile names, sets what must be set and reads it
  // back. No motor is enabled. "" or why not, with the axis and what to do.
  virtual std::string start(const Pause& pause) = 0;
  // In the loop, once a period each; bounded, no allocation.
  virtual void receive(AxisSample& sample) noexcept = 0;
  virtual bool transmit(const AxisCommand& command) noexcept = 0;
  // What a person should know, a line each, "" for nothing: after start() what could not be compared, after a run what
  // the drives reported in it.
  virtual std::string remarks() const { return ""; }
};

// Pauses in a period, at least one: at start, too, commands come no faster than the bus budget counts with.
inline int pauses_in(double period_s) {
  const int whole = static_cast<int>(1e3 * period_s + 0.5);
  return whole > 1 ? whole : 1;
}

}  // namespace palpate
