// Stage `force`. Reads scratch.contact, state.tool*, the identity part of state.region; writes the force part of
// state.region, contact.force_N and weight, state.contact_stiffness, scratch.contact_wrench_w, energy_J, residual_m.
// Instructions per tick with the coupled solve (callgrind, gcc 12 -O2, 2026-11-21): 12 k for one region of 16 contacts,
// 150 k for 16 regions of 64 contacts, of which 90 k are the solve.
#include "rt_core/articulate/articulate.h"
#include "rt_core/articulate/carrier.h"
#include "rt_core/deform/transfer.h"
#include "rt_core/force/contact_stiffness.h"
#include "rt_core/force/coupled_regions.h"
#include "rt_core/force/far_field.h"
#include "rt_core/force/friction.h"
#include "rt_core/force/sort_contacts.h"
#include "rt_core/stages.h"

namespace palpate {

namespace {

// A region out of contact exerts nothing but remembers its stretch until its slot is freed (a bounce keeps its friction
// history); an empty slot remembers nothing.
void clear_force(Region& region) PALPATE_RT {
  region.normal_force_N = 0;
  region.friction_force_w = {};
  region.wrench_w = {};
  region.depth_equivalent_m = 0;
  region.far_field_m = 0;
  region.energy_J = 0;
  region.tangent_N_per_m = 0;
  if (region.id != 0) return;
  region.stretch_w = {};
  region.tangential_k_N_per_m = 0;
  region.friction = FrictionMode::kFree;
  region.lean_normal_tool = {};
}

void clear_outputs(State& state, Scratch& scratch) PALPATE_RT {
  scratch.contact_wrench_w = {};
  scratch.energy_J = 0;
  scratch.residual_m = 0;
  for (Real& entry : state.contact_stiffness) entry = 0;  // bound: 36
  const std::int32_t contacts = scratch.contact_count < kMaxContacts ? scratch.contact_count : kMaxContacts;
  for (std::int32_t i = 0; i < contacts; ++i) scratch.contact[i].force_N = 0;  // bound: kMaxContacts
}

// Regions without a usable contact exert nothing.
void clear_idle_regions(State& state, const SortedContacts& sorted) PALPATE_RT {
  bool busy[kMaxRegions] = {};
  for (std::int32_t r = 0; r < sorted.region_count; ++r) busy[sorted.slot[r]] = true;  // bound: kMaxRegions
  for (std::int32_t s = 0; s < kMaxRegions; ++s) {                                     // bound: kMaxRegions
    if (!busy[s]) clear_force(state.region[s]);
  }
}

Vec3 usual_normal(const Region& region, const RegionContacts& contacts) PALPATE_RT {
  return squared_norm(region.normal_w) > 0.5 ? region.normal_w : contacts[0].normal_w;
}

// Where a region leans on the body, once, at its first touch: from the depths of the rest surface. Fixed to the tool
// from then on, so that the compliance between two regions of a rigid tool is a constant of their common life. Were it
// to follow the centres of pressure, its change under load, F.dC F / 2, would be work that no force renders: a compass
// sliding on a heart gave back 4e-6 J in a loop (measured 2026-11-21). Fingers move against one another, so for an
// articulated tool it is the body that the place is fixed to: constant again, at the price of a far field that stays
// behind when a finger slides.
void set_lean(const Model& model, const State& state, Region& region, const RegionContacts& contacts) PALPATE_RT {
  if (squared_norm(region.lean_normal_tool) > 0.5) return;
  const CubicLaw law = contact_law(model.params);
  for (std::int32_t k = 0; k < contacts.count; ++k) {  // bound: points
    contacts[k].force_N = contacts[k].weight * law_force_N(law, contacts[k].depth_m);
  }
  const RegionCentre centre = region_centre(contacts, usual_normal(region, contacts));
  const Pose frame_w = is_articulated(model) ? Pose{} : state.tool_w;
  region.lean_tool_m = inverse_transform(frame_w, centre.position_w);
  region.lean_normal_tool = rotate(conjugate(frame_w.orientation), centre.normal_w);
}

void fill_compliance(const Model& model, const State& state, const SortedContacts& sorted,
                     Real* compliance) PALPATE_RT {
  const std::int32_t n = sorted.region_count;
  const Real scale = far_field_scale_m2_per_N(model.params.youngs_modulus_Pa, model.params.poisson_ratio);
  const Real core = model.params.far_field_radius_m;
  compliance[0] = scale / core;  // all there is to say about a single region
  if (n == 1) return;
  for (std::int32_t i = 0; i < n; ++i) {  // bound: kMaxRegions^2 / 2
    const Region& a = state.region[sorted.slot[i]];
    for (std::int32_t j = 0; j <= i; ++j) {
      const Region& b = state.region[sorted.slot[j]];
      const Real c = far_field_compliance_m_per_N(scale, core, a.lean_tool_m, a.lean_normal_tool, b.lean_tool_m,
                                                  b.lean_normal_tool);
      compliance[i * n + j] = c;
      compliance[j * n + i] = c;
    }
  }
}

// scratch.vector rows.
constexpr int kShift = 0, kForce = 1, kRootTangent = 2, kResidual = 3, kStep = 4, kSelfCompliance = 5;

// Shift of the surface under each region by all of them, and by one newton of its own.
void couple(const Model& model, State& state, Scratch& scratch, const SortedContacts& sorted) PALPATE_RT {
  const std::int32_t n = sorted.region_count;
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions
    scratch.vector[kShift][r] = 0;
    scratch.vector[kSelfCompliance][r] = 0;
  }
  if (static_cast<CouplingLaw>(model.params.coupling_law) != CouplingLaw::kCoupled) return;
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions
    set_lean(model, state, state.region[sorted.slot[r]], sorted.contacts[r]);
  }
  fill_compliance(model, state, sorted, scratch.matrix[0]);
  const CoupledWork work{scratch.matrix[0],
                         scratch.matrix[1],
                         scratch.vector[kShift],
                         scratch.vector[kForce],
                         scratch.vector[kRootTangent],
                         scratch.vector[kResidual],
                         scratch.vector[kStep]};
  const CoupledResult result =
      solve_coupled_regions(contact_law(model.params), {sorted.contacts, static_cast<std::size_t>(n)}, work);
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions
    scratch.vector[kSelfCompliance][r] = scratch.matrix[0][r * n + r];
  }
  scratch.residual_m = result.residual_m;
  if (result.singular) scratch.status |= Status::kCouplingSingular;
  if (!(result.residual_m <= kCoupledTolerance_m)) scratch.status |= Status::kNotConverged;
}

// Stretch carried to the new tangent plane by the smallest rotation of the normal, its length kept.
Vec3 carried(Vec3 stretch, Vec3 from_normal, Vec3 to_normal) PALPATE_RT {
  const Vec3 turned = tangential_part(rotate(rotation_between(from_normal, to_normal), stretch), to_normal);
  const Real length = norm(turned);
  return length > 1e-15 ? (norm(stretch) / length) * turned : Vec3{};
}

// Normal load of one region, and where it acts. The stretch follows the turn of the normal; a centre that wanders over
// the surface (rolling) does not change it.
void press(const Model& model, const State& state, Scratch& scratch, Region& region, const RegionContacts& contacts,
           Real shift_m, ContactStiffness& stiffness) PALPATE_RT {
  const RegionLoad load = region_load(contact_law(model.params), contacts, shift_m, state.tool_w.position_m);
  const RegionCentre centre = region_centre(contacts, usual_normal(region, contacts));
  region.stretch_w = carried(region.stretch_w, region.normal_w, centre.normal_w);
  region.centre_w = centre.position_w;
  region.normal_w = centre.normal_w;
  region.normal_force_N = max_of(dot(load.resultant_w, centre.normal_w), 0.0);
  region.wrench_w = {load.resultant_w, load.torque_w};
  region.far_field_m = shift_m;
  region.energy_J = load.energy_J + 0.5 * load.force_N * shift_m;
  region.tangent_N_per_m = stiffness_along_N_per_m(load.stiffness, centre.normal_w);
  add_to(stiffness, load.stiffness);
  if (load.depth_max_m > model.params.max_depth_m) scratch.status |= Status::kDepthBeyondRange;
}

// The paper's mutual contributions (Luo & Xiao 2006): every region born later adds, along the normal, what its skeleton
// carries over. All are taken from the regions' own normal forces (and last tick's friction) before any is added.
void add_transferred(const Model& model, State& state, const SortedContacts& sorted) PALPATE_RT {
  Real added[kMaxRegions] = {};
  add_transferred_forces(model, state, sorted.slot, sorted.region_count, added);
  for (std::int32_t i = 0; i < sorted.region_count; ++i) {  // bound: kMaxContacts points
    Region& region = state.region[sorted.slot[i]];
    const Real own = region.normal_force_N;
    if (!(own > 0)) continue;
    region.normal_force_N = max_of(own + added[i], 0.0);
    const Real scale = region.normal_force_N / own;
    region.wrench_w = {scale * region.wrench_w.force_N, scale * region.wrench_w.torque_Nm};
    for (std::int32_t k = 0; k < sorted.contacts[i].count; ++k) sorted.contacts[i][k].force_N *= scale;
  }
}

// Motion since the last tick of the material at `point` that moves rigidly from `before` to `now`.
Vec3 carried_motion(const Pose& before, const Pose& now, Vec3 point) PALPATE_RT {
  return point - transform(before, inverse_transform(now, point));
}

// Motion since the last tick of the tool material that is at `point` now, rotation included: exact where one piece
// touches; the mean by force where pieces that move against one another share the region.
Vec3 material_motion(const Model& model, const State& state, const RegionContacts& contacts, Vec3 point) PALPATE_RT {
  if (!is_articulated(model)) return carried_motion(state.tool_previous_w, state.tool_w, point);
  Vec3 sum;
  Real total = 0;
  std::int32_t last = -1;
  Vec3 motion;
  for (std::int32_t k = 0; k < contacts.count; ++k) {  // bound: points
    const std::int32_t piece = model.tool_point[static_cast<std::size_t>(contacts[k].point)].piece;
    if (piece != last) {
      motion = carried_motion(carrier_previous_w(model, state, piece), carrier_w(model, state, piece), point);
      last = piece;
    }
    sum += contacts[k].force_N * motion;
    total += contacts[k].force_N;
  }
  return total > 0 ? (1.0 / total) * sum : motion;
}

FrictionForce drag(const Model& model, const State& state, Region& region, const RegionContacts& contacts,
                   Real self_compliance) PALPATE_RT {
  const FrictionParameters parameters = friction_parameters(model.params);
  FrictionLoad load;
  load.step_w = material_motion(model, state, contacts, region.centre_w);
  load.normal_w = region.normal_w;
  load.force_N = region.normal_force_N;
  load.depth_m = region.depth_equivalent_m;
  // With the surface yielding under the region, its stiffness is that of the two springs in series.
  load.tangent_N_per_m = region.tangent_N_per_m / (1.0 + self_compliance * region.tangent_N_per_m);
  const Real tangent = law_tangent_N_per_m(parameters.contact, load.depth_m);
  load.depth_rate = tangent > 0 ? load.tangent_N_per_m / tangent : 1.0;
  FrictionMemory memory{region.stretch_w, region.tangential_k_N_per_m, region.friction};
  const FrictionForce result = friction_step(parameters, load, memory);
  region.stretch_w = memory.stretch_w;
  region.tangential_k_N_per_m = memory.stiffness_N_per_m;
  region.friction = memory.mode;
  return result;
}

void add_tangential_stiffness(ContactStiffness& stiffness, const FrictionForce& friction, Vec3 normal,
                              Vec3 arm) PALPATE_RT {
  const Vec3 axis = abs_of(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 any = unit_or(tangential_part(axis, normal), {});
  const Vec3 along = unit_or(friction.direction_w, any), across = cross(normal, along);
  add_spring(stiffness, friction.along_N_per_m, along, cross(arm, along));
  add_spring(stiffness, friction.across_N_per_m, across, cross(arm, across));
}

// Friction of one region at its centre of pressure, added to its wrench and energy.
void slide(const Model& model, const State& state, Region& region, const RegionContacts& contacts, Real self_compliance,
           ContactStiffness& stiffness) PALPATE_RT {
  region.depth_equivalent_m = law_depth_m(contact_law(model.params), region.normal_force_N);
  const FrictionForce friction = drag(model, state, region, contacts, self_compliance);
  const Vec3 arm = region.centre_w - state.tool_w.position_m;
  const Vec3 force = friction.force_w + friction.normal_gain_N * region.normal_w;
  region.normal_force_N += friction.normal_gain_N;
  region.friction_force_w = friction.force_w;
  region.wrench_w.force_N += force;
  region.wrench_w.torque_Nm += cross(arm, force);
  region.energy_J += friction.energy_J;
  region.origin_w = region.centre_w - region.stretch_w;
  add_tangential_stiffness(stiffness, friction, region.normal_w, arm);
}

}  // namespace

void compute_force(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  clear_outputs(state, scratch);
  SortedContacts sorted;
  if (is_finite(state.tool_w)) sort_contacts(state, scratch, sorted);
  clear_idle_regions(state, sorted);
  if (sorted.region_count == 0) {
    if (is_articulated(model)) load_pieces(model, state, scratch);
    return;
  }

  const ContactWeight weight = static_cast<ContactWeight>(model.params.contact_weight);
  for (std::int32_t r = 0; r < sorted.region_count; ++r) {  // bound: kMaxContacts points
    weigh_contacts(weight, sorted.contacts[r]);
  }
  couple(model, state, scratch, sorted);
  ContactStiffness stiffness;
  for (std::int32_t r = 0; r < sorted.region_count; ++r) {  // bound: kMaxContacts points
    press(model, state, scratch, state.region[sorted.slot[r]], sorted.contacts[r], scratch.vector[kShift][r],
          stiffness);
  }
  const CouplingLaw coupling = static_cast<CouplingLaw>(model.params.coupling_law);
  if (coupling == CouplingLaw::kTemporal) add_transferred(model, state, sorted);
  for (std::int32_t r = 0; r < sorted.region_count; ++r) {  // bound: kMaxRegions
    Region& region = state.region[sorted.slot[r]];
    slide(model, state, region, sorted.contacts[r], scratch.vector[kSelfCompliance][r], stiffness);
    scratch.contact_wrench_w.force_N += region.wrench_w.force_N;
    scratch.contact_wrench_w.torque_Nm += region.wrench_w.torque_Nm;
    scratch.energy_J += region.energy_J;
  }
  store(stiffness, state.contact_stiffness);
  if (is_articulated(model)) load_pieces(model, state, scratch);
}

}  // namespace palpate
