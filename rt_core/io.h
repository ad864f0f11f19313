// What goes into and comes out of one tick. Plain structs, SI units, world frame unless a suffix says otherwise.
#pragma once

#include <cstdint>

#include "rt_core/status.h"
#include "rt_core/vec.h"

namespace palpate {

// Who moves the tool. kDevice: the pose is the device handle's and the virtual coupling stands between it and the tool.
// kTool: the pose is the tool's own (presses without a device); the coupling is rigid and the output is the contact
// wrench.
enum class Drive : std::int32_t { kDevice = 0, kTool = 1 };

namespace Command {
inline constexpr std::uint32_t kArm = 1u << 0;    // edge: leave kIdle for kForce
inline constexpr std::uint32_t kStop = 1u << 1;   // level: ramp to zero, then kIdle
inline constexpr std::uint32_t kReset = 1u << 2;  // edge: leave kFault for kIdle
}  // namespace Command

struct Input {
  Pose pose_w;                      // device handle (kDevice) or tool (kTool)
  Vec3 velocity_w;                  // m/s, of the handle; zero if unknown
  std::uint32_t stale_ticks = 0;    // 0: fresh sample; n: no sample for n ticks (pose_w repeats the last one)
  std::uint32_t commands = 0;       // Command bits
  std::uint32_t device_fault = 0;   // Fault bits found by the HAL: silence, bus-off, device report, overrun
  std::uint32_t overrun_ticks = 0;  // deadlines missed just before this tick
  std::uint32_t buttons = 0;
  Drive drive = Drive::kDevice;
};

struct Output {
  Wrench device_w;           // what the device must render, about the handle's origin; passed every safety check
  Wrench contact_w;          // force of the object on the tool, about the tool's origin, before coupling and limits
  Pose tool_w;               // where the virtual tool is
  double penetration_m = 0;  // deepest sample depth
  double energy_J = 0;       // stored elastic energy of contact and friction springs
  double residual_m = 0;     // of the coupled region solve
  double strain = 0;         // largest strain at the gauges of a finite-element body
  double ramp = 0;           // 0..1 force ramp
  std::uint32_t status = 0;  // Status bits
  std::uint32_t fault = 0;   // latched Fault bits
  Mode mode = Mode::kIdle;
  std::int32_t regions = 0;
  std::int32_t contacts = 0;
  std::int32_t reserved = 0;
};

static_assert(std::is_trivially_copyable_v<Input> && std::is_trivially_copyable_v<Output>);

}  // namespace palpate
