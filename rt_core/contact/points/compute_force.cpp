// Stage `force`. Reads scratch.contact, state.tool*, the identity part of state.region; writes the force part of
// state.region, contact.force_N and weight, state.contact_stiffness, scratch.contact_wrench_w, energy_J, residual_m.
// Instructions per tick with the coupled solve (callgrind, gcc 12 -O2, 2026-11-21): 12 k for one region of 16 contacts,
// 150 k for 16 regions of 64 contacts, of which 90 k are the solve.
#include "rt_core/contact/contact_stiffness.h"
#include "rt_core/contact/far_field.h"
#include "rt_core/contact/friction/region_friction.h"
#include "rt_core/contact/nodes/nodal.h"
#include "rt_core/contact/points/coupled_regions.h"
#include "rt_core/contact/region_output.h"
#include "rt_core/contact/regions/sort_contacts.h"
#include "rt_core/contact/tips/compute_response.h"
#include "rt_core/skeleton/transfer.h"
#include "rt_core/stages.h"
#include "rt_core/tool/articulate.h"
#include "rt_core/tool/carrier.h"

namespace palpate {

namespace {

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
void add_transferred(const Model& model, State& state, Scratch& scratch, const SortedContacts& sorted) PALPATE_RT {
  Real added[kMaxRegions] = {};
  if (!add_transferred_forces(model, state, sorted.slot, sorted.region_count, added))
    scratch.status |= Status::kSkeletonDegenerate;
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

// Friction of one region: its tangential spring is the points' own law.
void slide_on_points(const Model& model, const State& state, Region& region, const RegionContacts& contacts,
                     Real self_compliance, ContactStiffness& stiffness) PALPATE_RT {
  region.depth_equivalent_m = law_depth_m(contact_law(model.params), region.normal_force_N);
  FrictionLoad load;
  // With the surface yielding under the region, its stiffness is that of the two springs in series.
  load.tangent_N_per_m = region.tangent_N_per_m / (1.0 + self_compliance * region.tangent_N_per_m);
  const FrictionParameters parameters = friction_parameters(model.params);
  const Real tangent = law_tangent_N_per_m(parameters.contact, region.depth_equivalent_m);
  load.depth_rate = tangent > 0 ? load.tangent_N_per_m / tangent : 1.0;
  slide(model, state, parameters, contacts, load, region, stiffness);
}

}  // namespace

void compute_force(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  if (is_nodal(model)) return compute_nodal_force(model, state, scratch);
  clear_outputs(state, scratch);
  SortedContacts sorted;
  if (is_finite(state.tool_w)) sort_contacts(state, scratch, sorted);
  clear_idle_regions(state, sorted);
  if (sorted.region_count == 0) {
    if (is_articulated(model)) load_pieces(model, state, scratch);
    return;
  }
  if (static_cast<ResponseLaw>(model.params.response_law) != ResponseLaw::kPoints) {
    return compute_response(model, state, scratch, sorted);
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
  if (coupling == CouplingLaw::kTemporal) add_transferred(model, state, scratch, sorted);
  for (std::int32_t r = 0; r < sorted.region_count; ++r) {  // bound: kMaxRegions
    Region& region = state.region[sorted.slot[r]];
    slide_on_points(model, state, region, sorted.contacts[r], scratch.vector[kSelfCompliance][r], stiffness);
    scratch.contact_wrench_w.force_N += region.wrench_w.force_N;
    scratch.contact_wrench_w.torque_Nm += region.wrench_w.torque_Nm;
    scratch.energy_J += region.energy_J;
  }
  store(stiffness, state.contact_stiffness);
  if (is_articulated(model)) load_pieces(model, state, scratch);
}

}  // namespace palpate
