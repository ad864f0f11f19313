// Every compile-time capacity of the real-time core, with its reason and what happens when it overflows.
// Overflow never crashes and never reaches the heap: it sets the status bit named here and degrades deterministically.
#pragma once

#include <cstdint>

namespace palpate {

// Convex pieces of one tool. A hand has 15 contact parts and a palm, and a box on an elastic body 19 (its edges and
// faces), of which a gripper has two or three. Refused when the scene is baked.
inline constexpr std::int32_t kMaxPieces = 64;
// Triangles of one hull piece: of the 64 corners it may have. Each plane is asked of every four nodes of a body,
// for 10 instructions. Refused at bake.
inline constexpr std::int32_t kMaxHullFaces = 124;
// Moving joints of an articulated tool: the 21 of a hand. Refused at bake.
inline constexpr std::int32_t kMaxJoints = 21;
// Groups of joints that one closing fraction drives: the five fingers of a hand.
inline constexpr std::int32_t kMaxFingers = 5;
// Sample points spread over the tool's pieces: each is one closest-point query in the worst tick. Room for a finely
// sampled tool; what a scene can afford is decided by its instruction budget. Refused at bake.
inline constexpr std::int32_t kMaxToolPoints = 2048;
// Tool points in contact at once. Overflow: the deepest are kept (ties by index), Status::kContactsDropped.
inline constexpr std::int32_t kMaxContacts = 64;
// Contacts solved in a tick's friction sweeps, all sweeps together: one sweep of sixty, four of sixteen. Past it no
// further sweep is begun; the next tick goes on from there. docs/models_contact_lcp.md has what that costs in accuracy.
inline constexpr std::int32_t kMaxFrictionVisits = 64;
// Surface nodes of a finite-element body: at 5461 nodes the compliance in single precision is 1 GiB, locked in memory.
// Refused when the scene is baked.
inline constexpr std::int32_t kMaxNodalVertices = 5461;
// Points of a finite-element body whose strain is watched: each costs 6 numbers per contact and tick. Refused at bake.
inline constexpr std::int32_t kMaxStrainGauges = 16;
// Boxes and triangles of the surface that one tick looks at where the image states no less: 2.5e6 instructions.
// Overflow: what is left waits for the next tick, Status::kPointsHeld.
inline constexpr std::int32_t kMaxSurfaceWork = 16384;
// Contact regions at once: 15 finger parts and a palm. Overflow: the deepest are kept, Status::kRegionsDropped.
inline constexpr std::int32_t kMaxRegions = 16;
// Skeleton anchors of one body. Refused at bake (the baker keeps the most persistent).
inline constexpr std::int32_t kMaxAnchors = 32;
// Anchors where beams also go to every other region (CouplingLaw::kMutualPaper). Refused at bake.
inline constexpr std::int32_t kMaxMutualAnchors = kMaxAnchors - (kMaxRegions - 1);
// Depth of the hierarchy's traversal stack: a 4-wide tree over 4 million leaves needs 3 * log4(4e6) = 33 entries.
// The loader refuses a deeper tree; Status::kTraversalTruncated if it is met all the same.
inline constexpr std::int32_t kMaxTraversalStack = 64;
// Support callbacks of all ccdGJKIntersect calls of one tick. Of three million ticks of an adversary 440 asked for
// more, none of grasps (2026-11-28), of ten million one for 90, 66,000 instructions. Past the budget the answer is
// "inconclusive": the last contact is kept for another tick, Status::kOverlapInconclusive.
inline constexpr std::int32_t kGjkSupportBudget = 28;
inline constexpr std::int32_t kGjkMaxIterations = 60;
// Newton iterations of the coupled region solve: residual below 7e-14 m after 5 (2000 random 15-region problems).
inline constexpr std::int32_t kCoupledNewtonIterations = 5;
// Newton iterations of the inverse cubic law: relative error below 7e-16 after 5.
inline constexpr std::int32_t kInverseLawIterations = 5;
// Knots of one factor table of a tip law: 128 equal intervals of the root of the depth; a C1 cubic through exact values
// and slopes is then within 1e-9 of the exact layer and sphere factors (tests/response). Fixed at bake.
inline constexpr std::int32_t kFactorKnots = 129;
// Knots shared by all tabulated responses of a scene; a query is a binary search of 6 steps. Refused at bake.
inline constexpr std::int32_t kMaxResponseKnots = 64;
// Pairs of tips with a stated coupling: all pairs of 8 tips. Refused at bake.
inline constexpr std::int32_t kMaxTipPairs = 28;
// Newton steps of a contact's foot on the smooth surface (3 per triangle suffice) and triangles it may walk over.
// Overflow: the last foot is kept, Status::kFootHeld.
inline constexpr std::int32_t kFootNewtonSteps = 24;
inline constexpr std::int32_t kFootWalk = 8;
// Newton steps, with bisection as guard, of one tip's series law: 4 suffice for every law tested; 64 bisections alone
// reach double precision. Overflow: Status::kNotConverged.
inline constexpr std::int32_t kSeriesIterations = 64;
// Newton steps of several coupled tips. Overflow: Status::kNotConverged.
inline constexpr std::int32_t kTipNewtonIterations = 10;
// Evaluations of the laws of an elastic body's tips in one tick, whose solves are two. A step that all halvings leave
// no better used to be followed by others: of 65,792 ticks of tools put anywhere on the clip 4,752 counted 64
// evaluations and double steps and more, up to 287, and one of these converged. Of 40,000 solves there that found an
// answer 99 % took 8 evaluations or fewer and 208 more than 9; tips on other bodies took 11 at most (2026-11-28).
// Overflow: Status::kNotConverged.
inline constexpr std::int32_t kTipEvaluations = 16;
// Halvings of one Newton step of coupled regions that makes things worse.
inline constexpr std::int32_t kStepHalvings = 4;
// Soft modes of an elastic body, with their quartic energy: its 55 x 55 table is 24 kB and 3,000 multiply-adds. Refused
// at bake.
inline constexpr std::int32_t kMaxSoftModes = 10;
// Its linear modes: each costs 3 multiply-adds a vertex and pair of regions. Refused at bake.
inline constexpr std::int32_t kMaxLinearModes = 64;
// A lost region keeps its identity this long and this close, so a bounce does not lose its friction history.
inline constexpr double kRegionMemory_s = 50e-3;
inline constexpr double kRegionMemoryDistance_m = 2e-3;
// Largest change of the rendered force (and torque) in one tick, as a share of its limit: whatever happens to samples,
// commands or numbers, the hand gets no impulse above it. At the coupling's 1.5 N/mm and 0.2 kg of hand and handle
// (14 Hz) a swing needs 9.9 N before its slope meets 0.85 N a millisecond; a snap is faster where the coupling
// is stiffer than the device holds: snap_in_paper, thrown into its seat at 0.5 m/s, meets it for 10 ticks (2026-11-22).
// What is promised is a tenth; the rest is margin for rounding, here, on the wire and in whoever measures it.
inline constexpr double kOutputStepShare = 0.098;
// A hand that holds the tool by the coupling moves it in one tick by its own motion and this share of the coupling's
// largest stretch F_max / K: then no slip, no jump of the handle and no change of contact changes the force by more
// than this share of F_max, which leaves a fifth of the output's own step to the hand.
inline constexpr double kToolStepShare = 0.08;
// Ticks whose outputs may still be on their way to the motors: a delay of 4 ms at 1 kHz. A longer one counts as that.
inline constexpr std::int32_t kForceHistory = 5;
// Of the last quarter of a second this share of ticks may have no fresh sample: such a device holds the force of a
// press for 2 ticks in 5 and hardly passes its delay through the coupling's bound. Fault::kSamplesSparse.
inline constexpr double kStaleShareMost = 0.4;
// A tool that would push the hand harder than this the moment force may begin is not armed: Status::kStartsInside.
inline constexpr double kArmForceMax_N = 1.0;
// What a force command can carry (hal/bus/wire_table.h: signed 16 bits of 1 mN and 0.1 mN m). A scene whose device asks
// for more is refused at bake and at load: beyond it each axis would saturate by itself and the force would turn.
inline constexpr double kWireForceMax_N = 32.767;
inline constexpr double kWireTorqueMax_Nm = 3.2767;
// Rejected samples are counted up to here: a quarter of an hour at 1 kHz, long past every fault.
inline constexpr std::int32_t kMaxRejectedTicks = 1'000'000;
// A quaternion whose squared length is further from 1 than this is no orientation: 16-bit rounding makes 1e-4 of it.
inline constexpr double kQuaternionSlack = 0.02;
// Ticks kept whole by the black box and by the "worst ticks" list.
inline constexpr std::int32_t kWorstTicksKept = 16;
// Length of the scene name stored in an image, with its terminating zero.
inline constexpr std::int32_t kNameBytes = 64;

}  // namespace palpate
