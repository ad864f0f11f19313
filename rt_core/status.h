// Status bits (a tick degraded something, and says what to change) and fault bits (latched; the output is made safe).
// One table each: names, meanings and remedies are generated from it for the host and for docs.
#pragma once

#include <cstdint>

namespace palpate {

// X(name, bit, what was degraded, remedy)
#define PALPATE_STATUS_BITS(X)                                                                                         \
  X(kContactsDropped, 0, "more tool points in contact than kMaxContacts; the deepest are kept",                        \
    "use fewer tool points (tool.piece.points) or raise kMaxContacts")                                                 \
  X(kRegionsDropped, 1, "more contact regions than kMaxRegions; the deepest are kept",                                 \
    "raise contact.cluster_distance_mm so that near contacts merge, or raise kMaxRegions")                             \
  X(kTraversalTruncated, 2, "the surface hierarchy is deeper than kMaxTraversalStack; a closer point may be missed",   \
    "bake the mesh again")                                                                                             \
  X(kOverlapInconclusive, 3, "the overlap test ran out of its support budget; the last contact is kept",               \
    "simplify the tool piece (hull with fewer vertices)")                                                              \
  X(kDepthBeyondRange, 4, "penetration beyond the law's stated range; the law is extended by its tangent",             \
    "raise contact.max_depth_mm or press less deeply")                                                                 \
  X(kForceClamped, 5, "the hand pulls harder than the device's largest force; that much is rendered, no more",         \
    "none: press less; or raise device.force_max_N within the device's data sheet")                                    \
  X(kRateLimited, 6, "the force change per tick exceeded the fault limiter",                                           \
    "look for a jump in the device position; raise device.force_rate_max_N_per_s")                                     \
  X(kInputHeld, 7, "no fresh device sample this tick; the last one is held", "see docs/realtime.md, missed samples")   \
  X(kInputRejected, 8, "a device sample was not finite, no rotation, or moved or turned further than a hand can",      \
    "check encoder and bus")                                                                                           \
  X(kCouplingSingular, 9, "a small linear system was singular; the step was skipped", "report this scene")             \
  X(kSkeletonDegenerate, 10, "the beam skeleton had no usable stiffness; anchors keep still",                          \
    "add anchors (body.min_anchors)")                                                                                  \
  X(kRamping, 11, "force is ramping in after start or out after a fault", "none: wait")                                \
  X(kNotConverged, 12, "a fixed-iteration solve ended above its tolerance; the residual is in telemetry",              \
    "report this scene")                                                                                               \
  X(kJointLimited, 13, "a joint command beyond the joint's limits was cut to them; one that is no number was ignored", \
    "send closings of 0 to 1 and positions within the limits in the image")                                            \
  X(kJointStopped, 14, "a joint stopped because it would press a loaded part harder than the stop force",              \
    "none: this is how a grasp ends; raise the stop force to squeeze harder")                                          \
  X(kTouchesBetween, 15, "a piece still touches the body, between its tool points: no force there",                    \
    "more tool points on that piece (tool.piece.points, hand.points_per_part)")                                        \
  X(kFootHeld, 16, "a tip is deeper than the surface's curvature allows; its last place of contact is kept",           \
    "press less deeply, or use a larger body")                                                                         \
  X(kStrainBeyondLinear, 17, "a finite-element body is strained beyond its linear range; forces are extrapolated",     \
    "press less deeply, or raise contact.nodal.strain_limit if the error is acceptable")                               \
  X(kCommandsUnheard, 18, "the device does not show that commands reach it; force is let go until it does",            \
    "check the bus towards the device: palpate device-test")                                                           \
  X(kStartsInside, 19, "arming refused: the tool starts inside the body and would push with more than 1 N",            \
    "move the handle out of the body, then arm again")                                                                 \
  X(kPointsHeld, 20,                                                                                                   \
    "a tick's share of surface work was spent; the other tool points keep their last place of contact",                \
    "fewer tool points (tool.piece.points), or a mesh without fans of thin triangles")                                 \
  X(kWorkBeyondStated, 21, "a stage counted more work than the image states for its worst tick",                       \
    "bake the scene again; with the same result, report it with the recording")                                        \
  X(kTorqueClamped, 22, "the hand turns harder than the device's largest torque; that much is rendered, no more",      \
    "none: turn less; or raise device.torque_max_Nm within the device's data sheet")                                   \
  X(kToolHeldBack, 23, "the tool would have jumped under its handle; it moves by a bounded step a tick",               \
    "none: this is how a slip or a jump of the handle is kept from kicking")                                           \
  X(kEnergyDrained, 24, "sampling and delay returned energy to the hand; damping took it away",                        \
    "none, or bake for the device as it is (--with its profile): device.delay_ms, device.damping_Ns_per_m")            \
  X(kSampleBridged, 25, "no fresh device sample this tick; the handle is taken to move on as it did",                  \
    "see docs/realtime.md, missed samples")                                                                            \
  X(kDeviceLate, 26, "the device obeys commands later than its stated delay; the coupling is softened to what it is",  \
    "measure it with palpate doctor --identify and state it: device.delay_ms")                                         \
  X(kSeatedAnew, 27, "samples came again after a gap or a jump; the tool is held apart from the handle",               \
    "none: it goes back as the hand lets go of the object; see docs/stability.md")

// X(name, bit, cause, remedy)
#define PALPATE_FAULT_BITS(X)                                                                                        \
  X(kNotFinite, 0, "the force computed was not a finite number", "replay the recording; report it")                  \
  X(kDeviceSilent, 1, "the device sent nothing for the silence limit", "check cable, power and bus")                 \
  X(kOverrun, 2, "too many ticks in a row missed deadlines (device.late_max_ms)",                                    \
    "run palpate latency; reduce the load")                                                                          \
  X(kDeviceReported, 3, "the device reported an error or its emergency stop", "release the stop; clear the device")  \
  X(kBusOff, 4, "the bus controller went bus-off", "check wiring and termination; restart the interface")            \
  X(kImageInvalid, 5, "the scene image failed its checks", "bake the scene again")                                   \
  X(kCommandInvalid, 6, "the host's command region failed its checks", "restart the host")                           \
  X(kForbiddenCall, 7, "the real-time thread attempted a forbidden system call", "report it")                        \
  X(kHostSilent, 8, "the host's heartbeat stopped while it was required", "restart the host")                        \
  X(kStateCorrupt, 9, "the state failed its finite check", "replay the recording; report it")                        \
  X(kStalled, 10, "the computer stood still once for too long (device.stall_max_ms)",                                \
    "run palpate doctor; use a real-time kernel and an isolated CPU")                                                \
  X(kDeviceDeaf, 11, "the device did not show that commands reach it, or would not be enabled again",                \
    "palpate device-test; check the bus towards the device")                                                         \
  X(kNotCalibrated, 12, "the device says that its positions are not calibrated", "calibrate the device, then reset") \
  X(kSamplesRejected, 13, "samples came, but none a hand could have made, for the silence limit",                    \
    "check encoder and calibration; device.speed_max_m_per_s, device.turn_max_rad_per_s")                            \
  X(kUnstable, 14, "the force swung back and forth, or contact returned more energy than the motors can hold",       \
    "bake for the device as it is: its delay and damping; see docs/stability.md")                                    \
  X(kSamplesSparse, 15, "the device sent fewer than 6 samples in 10 ticks for a quarter of a second",                \
    "let it send one sample a tick, or bake with its period (device.period_ms)")

namespace Status {
#define PALPATE_BIT(name, bit, what, remedy) inline constexpr std::uint32_t name = 1u << bit;
PALPATE_STATUS_BITS(PALPATE_BIT)
}  // namespace Status
namespace Fault {
PALPATE_FAULT_BITS(PALPATE_BIT)
#undef PALPATE_BIT
}  // namespace Fault

// What the output stage is doing. Leaves kFault only by an operator's reset command.
enum class Mode : std::int32_t {
  kIdle = 0,     // zero force, waiting to be armed
  kForce = 1,    // rendering (ramping in at first)
  kHold = 2,     // one tick without a fresh sample: the last force is kept
  kPassive = 3,  // a few ticks without a sample: force decays, damped
  kRamp = 4,     // force ramps to zero
  kFault = 5,    // latched, zero force
};

// The stages of one tick, in order: X(name, function, shown, what it does). `contact` is stamped in three parts, one
// for each step of a method (contact/contact.h).
#define PALPATE_STAGES(X)                                                        \
  X(kSense, sense, "sense", "device sample; where the tool goes")                \
  X(kArticulate, articulate, "articulate", "joints of an articulated tool")      \
  X(kFindRows, find_rows, "rows", "contact: what touches, and where")            \
  X(kSolve, solve, "solve", "contact: the forces that balance")                  \
  X(kAccount, account, "account", "contact: wrench, energy, tangent, memory")    \
  X(kSafety, make_safe, "safety", "coupling wrench, finite check, limits, mode") \
  X(kPublish, publish, "publish", "output")

enum class Stage : std::int32_t {
#define PALPATE_STAGE(name, function, shown, what) name,
  PALPATE_STAGES(PALPATE_STAGE)
#undef PALPATE_STAGE
};
#define PALPATE_STAGE(name, function, shown, what) +1
inline constexpr std::int32_t kStageCount = 0 PALPATE_STAGES(PALPATE_STAGE);
#undef PALPATE_STAGE

}  // namespace palpate
