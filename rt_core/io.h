// What goes into and comes out of one tick. Plain structs, SI units, world frame unless a suffix says otherwise.
#pragma once

#include <cstdint>

#include "rt_core/limits.h"
#include "rt_core/live.h"
#include "rt_core/status.h"
#include "rt_core/vec.h"

namespace palpate {

// Who moves the tool. kDevice: the pose is the device handle's and the virtual coupling stands between it and the tool.
// kTool: the pose is the tool's own (presses without a device); the coupling is rigid and the output is the contact
// wrench. kHeld: as kDevice, but no hand holds the handle (presses of finite-element bodies): poses may jump, and
// nothing is armed, ramped or limited in its change.
enum class Drive : std::int32_t { kDevice = 0, kTool = 1, kHeld = 2 };

namespace Command {
inline constexpr std::uint32_t kArm = 1u << 0;    // edge: leave kIdle for kForce
inline constexpr std::uint32_t kStop = 1u << 1;   // level: ramp to zero, then kIdle
inline constexpr std::uint32_t kReset = 1u << 2;  // edge: leave kFault for kIdle
// The rest are levels of the control loop alone (a host's command region with them is refused): they ramp force to zero
// while they last and back afterwards, and nothing is armed. kStall: the machine and its simulated device stood still.
inline constexpr std::uint32_t kStall = 1u << 3;
// The device does not show that commands reach it. What counts as showing, and when it is a fault of its own, is in
// hal/loop/link_watch.h.
inline constexpr std::uint32_t kUnheard = 1u << 4;
}  // namespace Command

// What an articulated tool's joints are to do; rigid tools ignore it. Levels: repeated every tick. Single precision
// resolves 1e-7 rad, and half the bytes travel in every record.
struct JointCommand {
  float closing[kMaxFingers] = {};  // per finger: 0 open, 1 closed; the first is a gripper's
  float target[kMaxJoints] = {};    // rad or m, for the joints whose bit in `direct` is set
  std::uint32_t direct = 0;         // bit i: joint i goes to target[i], whatever its finger's closing
  std::uint32_t reserved = 0;
};
// Device button that closes every finger while it is held.
inline constexpr std::uint32_t kButtonClose = 1u << 0;

struct Input {
  Pose pose_w;                      // device handle (kDevice) or tool (kTool)
  std::uint32_t stale_ticks = 0;    // 0: fresh sample; n: no sample for n ticks (pose_w repeats the last one)
  std::uint32_t commands = 0;       // Command bits
  std::uint32_t device_fault = 0;   // Fault bits found by the HAL: silence, bus-off, device report, overrun
  std::uint32_t overrun_ticks = 0;  // deadlines missed just before this tick
  std::uint32_t buttons = 0;
  Drive drive = Drive::kDevice;
  JointCommand joints;
  LiveSettings live;  // what is wanted; the tick follows in bounded steps
  // Handle of the second device, which holds the body (HeldPart::kBoth) or a tool of its own (kTwoTools); that of the
  // first is `pose_w`.
  Pose second_w;
  // Commands sent since the newest one that the device of this sample says it obeys; 0 where it does not say.
  std::uint32_t command_lag = 0;
  std::uint32_t reserved = 0;
};

// X(type, name, stage, meaning). Every field of Output, so that replay and the state hash of the determinism test
// compare them all: a field that is added here is compared.
#define PALPATE_OUTPUT_FIELDS(X)                                                                                     \
  X(Wrench, device_w, "safety", "what the device must render, about the handle's origin; passed every safety check") \
  X(Wrench, contact_w, "account", "of the object on the tool, about its origin, before coupling and limits")         \
  X(Pose, tool_w, "safety", "where the virtual tool is")                                                             \
  X(double, penetration_m, "rows", "deepest sample depth")                                                           \
  X(double, energy_J, "account", "stored elastic energy of contact and friction springs")                            \
  X(double, surplus_J, "safety",                                                                                     \
    "what this contact gave the handle and holds beyond what the handle gave it, as the account of energy stands: "  \
    "above 0 it is braked away, below 0 it is credit; of the first of two hands")                                    \
  X(double, residual_m, "solve", "of the coupled region solve")                                                      \
  X(double, strain, "account", "largest strain at the gauges of a finite-element body")                              \
  X(double, ramp, "safety", "0..1 force ramp")                                                                       \
  X(std::uint32_t, status, "safety", "Status bits")                                                                  \
  X(std::uint32_t, fault, "safety", "latched Fault bits")                                                            \
  X(Mode, mode, "safety", "Mode")                                                                                    \
  X(std::int32_t, regions, "rows", "in contact")                                                                     \
  X(std::int32_t, contacts, "rows", "in contact")                                                                    \
  X(std::int32_t, late_ticks, "safety",                                                                              \
    "delay in ticks for which the coupling is softened: the device's echo showed more than was stated; else 0")      \
  X(Vec3, handle_w_m, "safety", "where the tick took the handle to be: the local model's point")                     \
  X(Vec3, felt_along_N_per_m, "safety",                                                                              \
    "xx, yy, zz of the stiffness the handle feels there: a device that evaluates the local model pushes with "       \
    "device_w - felt (x - handle_w_m); zero for a device that holds forces")                                         \
  X(Vec3, felt_across_N_per_m, "safety", "its yz, xz, xy")                                                           \
  X(Wrench, palm_w, "account",                                                                                       \
    "hand only: what the palm must exert on the body to balance fingers and weight, about "                          \
    "the tool's origin")                                                                                             \
  X(Wrench, second_w, "safety", "what the second device must render, about its handle's origin; zero without one")   \
  X(Vec3, second_handle_w_m, "safety", "where that handle was taken to be")                                          \
  X(Vec3, second_felt_along_N_per_m, "safety", "stiffness it feels there, as felt_along_N_per_m")                    \
  X(Vec3, second_felt_across_N_per_m, "safety", "its yz, xz, xy")                                                    \
  X(Pose, second_tool_w, "safety", "where the tool of the second hand is, if it has one; else where it is not moved")

struct Output {
#define PALPATE_FIELD(type, name, stage, meaning) type name{};
  PALPATE_OUTPUT_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
};

static_assert(std::is_trivially_copyable_v<Input> && std::is_trivially_copyable_v<Output>);

}  // namespace palpate
