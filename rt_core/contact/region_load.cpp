#include "rt_core/contact/region_load.h"

#include "rt_core/contact/regions.h"
#include "rt_core/contact/relaxation.h"
#include "rt_core/lanes.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

namespace {

// Place, normal, depth and weight as two fours.
static_assert(offsetof(Contact, normal_w) == offsetof(Contact, position_w) + 24 &&
              offsetof(Contact, depth_m) == offsetof(Contact, position_w) + 48 &&
              offsetof(Contact, weight) == offsetof(Contact, position_w) + 56);

// In one of the regions `touching`, as bits, and no number of it NaN or beyond kHuge.
bool usable(std::uint32_t touching, const Contact& contact) PALPATE_RT {
  const auto slot = static_cast<std::uint32_t>(contact.region);
  if (slot >= kMaxRegions || (touching >> slot & 1) == 0) return false;
  const double* const number = &contact.position_w.x;
  const Double4 most = splat4(kHuge);
  return contact.depth_m > 0 && bits_of((abs_of(load4(number)) <= most) & (abs_of(load4(number + 4)) <= most)) == 15;
}

// A region without a usable contact exerts nothing but remembers its stretch until its slot is freed (a bounce keeps
// its friction history). Empty slots hold nothing and are left alone.
void clear_force(Region& region) PALPATE_RT {
  region.normal_force_N = 0;
  region.friction_force_w = {};
  region.wrench_w = {};
  region.depth_equivalent_m = 0;
  region.energy_J = 0;
  region.tangent_N_per_m = 0;
}

// Distance along `normal` from `centre` to the rest surface, seen from one of its points: on a sphere or a plane the
// chord from point to centre is normal to the mean of the two end normals; other smooth surfaces follow to third order.
Real height_above(const Contact& contact, Vec3 centre, Vec3 normal) PALPATE_RT {
  const Vec3 mean = contact.normal_w + normal;
  const Real slope = dot(mean, normal);
  // Where the normals differ by more than 120 degrees there is no common smooth patch.
  return slope > 0.5 ? dot(contact.position_w - centre, mean) / slope : 0.0;
}

// Stretch carried to the new tangent plane by the smallest rotation of the normal, its length kept.
Vec3 carried(Vec3 stretch, Vec3 from_normal, Vec3 to_normal) PALPATE_RT {
  const Vec3 turned = tangential_part(rotate(rotation_between(from_normal, to_normal), stretch), to_normal);
  const Real length = norm(turned);
  return length > 1e-15 ? (norm(stretch) / length) * turned : Vec3{};
}

// Motion since the last tick of the material of a piece that is at `point_w` now. Place by place: to put the two
// motions together first takes twice as much.
Vec3 motion_of_piece(const Model& model, const State& state, std::int32_t piece, Vec3 point_w) PALPATE_RT {
  Vec3 at_tool = inverse_transform(state.tool_w, point_w);
  if (is_articulated(model)) {
    const ArticulationState& a = state.articulation;
    at_tool = transform(a.motion_previous_tool[piece], inverse_transform(a.motion_tool[piece], at_tool));
  }
  return point_w - transform(state.tool_previous_w, at_tool);
}

}  // namespace

void sort_rows(State& state, Scratch& scratch) PALPATE_RT {
  RowsByRegion& rows = scratch.rows;
  rows.regions = 0;
  rows.geometric = false;
  std::int32_t contacts = scratch.contact_count < kMaxContacts ? scratch.contact_count : kMaxContacts;
  if (!is_finite(state.tool_w)) contacts = 0;
  std::int32_t region_of[kMaxContacts];
  std::int32_t count_in[kMaxRegions] = {};
  const Contact* const contact = scratch.contact.data();
  std::int32_t order[kMaxRegions];
  const std::int32_t in_contact = contact_order(state, order);
  std::uint32_t touching = 0;
  for (std::int32_t i = 0; i < in_contact; ++i) touching |= 1u << order[i];  // bound: kMaxRegions
  for (std::int32_t i = 0; i < contacts; ++i) {                              // bound: kMaxContacts
    const bool use = usable(touching, contact[i]);
    region_of[i] = use ? contact[i].region : -1;
    if (use) count_in[region_of[i]] += 1;
  }
  std::int32_t next_in[kMaxRegions] = {};
  rows.first[0] = 0;
  for (std::int32_t i = 0; i < in_contact; ++i) {  // bound: kMaxRegions
    const std::int32_t slot = order[i];
    if (count_in[slot] == 0) continue;
    next_in[slot] = rows.first[rows.regions];
    rows.slot[rows.regions++] = slot;
    rows.first[rows.regions] = next_in[slot] + count_in[slot];
  }
  for (std::int32_t i = 0; i < contacts; ++i) {  // bound: kMaxContacts
    if (region_of[i] >= 0) rows.index[next_in[region_of[i]]++] = i;
  }
  scratch.work.rows += contacts;
  scratch.work.regions += rows.regions;
  for (std::int32_t s = 0; s < kMaxRegions; ++s) {  // bound: kMaxRegions
    if (count_in[s] == 0 && state.region[s].is_live()) clear_force(state.region[s]);
  }
}

RegionCentre region_centre(const RegionRows& rows, Vec3 fallback_normal) PALPATE_RT {
  Real total = 0;
  for (std::int32_t k = 0; k < rows.count; ++k) total += rows[k].force_N;  // bound: rows
  const bool loaded = total > 0 && !rows.geometric;
  const auto share = [loaded](const Contact& c) PALPATE_RT { return loaded ? c.force_N : c.weight; };
  Vec3 moment, sum;
  total = 0;
  for (std::int32_t k = 0; k < rows.count; ++k) {  // bound: rows
    const Contact& contact = rows[k];
    moment += share(contact) * contact.position_w;
    sum += share(contact) * contact.normal_w;
    total += share(contact);
  }
  if (!(total > 0)) return {rows.count > 0 ? rows[0].position_w : Vec3{}, fallback_normal};
  const Vec3 centre = (1.0 / total) * moment;
  // Opposed normals may cancel to rounding: then there is no direction worth following.
  const Vec3 normal = norm(sum) > 1e-6 * total ? unit_or(sum, fallback_normal) : fallback_normal;
  Real height = 0;
  for (std::int32_t k = 0; k < rows.count; ++k) {  // bound: rows
    height += share(rows[k]) * height_above(rows[k], centre, normal);
  }
  return {centre + (height / total) * normal, normal};
}

RegionCentre centre_of(const Region& region, const RegionRows& rows) PALPATE_RT {
  return region_centre(rows, squared_norm(region.normal_w) > 0.5 ? region.normal_w : rows[0].normal_w);
}

void set_lean(const Model& model, const State& state, Region& region, const RegionRows& rows) PALPATE_RT {
  const RegionCentre centre = centre_of(region, rows);
  const Pose frame_w = lean_frame_w(model, state);
  region.lean_tool_m = inverse_transform(frame_w, centre.position_w);
  region.lean_normal_tool = rotate(conjugate(frame_w.orientation), centre.normal_w);
}

void press(Scratch& scratch, Region& region, const RegionRows& rows, const RegionLoad& load,
           Real coupling_J) PALPATE_RT {
  const RegionCentre centre = centre_of(region, rows);
  region.stretch_w = carried(region.stretch_w, region.normal_w, centre.normal_w);
  region.centre_w = centre.position_w;
  region.normal_w = centre.normal_w;
  region.normal_force_N = max_of(dot(load.resultant_w, centre.normal_w), 0.0);
  region.wrench_w = {load.resultant_w + load.aside_w, load.torque_w};
  region.energy_J = load.energy_J + coupling_J;
  region.hand = rows[0].hand;
  if (load.is_beyond) scratch.status |= Status::kDepthBeyondRange;
}

Vec3 material_motion(const Model& model, const State& state, const RegionRows& rows, Vec3 point_w) PALPATE_RT {
  if (!is_articulated(model)) return motion_of_piece(model, state, 0, point_w);
  Vec3 sum;
  Real total = 0;
  std::int32_t last = -1;
  Vec3 motion;
  for (std::int32_t k = 0; k < rows.count; ++k) {  // bound: rows
    const std::int32_t piece = rows[k].piece;
    if (piece != last) {
      motion = motion_of_piece(model, state, piece, point_w);
      last = piece;
    }
    sum += rows[k].force_N * motion;
    total += rows[k].force_N;
  }
  return total > 0 ? (1.0 / total) * sum : motion;
}

FrictionForce rub_region(const FrictionParameters& parameters, FrictionLoad& load, Vec3 arm_w,
                         Region& region) PALPATE_RT {
  load.normal_w = region.normal_w;
  load.force_N = region.normal_force_N;
  load.depth_m = region.depth_equivalent_m;
  FrictionMemory memory{region.stretch_w, region.tangential_k_N_per_m, region.friction};
  const FrictionForce friction = friction_step(parameters, load, memory);
  region.stretch_w = memory.stretch_w;
  region.tangential_k_N_per_m = memory.stiffness_N_per_m;
  region.friction = memory.mode;
  region.reversal_N_per_m = friction.reversal_N_per_m;
  const Vec3 force = friction.force_w + friction.normal_gain_N * region.normal_w;
  region.normal_force_N += friction.normal_gain_N;
  region.friction_force_w = friction.force_w;
  region.wrench_w.force_N += force;
  region.wrench_w.torque_Nm += cross(arm_w, force);
  region.energy_J += friction.energy_J;
  return friction;
}

TangentAxes tangent_axes(const FrictionForce& friction, Vec3 normal) PALPATE_RT {
  Vec3 along = unit_or(friction.direction_w, {});
  if (along == Vec3{}) along = unit_or(tangential_part(axis_off(normal), normal), {});
  return {along, cross(normal, along)};
}

void slide(const Model& model, const State& state, Scratch& scratch, const FrictionParameters& parameters,
           const RegionRows& rows, FrictionLoad& load, Region& region) PALPATE_RT {
  const Vec3 arm = region.centre_w - pivot_w(state, rows);
  load.step_w = material_motion(model, state, rows, region.centre_w);
  const FrictionForce friction = rub_region(parameters, load, arm, region);
  const TangentAxes axes = tangent_axes(friction, region.normal_w);
  ContactStiffness& stiffness = stiffness_of(scratch, region.hand);
  add_spring(stiffness, friction.along_N_per_m, axes.along, cross(arm, axes.along));
  add_spring(stiffness, friction.across_N_per_m, axes.across, cross(arm, axes.across));
}

void rub_tips(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  for (std::int32_t r = 0; r < scratch.rows.regions; ++r) {  // bound: kMaxRegions
    Region& region = state.region[scratch.rows.slot[r]];
    region.depth_equivalent_m = region.depth_max_m;
    FrictionLoad rub;
    rub.tangent_N_per_m = region.tangent_N_per_m;
    slide(model, state, scratch, friction_parameters(model.params), rows_of(scratch, r), rub, region);
  }
  sum_up(model, state, scratch);
}

void sum_up(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  scratch.work.rubbed += scratch.rows.regions;
  scratch.work.slid += scratch.contact_count;
  for (std::int32_t r = 0; r < scratch.rows.regions; ++r) {  // bound: kMaxRegions
    const Region& region = state.region[scratch.rows.slot[r]];
    Wrench& sum = region.hand == 0 ? scratch.contact_wrench_w : scratch.other.contact_wrench_w;
    sum.force_N += region.wrench_w.force_N;
    sum.torque_Nm += region.wrench_w.torque_Nm;
    scratch.energy_J += region.energy_J;
  }
  if (scratch.rows.regions > 0) store(scratch.stiffness, state.contact_stiffness);
  relax(model, state, scratch);
  balance_tool(model, state, scratch);
  if (!has_two_tools(model)) return;
  scratch.work.other_balances += 1;
  const OthersTurn turn(state, scratch);
  if (scratch.rows.regions > 0) store(scratch.stiffness, state.contact_stiffness);
  balance_tool(model, state, scratch);
}

}  // namespace palpate
