// State: all that survives a tick. Scratch: thrown away after it. Both have fixed capacity and are trivially copyable,
// so snapshot, restore, replay and rollback are a copy. Arrays are grouped by the stage that writes them.
#pragma once

#include <cstdint>
#include <type_traits>

#include "rt_core/contact/contact_stiffness.h"
#include "rt_core/contact/nodes/node_problem.h"
#include "rt_core/contact/nodes/region_motion.h"
#include "rt_core/contact/problem.h"
#include "rt_core/io.h"
#include "rt_core/limits.h"
#include "rt_core/model.h"

namespace palpate {

enum class FrictionMode : std::int32_t { kFree = 0, kStick = 1, kSlip = 2 };

// Per-tool-point contact memory. Written by find_rows.
struct PointState {
  Vec3 closest_w;    // on the rest surface
  Vec3 normal_w;     // outward unit normal there (pseudo-normal on edges and vertices)
  double gap_m = 0;  // signed: distance of the core point from the surface minus its margin; < 0 is penetration
  double gap_bound_m =
      0;  // lower bound of gap_m when the query was skipped (the point cannot have reached the surface)
  std::int32_t triangle = -1;  // last closest triangle: warm start
  std::int32_t region = -1;    // slot in State::region, or -1
};

// A contact region: a cluster of tool points with an identity that lasts.
struct Region {
  // regions
  std::uint32_t id = 0;         // unique since reset; 0: slot empty
  std::uint32_t born_tick = 0;  // temporal order (ties by id)
  std::int32_t lost_ticks = 0;  // 0 while in contact; otherwise ticks since the last contact
  std::int32_t point_count = 0;
  double area_m2 = 0;  // of the contacting tool points
  double depth_max_m = 0;
  // force
  Vec3 centre_w;                  // centre of pressure, projected to the rest surface: the equivalent contact point
  Vec3 normal_w;                  // unit, of the resultant normal force
  double normal_force_N = 0;      // >= 0, along normal_w, on the tool
  Vec3 friction_force_w;          // on the tool
  Wrench wrench_w;                // of this region on the tool, about the tool's origin
  double depth_equivalent_m = 0;  // inverse law of |normal force|
  double energy_J = 0;
  double tangent_N_per_m = 0;  // normal stiffness
  Vec3 lean_tool_m;  // centre of the region's far field and its direction, set at first touch and fixed to the tool
  Vec3 lean_normal_tool;  // from then on; zero: not set
  // friction memory
  Vec3 stretch_w;                   // tangential elastic stretch: material point minus origin of deformation
  double tangential_k_N_per_m = 0;  // Mindlin variant: stiffness of the last tick
  double reversal_N_per_m = 0;      // while it slips: its stiffness against motion back, along -stretch_w; else 0
  FrictionMode friction = FrictionMode::kFree;
  std::int32_t reserved = 0;
  Vec3 origin_w;  // origin of the deformation p_o on the rest surface
};

// What a surface node that pushes remembers (nodes). Written by account.
struct NodalContact {
  std::int32_t vertex = -1;
  std::int32_t piece = -1;
  std::int32_t region = -1;  // slot in State::region, or -1
  FrictionMode friction = FrictionMode::kStick;
  Vec3 force_w;        // on the body
  Vec3 anchor_tool_m;  // where on the tool (joints at zero) it sticks, or was
};

// Memory of the nodal back-end: the nodes that pushed last tick.
struct NodalState {
  std::int32_t count = 0;
  std::int32_t reserved = 0;
  double far_share = 0;  // part of the nodes' motion that is far field
  NodalContact contact[kMaxContacts];
  RegionMotion motion[kMaxRegions];  // far field of each region
};

struct SafetyState {
  Mode mode = Mode::kIdle;
  std::uint32_t fault = 0;
  std::uint32_t last_commands = 0;
  double ramp = 0;            // 0..1 gain of the output
  std::int32_t stopping = 0;  // the operator asked to stop: ramp to zero, then kIdle
  Pose tool_corrected_w;      // the virtual tool after the coupling's corrector: where the next prediction starts
  Wrench last_good_w;         // last finite, clamped wrench before the gain
  Wrench last_device_w;       // last output
};

// Joints of an articulated tool. Written by articulate; rigid tools leave it untouched.
struct ArticulationState {
  double closing[kMaxFingers] = {};
  double joint[kMaxJoints] = {};  // rad or m
  std::int32_t started = 0;       // 0: joints take their open positions at the next tick
  std::int32_t moved = 0;         // 1: some joint moved this tick
  // Motion of each piece from its place with all joints at zero, tool frame: at this and at the last tick.
  Pose motion_tool[kMaxPieces];
  Pose motion_previous_tool[kMaxPieces];
  Vec3 axis_tool[kMaxJoints];      // of each joint where it is now
  Vec3 origin_tool_m[kMaxJoints];  // a point on it
  // Normal contact load of each piece, of the last tick. Written by contact.
  Vec3 piece_force_tool_N[kMaxPieces];
  Vec3 piece_torque_tool_Nm[kMaxPieces];  // about the tool's origin
};

// Largest number of each pool's entries used since reset.
struct HighWater {
  std::int32_t contacts = 0, regions = 0, traversal_stack = 0, gjk_support_calls = 0;
};

struct State {
  std::uint64_t tick = 0;
  // sense
  Pose device_w, device_previous_w;
  Pose tool_w, tool_previous_w;       // pose at which this and the last tick's contact was evaluated
  double contact_stiffness[36] = {};  // 6x6 tangent (force, torque about the tool origin) of the last tick, row-major
  std::int32_t started = 0;
  std::int32_t rejected_ticks = 0;  // consecutive samples found implausible
  std::uint32_t next_region_id = 1;
  PointState point[kMaxToolPoints];
  Region region[kMaxRegions];
  NodalState nodal;
  SafetyState safety;
  HighWater high_water;
  ArticulationState articulation;
};

// Where a tool point's centre stands over the smooth surface (rt_core/surface/smooth_foot.h). Written by find_rows when
// the model has corner normals; indexed by piece: such tools have one point per piece at most.
struct SurfaceFoot {
  Vec3 centre_w;  // of the tool point
  std::int32_t triangle = -1;
  Real weight[3] = {};     // area coordinates of the foot
  Vec3 gradient_per_m[3];  // of the area coordinates when the centre moves; zero where the foot is held
};

struct Scratch {
  std::uint32_t status = 0;
  std::int32_t contact_count = 0;
  Contact contact[kMaxContacts];
  Wrench palm_w;  // hand only: see Output
  SurfaceFoot foot[kMaxPieces];
  Wrench contact_wrench_w;  // sum over regions, on the tool, about the tool's origin
  double energy_J = 0;
  double residual_m = 0;
  RowsByRegion rows;           // points, tips: written by solve
  RegionSystem system;         // of the region solver
  ContactStiffness stiffness;  // of normal loads so far
  std::int32_t driven = 0;     // the tool's pose is given, nobody holds it by a spring
  double strain = 0;           // largest at the gauges (nodal)
  Pose tool_corrected_w;       // where the tool balances
  ContactProblem nodal;
};

static_assert(std::is_trivially_copyable_v<State> && std::is_trivially_copyable_v<Scratch>);
static_assert(sizeof(State) < 256 * 1024, "State must stay below 256 KiB");

// Resets to the state before the first tick.
void reset(State& state) PALPATE_RT;
// Canonical hash of everything in `state` that can influence a later tick, field by field, never padding. `field`-wise
// so that a replay can name the first difference: see `first_difference`.
std::uint64_t hash_state(const Model& model, const State& state) PALPATE_RT;
// Name of the first field (in hash order) whose hash differs, or nullptr; host use.
const char* first_difference(const Model& model, const State& a, const State& b) noexcept;

}  // namespace palpate
