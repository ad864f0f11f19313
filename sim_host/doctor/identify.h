// `palpate doctor --identify`: measures mass, damping, friction, encoder step and delay of a device by a small motion
// of its handle, which nobody may hold. Force grows from nothing until the handle moves, and then only as far as travel
// stays small; whatever is not as it should be ends the motion with zero force and no profile.
#pragma once

#include <functional>
#include <string>

#include "hal/device/device.h"
#include "hal/device/device_profile.h"
#include "sim_host/doctor/device_fit.h"

namespace palpate {

// A device as the measurement uses it: a sample in, a force out, once a period.
struct DeviceOnBench {
  double period_s = 1e-3;
  std::function<void(DeviceSample&)> receive;
  std::function<void(const DeviceCommand&)> transmit;
  std::function<void()> wait;  // for the next period
};

// What the motion may be: a fingertip's way at walking pace, with a force that a finger stops.
struct IdentifyLimits {
  double force_N = 2;
  double travel_m = 0.015;  // from where it began; beyond, it ends
  double speed_m_per_s = 0.5;
};

struct Identified {
  std::string refused;  // why not, and what to do; empty: measured
  DeviceFit fit;
  double encoder_step_m = 0;
  double force_N = 0;  // used
};

// Moves the handle along its x axis for about three seconds.
Identified identify(const DeviceOnBench& device, const IdentifyLimits& limits);

// `known` with what was measured in place of it, as a profile: [device] alone.
std::string profile_toml(const DeviceProfile& known, const Identified& measured);
// On the simulated device that is as `profile` says: its path, and that of the file to write. Throws std::runtime_error
// for a profile that cannot be read or a file that cannot be written; returns the report.
Identified identify_simulated(const std::string& profile, const std::string& to);

}  // namespace palpate
