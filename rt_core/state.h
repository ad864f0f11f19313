// State: all that survives a tick. Scratch: thrown away after it. Each is one block of memory laid out at load from the
// image's sizes (pool.h): a scene holds what its method needs, and snapshot, restore, replay and rollback are a copy of
// the block. The tables below are all there is in a State: its fields, reset, hash, comparison and dump are made from
// them, so none can forget a field.
#pragma once

#include <cstdint>
#include <type_traits>

#include "rt_core/contact/contact_stiffness.h"
#include "rt_core/contact/problem.h"
#include "rt_core/io.h"
#include "rt_core/limits.h"
#include "rt_core/model.h"
#include "rt_core/pool.h"
#include "rt_core/safety/edge_observer.h"
#include "rt_core/safety/encoder_observer.h"
#include "rt_core/safety/handle_track.h"
#include "rt_core/state_fields.h"
#include "rt_core/work.h"

namespace palpate {

// One row of a table of pools: X(element type, name, capacity for a model, elements in use, meaning).
#define PALPATE_STATE_POOL(type, name, capacity, used, meaning) Pool<type> name;
#define PALPATE_STATE_VISIT_POOL(type, name, capacity, used, meaning) visit_pool(visitor, #name, name, used);
#define PALPATE_STATE_LAYOUT_POOL(type, name, capacity, used, meaning) hash = layout_with<type>(hash, #name);
#define PALPATE_STATE_PLACE(type, name, capacity, used, meaning) arena.place(name, capacity);
#define PALPATE_STATE_CLEAR(type, name, capacity, used, meaning) name.fill({});
#define PALPATE_STATE_LIKE(type, name, capacity, used, meaning) &&name.is_like(other.name)

// As PALPATE_STATE_FIELDS_OF, with pools, over a struct of fields; and what lays the pools out, resets all and compares
// two layouts.
#define PALPATE_STATE_GROUP_OF(Fields, POOLS)                                                                 \
  POOLS(PALPATE_STATE_POOL)                                                                                   \
  template <class Visitor>                                                                                    \
  void visit(Visitor& visitor) const PALPATE_RT_IF(Visitor::kRealTime) {                                      \
    Fields::visit(visitor);                                                                                   \
    POOLS(PALPATE_STATE_VISIT_POOL)                                                                           \
  }                                                                                                           \
  static constexpr std::uint64_t layout(std::uint64_t hash) noexcept {                                        \
    hash = Fields::layout(hash);                                                                              \
    POOLS(PALPATE_STATE_LAYOUT_POOL)                                                                          \
    return hash;                                                                                              \
  }                                                                                                           \
  void place_pools([[maybe_unused]] const Model& model, Arena& arena) noexcept { POOLS(PALPATE_STATE_PLACE) } \
  void reset() PALPATE_RT {                                                                                   \
    static_cast<Fields&>(*this) = Fields{};                                                                   \
    POOLS(PALPATE_STATE_CLEAR)                                                                                \
  }                                                                                                           \
  template <class Group>                                                                                      \
  bool is_laid_out_like(const Group& other) const PALPATE_RT {                                                \
    return true POOLS(PALPATE_STATE_LIKE);                                                                    \
  }

enum class FrictionMode : std::int32_t { kFree = 0, kStick = 1, kSlip = 2 };

#define PALPATE_POINT_STATE(X)                                                                                     \
  X(Vec3, closest_w, {}, "on the rest surface")                                                                    \
  X(Vec3, normal_w, {}, "outward unit normal there (pseudo-normal on edges and vertices)")                         \
  X(double, gap_m, 0, "signed: distance of the core point from the surface minus its margin; < 0 is penetration")  \
  X(double, gap_bound_m, 0, "lower bound of gap_m when the query was skipped: the point cannot have come so near") \
  X(std::int32_t, triangle, -1, "last closest triangle: warm start")                                               \
  X(std::int32_t, region, -1, "slot in State::region, or -1")

// Contact memory of one tool point. Written by find_rows.
struct PointState {
  PALPATE_STATE_FIELDS_OF(PALPATE_POINT_STATE)
};

#define PALPATE_REGION(X)                                                                                           \
  X(std::uint32_t, id, 0, "unique since reset; 0: slot empty")                                                      \
  X(std::uint32_t, born_tick, 0, "temporal order (ties by id)")                                                     \
  X(std::int32_t, lost_ticks, 0, "0 while in contact; otherwise ticks since the last contact")                      \
  X(std::int32_t, point_count, 0, "contacts in it")                                                                 \
  X(double, area_m2, 0, "of the contacting tool points")                                                            \
  X(double, depth_max_m, 0, "deepest of them")                                                                      \
  X(Vec3, centre_w, {}, "centre of pressure, projected to the rest surface: the equivalent contact point")          \
  X(Vec3, normal_w, {}, "unit, of the resultant normal force")                                                      \
  X(double, normal_force_N, 0, ">= 0, along normal_w, on the tool")                                                 \
  X(Vec3, friction_force_w, {}, "on the tool")                                                                      \
  X(Wrench, wrench_w, {}, "of this region on the tool, about the tool's origin")                                    \
  X(double, depth_equivalent_m, 0, "inverse law of |normal force|")                                                 \
  X(double, energy_J, 0, "stored")                                                                                  \
  X(double, tangent_N_per_m, 0, "normal stiffness")                                                                 \
  X(Vec3, lean_tool_m, {}, "centre of the region's far field, set at first touch and fixed to the tool from then")  \
  X(Vec3, lean_normal_tool, {}, "and its direction; zero: not set")                                                 \
  X(Vec3, stretch_w, {}, "friction memory: tangential elastic stretch, material point minus origin of deformation") \
  X(double, tangential_k_N_per_m, 0, "Mindlin variant: stiffness of the last tick")                                 \
  X(double, reversal_N_per_m, 0, "while it slips: its stiffness against motion back, along -stretch_w; else 0")     \
  X(FrictionMode, friction, FrictionMode::kFree, "stick, slip or free")                                             \
  X(std::int32_t, hand, 0, "1: of the second of two tools")

// A contact region: a cluster of contacts with an identity that lasts.
struct Region {
  PALPATE_STATE_FIELDS_OF(PALPATE_REGION)
  bool is_live() const PALPATE_RT { return id != 0; }  // what is not live is never read
};

#define PALPATE_NODAL_CONTACT(X)                                     \
  X(std::int32_t, vertex, -1, "of the body's surface")               \
  X(std::int32_t, piece, -1, "of the tool")                          \
  X(std::int32_t, region, -1, "slot in State::region, or -1")        \
  X(FrictionMode, friction, FrictionMode::kStick, "sticks or slips") \
  X(Vec3, force_w, {}, "on the body")                                \
  X(Vec3, anchor_tool_m, {}, "where on the tool (joints at zero) it sticks, or was")

// What a surface node that pushes remembers. Written by the nodes' method.
struct NodalContact {
  PALPATE_STATE_FIELDS_OF(PALPATE_NODAL_CONTACT)
};

#define PALPATE_REGION_MOTION(X)                                               \
  X(Vec3, centre_w, {}, "mean rest position of the nodes it was fitted to")    \
  X(Vec3, translation_m, {}, "of the centre")                                  \
  X(Vec3, rotation_rad, {}, "about it")                                        \
  X(double, reach_m, 0, "rest points farther from the centre are not carried") \
  X(double, growth, 0, "of the motion by finite rotation: bend_of()")          \
  X(double, finite, 0, "1: finite rotation counts, 0: it does not")

// The far field at a contact region of a finite-element body: the rigid motion of the surface around it, which carries
// the nodes where gaps and normals are taken (contact/nodes/region_motion.h).
struct RegionMotion {
  PALPATE_STATE_FIELDS_OF(PALPATE_REGION_MOTION)
};

#define PALPATE_NODAL_STATE(X)                    \
  X(std::int32_t, count, 0, "entries of contact") \
  X(std::int32_t, reserved, 0, "-")               \
  X(double, far_share, 0, "part of the nodes' motion that is far field")
#define PALPATE_NODAL_POOLS(X)                                                                   \
  X(NodalContact, contact, model.sizes.n_nodal > 0 ? kMaxContacts : 0, count, "nodes that push") \
  X(RegionMotion, motion, model.sizes.n_nodal > 0 ? kMaxRegions : 0, motion.size(), "of each region")

// Memory of the nodes' method: the nodes that pushed last tick.
struct NodalFields {
  PALPATE_STATE_FIELDS_OF(PALPATE_NODAL_STATE)
};
struct NodalState : NodalFields {
  PALPATE_STATE_GROUP_OF(NodalFields, PALPATE_NODAL_POOLS)
};

using ByFinger = double[kMaxFingers];

#define PALPATE_ARTICULATION_STATE(X)                                                 \
  X(ByFinger, closing, {}, "closing fraction of each finger")                         \
  X(std::int32_t, started, 0, "0: joints take their open positions at the next tick") \
  X(std::int32_t, moved, 0, "1: some joint moved this tick")
#define PALPATE_ARTICULATION_POOLS(X)                                                                 \
  X(double, joint, model.sizes.n_joint, joint.size(), "rad or m")                                     \
  X(Vec3, axis_tool, model.sizes.n_joint, axis_tool.size(), "of each joint where it is now")          \
  X(Vec3, origin_tool_m, model.sizes.n_joint, origin_tool_m.size(), "a point on it")                  \
  X(Pose, motion_tool, moving_pieces(model), motion_tool.size(),                                      \
    "of each piece from its place with all joints at zero, tool frame: at this tick")                 \
  X(Pose, motion_previous_tool, moving_pieces(model), motion_previous_tool.size(), "and at the last") \
  X(Vec3, piece_force_tool_N, moving_pieces(model), piece_force_tool_N.size(),                        \
    "normal contact load of each piece, of the last tick: what stops joints")                         \
  X(Vec3, piece_torque_tool_Nm, moving_pieces(model), piece_torque_tool_Nm.size(), "about the tool's origin")

inline std::int64_t moving_pieces(const Model& model) noexcept {
  return model.sizes.n_joint > 0 || model.params.articulation == Articulation::kTwoTools ? model.sizes.n_piece : 0;
}

// Joints of an articulated tool. Written by articulate, the loads by contact; a rigid tool has none.
struct ArticulationFields {
  PALPATE_STATE_FIELDS_OF(PALPATE_ARTICULATION_STATE)
};
struct ArticulationState : ArticulationFields {
  PALPATE_STATE_GROUP_OF(ArticulationFields, PALPATE_ARTICULATION_POOLS)
};

// Outputs of the last ticks, six numbers each: force, torque.
using ForceHistory = double[6 * kForceHistory];
// What a device that evaluates the local model was told: force, point, stiffness (xx, yy, zz, yz, xz, xy).
inline constexpr std::int32_t kToldNumbers = 12;
using ToldHistory = double[kToldNumbers * kForceHistory];

#define PALPATE_SAFETY_STATE(X)                                                                          \
  X(Mode, mode, Mode::kIdle, "of the mode machine")                                                      \
  X(std::uint32_t, fault, 0, "latched Fault bits")                                                       \
  X(std::uint32_t, last_commands, 0, "Command bits of the last tick: edges")                             \
  X(std::int32_t, stopping, 0, "the operator asked to stop: ramp to zero, then kIdle")                   \
  X(double, ramp, 0, "0..1 gain of the output")                                                          \
  X(Pose, tool_corrected_w, {}, "tool after the coupling's corrector: where the next prediction starts") \
  X(Wrench, last_good_w, {}, "last finite, clamped wrench before the gain")                              \
  X(Wrench, last_device_w, {}, "last output")                                                            \
  X(ForceHistory, sent, {}, "last outputs, newest first")                                                \
  X(Vec3, stretch_slow_m, {}, "the coupling's stretch, smoothed: its damping takes the rate from it")    \
  X(double, stored_J, 0, "held by coupling and object at the last tick")                                 \
  X(double, object_J, 0, "the object's part of it")                                                      \
  X(Wrench, object_w, {}, "of the object on the tool then")                                              \
  X(double, surplus_J, 0, "what this contact gave the handle and holds, beyond what the handle gave it") \
  X(Vec3, last_coupling_N, {}, "the coupling's force at the last tick")                                  \
  X(Vec3, last_step_N, {}, "and its change then")                                                        \
  X(double, swings, 0, "ticks in which it changed back, lately")                                         \
  X(double, unpaid_J, 0, "while the coupling's end stands apart: held, and not given by the hand")       \
  X(ToldHistory, told, {}, "to a local device in the last outputs, newest first")                        \
  X(Vec3, rendered_N, {}, "by a local device at the last sample, as it was told")                        \
  X(Vec3, ring_N, {}, "what rings since a touch, along the normal there")                                \
  X(Vec3, ring_before_N, {}, "and at the tick before")                                                   \
  X(std::int32_t, ring_ticks, 0, "until it has ended, and the next touch rings")                         \
  X(std::int32_t, ring_reserved, 0, "-")

struct SafetyState {
  PALPATE_STATE_FIELDS_OF(PALPATE_SAFETY_STATE)
};

// Largest number of each pool's entries used since reset: told in every record, read by no tick.
struct HighWater {
  std::int32_t contacts = 0, regions = 0, traversal_stack = 0, gjk_support_calls = 0;
};

using Matrix6 = double[36];

#define PALPATE_LIVE_STATE(X)                                           \
  X(double, stiffness, 1, "of the body, as a factor of what was baked") \
  X(double, friction, 1, "of its friction")                             \
  X(double, force_limit, 1, "of the largest force and torque")          \
  X(double, coupling, 1, "of the virtual coupling")                     \
  X(std::int32_t, moves, 0, "1: one of them changed in this tick")      \
  X(std::int32_t, changed, 0, "1: one of them is not 1")

// Live settings as they act now (rt_core/live.h).
struct SettingsState {
  PALPATE_STATE_FIELDS_OF(PALPATE_LIVE_STATE)
};

#define PALPATE_LATE_DEVICE(X)                                                          \
  X(std::int32_t, samples, 0, "in a row that showed a longer delay than stated")        \
  X(std::int32_t, least, 0, "commands the device was behind in each of them, at least") \
  X(std::int32_t, ticks, 0, "delay that counts; 0: as stated")                          \
  X(std::int32_t, moves, 0, "1: the factor changed in this tick")                       \
  X(double, coupling, 1, "factor of the coupling for it")

// What the device's echo says of its delay (safety/late_device.h).
struct LateDevice {
  PALPATE_STATE_FIELDS_OF(PALPATE_LATE_DEVICE)
};

// The tool that a hand moves by its device: of one hand the fields of State itself.
#define PALPATE_TOOL_STATE(X)                                                                           \
  X(Pose, device_w, {}, "of the handle: the last accepted sample, smoothed within the encoder's step")  \
  X(Pose, device_previous_w, {}, "of the one before")                                                   \
  X(Pose, tool_w, {}, "at which this tick's contact was evaluated")                                     \
  X(Pose, tool_previous_w, {}, "and the last tick's")                                                   \
  X(Matrix6, contact_stiffness, {}, "tangent (force, torque about the tool's origin), row-major")       \
  X(std::int32_t, started, 0, "0: the next sample is the first")                                        \
  X(std::int32_t, rejected_ticks, 0, "consecutive samples found implausible")                           \
  X(Pose, told_w, {}, "of the last accepted sample, as it came")                                        \
  X(ObservedMotion, observed_m, {}, "by which device_w goes on between the encoder's steps")            \
  X(ObservedMotion, observed_rad, {}, "and turns")                                                      \
  X(EdgeMemory, edges_m, {}, "of the encoder's edges, where device_w follows them")                     \
  X(EdgeMemory, edges_rad, {}, "and where it turns by them")                                            \
  X(HandleTrack, track, {}, "that device_w goes on to from its edges while what it feels is soft")      \
  X(Real, feels_N_per_m, 0, "the stiffest along any line, of the last tick; 0: nothing, or not told")   \
  X(Vec3, hand_velocity_m_per_s, {}, "of the handle, smoothed: bridges lost samples")                   \
  X(std::int32_t, unseen_ticks, 0, "consecutive ticks without a sample that tells where the handle is") \
  X(std::int32_t, apart, 0, "1: samples came anew, the coupling's end does not stand at the handle")    \
  X(Vec3, seat_m, {}, "from the handle to the coupling's end then")                                     \
  X(Vec3, seat_rad, {}, "and its turn")                                                                 \
  X(SafetyState, safety, {}, "memory of the last gate")

// The other one of two tools. Its pieces' contacts have Contact::hand and Region::hand as it has.
#define PALPATE_OTHER_TOOL(X)                                                    \
  PALPATE_TOOL_STATE(X)                                                          \
  X(std::int32_t, hand, 1, "0: State's own fields are those of the second tool") \
  X(std::int32_t, reserved, 0, "-")

struct OtherTool {
  PALPATE_STATE_FIELDS_OF(PALPATE_OTHER_TOOL)
};

#define PALPATE_STATE_FIELDS(X)                                                                                 \
  X(std::uint64_t, tick, 0, "ticks since reset")                                                                \
  PALPATE_TOOL_STATE(X)                                                                                         \
  X(Pose, second_w, {}, "of the second device's handle at that sample, where it holds the body")                \
  X(Vec3, relaxed_rootJ, {}, "how far each relaxation term has yielded: root of twice an energy")               \
  X(double, followed_rootJ, 0, "how far what rubs inside the body has followed")                                \
  X(double, stale_share, 0, "part of the ticks, lately, that had no fresh sample")                              \
  X(std::uint32_t, next_region_id, 1, "of the next region to be born")                                          \
  X(std::int32_t, first_point, 0, "tool point with which the search begins: where the last tick's share ended") \
  X(SettingsState, live, {}, "settings that may change during a run")                                           \
  X(LateDevice, late, {}, "delay of the device beyond the stated")
#define PALPATE_STATE_POOLS(X)                                                                              \
  X(PointState, point, model.sizes.n_tool_point, point.size(), "one for each tool point")                   \
  X(Region, region, kMaxRegions, region.size(), "by slot")                                                  \
  X(OtherTool, other_tool, model.params.articulation == Articulation::kTwoTools ? 1 : 0, other_tool.size(), \
    "of two hands")

#define PALPATE_DAMPED_STEP(X)                                             \
  X(double, asked, 0, "how far it was to go")                              \
  X(double, held, 0, "and the part of that which it did not go")           \
  X(std::int32_t, turned_ticks, 0, "lately, in which it was to turn back") \
  X(std::int32_t, reserved, 0, "-")

// What a step from tick to tick remembers that must not go to and fro (contact/elastic/damped_step.h).
struct DampedStep {
  PALPATE_STATE_FIELDS_OF(PALPATE_DAMPED_STEP)
};

using ByAxis = double[2];

#define PALPATE_PLACE_STEP(X)                                  \
  X(DampedStep, along_m, {}, "of the place on the tip's axis") \
  X(DampedStep, across_m, {}, "and on a plate's other")        \
  X(ByAxis, beside_m, {}, "along both from PointState::closest_w")

// What the place of a line or plate remembers (contact/elastic/line_place.h).
struct PlaceStep {
  PALPATE_STATE_FIELDS_OF(PALPATE_PLACE_STEP)
};

#define PALPATE_ELASTIC_STATE(X)                             \
  X(std::int32_t, moved, 0, "1: some amplitude is not zero") \
  X(std::int32_t, reserved, 0, "-")                          \
  X(double, swept_m, 0, "no place of the surface moved farther in the last tick")
#define PALPATE_ELASTIC_POOLS(X)                                                                      \
  X(double, soft_rootJ, model.params.elastic_soft, soft_rootJ.size(), "amplitudes of the soft modes") \
  X(double, step_rootJ, model.params.elastic_soft, step_rootJ.size(),                                 \
    "their last change, with which the next tick begins")                                             \
  X(DampedStep, mode, model.params.elastic_soft, mode.size(), "and how it is damped")                 \
  X(PlaceStep, place, model.params.elastic_soft > 0 ? model.sizes.n_tool_point : 0, place.size(),     \
    "of each tip that touches")

// Shape of an elastic body: where the next tick begins.
struct ElasticFields {
  PALPATE_STATE_FIELDS_OF(PALPATE_ELASTIC_STATE)
};
struct ElasticState : ElasticFields {
  PALPATE_STATE_GROUP_OF(ElasticFields, PALPATE_ELASTIC_POOLS)
};

// X(type, name, meaning): memory of the methods of contact, and of the tool.
#define PALPATE_METHOD_STATES(X)                      \
  X(NodalState, nodal, "memory of the nodes' method") \
  X(ElasticState, elastic, "memory of the elastic method")
#define PALPATE_STATE_GROUPS(X) \
  PALPATE_METHOD_STATES(X)      \
  X(ArticulationState, articulation, "joints of the tool")

struct StateFields {
  PALPATE_STATE_FIELDS_OF(PALPATE_STATE_FIELDS)
};
struct State : StateFields {
  PALPATE_STATE_GROUP_OF(StateFields, PALPATE_STATE_POOLS)
#define PALPATE_STATE_MEMBER(type, name, meaning) type name;
  PALPATE_STATE_GROUPS(PALPATE_STATE_MEMBER)
#undef PALPATE_STATE_MEMBER
  HighWater high_water;
  std::uint64_t bytes = 0;  // of the block that this begins

  // The visitor gets everything that can influence a later tick.
  template <class Visitor>
  void visit_all(Visitor& visitor) const PALPATE_RT_IF(Visitor::kRealTime) {
    visit(visitor);
#define PALPATE_STATE_MEMBER(type, name, meaning) visit_value(visitor, #name, name);
    PALPATE_STATE_GROUPS(PALPATE_STATE_MEMBER)
#undef PALPATE_STATE_MEMBER
  }
};

// Where a tool point's centre stands over the smooth surface (surface/smooth_foot.h). Written by find_rows when the
// model has corner normals; indexed by piece: such tools have one point per piece at most.
struct SurfaceFoot {
  Vec3 centre_w;  // of the tool point
  std::int32_t triangle = -1;
  Real weight[3] = {};     // area coordinates of the foot
  Vec3 gradient_per_m[3];  // of the area coordinates when the centre moves; zero where the foot is held
};

// What a tick finds of the other one of two tools, as Scratch has it of a hand's only one.
struct OtherFound {
  Wrench contact_wrench_w;
  ContactStiffness stiffness, told_besides;
  Pose tool_corrected_w, grip_w;
};

struct Scratch {
  std::uint32_t status = 0;
  std::int32_t contact_count = 0;
  Pool<Contact> contact;    // kMaxContacts
  Pool<SurfaceFoot> foot;   // by piece
  Wrench palm_w;            // hand only: see Output
  Wrench contact_wrench_w;  // sum over regions, on the tool, about the tool's origin
  double energy_J = 0;
  double residual_m = 0;
  std::int32_t surface_work = 0;   // boxes and triangles this tick looked at: Work::looks
  std::int32_t support_calls = 0;  // of its overlap tests: Work::supports
  Work work;                       // what else it did so far
  RowsByRegion rows;               // points, tips: written by solve
  RegionSystem system;             // of the region solver
  ContactStiffness stiffness;      // of normal loads so far
  ContactStiffness told_besides;   // what a device that evaluates the local model is told besides the tangent
  std::int32_t driven = 0;         // the tool's pose is given, nobody holds it by a spring
  double strain = 0;               // largest at the gauges (nodal)
  Pose tool_corrected_w;           // where the tool balances
  Pose grip_w;                    // where the coupling is held: the handle, or as far towards it as the device can pull
  std::int32_t held_by_hand = 0;  // Drive::kDevice: forces and steps are bounded
  OtherFound other;               // of the second of two tools
  Pool<std::byte> own;            // of the scene's method, as it lays it out (contact/contact.h)
  std::uint64_t bytes = 0;        // of the block that this begins
};

// Hash of every name and size in the tables: two builds that disagree about one of them have different hashes.
constexpr std::uint64_t state_layout_hash() noexcept {
  std::uint64_t hash = State::layout(kLayoutSeed);
#define PALPATE_STATE_MEMBER(type, name, meaning) hash = layout_with<type>(hash, #name);
  PALPATE_STATE_GROUPS(PALPATE_STATE_MEMBER)
#undef PALPATE_STATE_MEMBER
  return hash;
}

// Bytes of the block that a scene's State or Scratch needs. docs/image_format.md tells what they come to.
std::size_t state_bytes(const Model& model) noexcept;
std::size_t scratch_bytes(const Model& model) noexcept;
// Makes a State or Scratch at the start of `block`, which holds at least state_bytes() or scratch_bytes() and is
// aligned to Arena::kAlignment. A State is then as after reset(); what a Scratch holds is left as it was.
State& create_state(const Model& model, void* block) noexcept;
Scratch& create_scratch(const Model& model, void* block) noexcept;
// Whether `state` is laid out as create_state() would for this model: what was read from a file is checked by it first.
bool is_laid_out_for(const Model& model, const State& state) noexcept;
// Copies a whole block onto another of the same layout: snapshot, restore, rollback.
void copy_state(const State& from, State& to) PALPATE_RT;
// Resets to the state before the first tick. Bound: the block.
void reset(State& state) PALPATE_RT;
// Drops what was in contact: points, regions, what the methods remember. Bound: the block.
void forget_contact(State& state) PALPATE_RT;
// Canonical hash of everything that can influence a later tick, field by field, never padding or unused entries.
std::uint64_t hash_state(const State& state) PALPATE_RT;

}  // namespace palpate
