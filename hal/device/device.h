// The Device contract: what the control loop asks of anything that senses a hand and pushes back. The real device on a
// bus and the simulated one satisfy it alike, so one loop runs both.
//
// Frames and units: SI, device frame (the device's own axes, origin at its reference point). hal/device/kinematics.h
// turns samples into the world frame and wrenches back. Torque is about the handle's origin. Time: `receive` and
// `transmit` never wait: each does a bounded number of non-blocking calls. Neither allocates. Latency: a sample is as
// old as the bus makes it (see docs/realtime.md); `transmit` hands over the newest command only, and an old command is
// never sent again. Silence: no new valid sample since the last `receive` means `fresh == false`, with the last
// sample's values repeated (all zero before the first one). A device must drop to zero force by itself when commands
// stop coming.
#pragma once

#include <concepts>
#include <cstdint>

#include "hal/device/local_model.h"
#include "rt_core/vec.h"

namespace palpate {

// State the device reports of itself. The lowest six bits travel in every profile of the wire protocol.
namespace DeviceFlag {
inline constexpr std::uint32_t kCalibrated = 1u << 0;  // positions are absolute
inline constexpr std::uint32_t kEnabled = 1u << 1;     // drives are powered and obey forces
inline constexpr std::uint32_t kStopButton = 1u << 2;  // its emergency stop is pressed
inline constexpr std::uint32_t kError = 1u << 3;       // see error_code
inline constexpr std::uint32_t kWatchdog = 1u << 4;    // commands stopped coming: zero force until enabled anew
inline constexpr std::uint32_t kSaturated = 1u << 5;   // the last command was cut to its force limit
// It evaluates the local contact model of commands that carry one. Not in the classic profile, which carries none.
inline constexpr std::uint32_t kLocalModel = 1u << 6;
}  // namespace DeviceFlag

namespace CommandFlag {
// Power the drives; without it the device renders zero force. After power-up and after its watchdog a device stays at
// zero until this goes from 0 to 1.
inline constexpr std::uint32_t kEnable = 1u << 0;
}  // namespace CommandFlag

struct DeviceSample {
  Vec3 position_m;                   // of the handle, device frame
  Quat orientation;                  // handle to device frame, unit
  std::uint32_t device_time_us = 0;  // device clock, wraps; 0 where the profile does not carry it
  std::uint32_t sequence = 0;        // as sent; wraps with the profile's width
  std::uint32_t flags = 0;           // DeviceFlag
  std::uint32_t buttons = 0;
  std::uint32_t command_lag = 0;  // commands sent since the newest one it says it obeys; 0 where it does not say
  std::uint32_t error_code = 0;   // the device's own
  std::uint32_t faults = 0;       // Fault bits found on the way: bus-off, error reported by the device
  std::uint32_t received = 0;     // valid samples that arrived since the last call; only the newest is kept
  std::uint32_t gaps = 0;         // sequence numbers missing among them
  std::int64_t age_ns = -1;       // of the newest when it was received; negative: the bus does not say
  bool fresh = false;             // received > 0
};

struct DeviceCommand {
  Vec3 force_N;    // on the hand, device frame
  Vec3 torque_Nm;  // about the handle's origin
  std::uint32_t flags = 0;
  LocalModel local = {};     // none: the force is held
  std::uint32_t number = 0;  // counts commands: the age of a model is that of its command
};

// receive: drains everything that arrived, the newest sample wins. transmit: false if the command could not be handed
// to the bus (it is dropped and counted, never queued).
template <typename T>
concept Device = requires(T device, DeviceSample& sample, const DeviceCommand& command) {
  { device.receive(sample) }
  noexcept->std::same_as<void>;
  { device.transmit(command) }
  noexcept->std::same_as<bool>;
};

}  // namespace palpate
