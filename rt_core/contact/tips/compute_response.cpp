#include "rt_core/contact/tips/compute_response.h"

#include "rt_core/tool/articulate.h"
#include "rt_core/tool/carrier.h"

#include "rt_core/contact/far_field.h"
#include "rt_core/contact/friction/region_friction.h"
#include "rt_core/contact/region_output.h"
#include "rt_core/contact/tips/travel.h"

namespace palpate {

namespace {

// The tips in contact, by region. The loader refuses more tool points than pieces for these laws.
struct TipLoad {
  Tip tip[kMaxPieces];
  TipRegion region[kMaxRegions];
};

const SurfaceFoot& foot_of(const Model& model, const Scratch& scratch, const Contact& contact) PALPATE_RT {
  return scratch.foot[model.tool_point[static_cast<std::size_t>(contact.point)].piece];
}

Tip make_tip(const Model& model, const Scratch& scratch, const Contact& contact) PALPATE_RT {
  Tip tip;
  tip.depth_m = contact.depth_m;
  tip.tabulated = static_cast<ResponseLaw>(model.params.response_law) != ResponseLaw::kTip;
  if (tip.tabulated) {
    const SurfaceFoot& foot = foot_of(model, scratch, contact);
    tip.table = table_law(model, foot.triangle, foot.weight);
  } else {
    tip.local = local_law(model, model.tool_point[static_cast<std::size_t>(contact.point)].piece);
  }
  return tip;
}

// The far field under a region is that of its deepest tip.
FarField far_field_of(const Model& model, const RegionContacts& contacts) PALPATE_RT {
  if (static_cast<ResponseLaw>(model.params.response_law) != ResponseLaw::kTip) return {};
  std::int32_t deepest = 0;
  for (std::int32_t k = 1; k < contacts.count; ++k) {  // bound: tips
    if (contacts[k].depth_m > contacts[deepest].depth_m) deepest = k;
  }
  const auto point = static_cast<std::size_t>(contacts[deepest].point);
  const TipLaw& law = model.tip_law[static_cast<std::size_t>(model.tool_point[point].piece)];
  return {law.c0_m_per_N, law.c1_m_per_N2, law.force_max_N};
}

void gather(const Model& model, const Scratch& scratch, const SortedContacts& sorted, TipLoad& load) PALPATE_RT {
  std::int32_t next = 0;
  for (std::int32_t r = 0; r < sorted.region_count; ++r) {  // bound: kMaxPieces tips
    const RegionContacts& contacts = sorted.contacts[r];
    load.region[r] = {&load.tip[next], 0, far_field_of(model, contacts)};
    for (std::int32_t k = 0; k < contacts.count && next < kMaxPieces; ++k) {
      load.tip[next++] = make_tip(model, scratch, contacts[k]);
      load.region[r].count += 1;
    }
  }
}

// Where a region leans on the body, once and fixed to the tool: see set_lean in compute_force.cpp.
void set_lean(const State& state, Region& region, const Contact& contact) PALPATE_RT {
  if (squared_norm(region.lean_normal_tool) > 0.5) return;
  region.lean_tool_m = inverse_transform(state.tool_w, contact.position_w);
  region.lean_normal_tool = rotate(conjugate(state.tool_w.orientation), contact.normal_w);
}

// Coupling of two regions: as stated for the pair of pieces, otherwise Boussinesq's far field.
void fill_pair(const Model& model, const State& state, const SortedContacts& sorted, std::int32_t i, std::int32_t j,
               Real* c, Real* h) PALPATE_RT {
  const std::int32_t n = sorted.region_count;
  const auto piece_of = [&](std::int32_t r) PALPATE_RT {
    return model.tool_point[static_cast<std::size_t>(sorted.contacts[r][0].point)].piece;
  };
  const std::int32_t a = piece_of(i), b = piece_of(j);
  h[i * n + j] = h[j * n + i] = 0;
  for (const TipPair& pair : model.tip_pair) {  // bound: kMaxTipPairs
    const bool same = pair.piece_a == a && pair.piece_b == b, swapped = pair.piece_a == b && pair.piece_b == a;
    if (!same && !swapped) continue;
    c[i * n + j] = c[j * n + i] = pair.c_m_per_N;
    h[i * n + j] = same ? pair.h_ab_m_per_N2 : pair.h_ba_m_per_N2;
    h[j * n + i] = same ? pair.h_ba_m_per_N2 : pair.h_ab_m_per_N2;
    return;
  }
  const Region &u = state.region[sorted.slot[i]], &v = state.region[sorted.slot[j]];
  const Real scale = far_field_scale_m2_per_N(model.params.youngs_modulus_Pa, model.params.poisson_ratio);
  c[i * n + j] = c[j * n + i] = far_field_compliance_m_per_N(scale, model.params.far_field_radius_m, u.lean_tool_m,
                                                             u.lean_normal_tool, v.lean_tool_m, v.lean_normal_tool);
}

// scratch.vector rows and scratch.matrix blocks.
constexpr int kShift = 0, kForce = 1, kRootTangent = 2, kResidual = 3, kStep = 4, kTrial = 5;
constexpr int kCompliance = 0, kFactor = 1, kSecondOrder = 2;

// Shift of the surface under every region; adds the energy held between regions.
void shift_regions(const Model& model, State& state, Scratch& scratch, const SortedContacts& sorted,
                   const TipLoad& load) PALPATE_RT {
  const std::int32_t n = sorted.region_count;
  const bool coupled = static_cast<CouplingLaw>(model.params.coupling_law) == CouplingLaw::kCoupled;
  Real* shift = scratch.vector[kShift];
  if (n == 1 || !coupled) {
    for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions
      const TravelResult result = solve_travel(load.region[r]);
      shift[r] = result.shift_m;
      scratch.residual_m = max_of(scratch.residual_m, result.residual_m);
    }
  } else {
    for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions^2 / 2
      set_lean(state, state.region[sorted.slot[r]], sorted.contacts[r][0]);
      for (std::int32_t j = 0; j < r; ++j) {
        fill_pair(model, state, sorted, r, j, scratch.matrix[kCompliance], scratch.matrix[kSecondOrder]);
      }
    }
    const TipCoupling coupling{scratch.matrix[kCompliance], scratch.matrix[kSecondOrder]};
    const TipWork work{scratch.matrix[kFactor],   shift,
                       scratch.vector[kForce],    scratch.vector[kRootTangent],
                       scratch.vector[kResidual], scratch.vector[kStep],
                       scratch.vector[kTrial]};
    const TipCouplingResult result = solve_coupled_travel({load.region, static_cast<std::size_t>(n)}, coupling, work);
    scratch.residual_m = result.residual_m;
    if (result.singular) scratch.status |= Status::kCouplingSingular;
    scratch.energy_J += coupling_energy_J(n, coupling, work.force);
  }
  if (!(scratch.residual_m <= kTravelTolerance_m)) scratch.status |= Status::kNotConverged;
}

bool beyond_range(const Tip& tip, Real e) PALPATE_RT {
  if (!tip.tabulated) return e > tip.local.tip->depth_max_m;
  const Real last = tip.table.knot[tip.table.knots - 1];
  return e > (tip.table.root ? last * last : last);
}

// Where curves differ from vertex to vertex the stored energy also falls along the surface: -sum E_i grad n_i. Left
// out, pressing where it is soft and lifting where it is stiff would return the difference of the energies.
Vec3 sideways_force(const Tip& tip, const SurfaceFoot& foot, Real e) PALPATE_RT {
  const TableLaw& t = tip.table;
  if (t.curve[0] == t.curve[1] && t.curve[1] == t.curve[2]) return {};
  const CornerEnergies corner = table_energies(t, e);
  return -(corner.energy_J[0] * foot.gradient_per_m[0] + corner.energy_J[1] * foot.gradient_per_m[1] +
           corner.energy_J[2] * foot.gradient_per_m[2]);
}

// Normal load of one region. Forces act at the tips' centres, which are fixed to the tool: as the field depends on the
// centres alone, it is then conservative in rotation too. (The line of action of the normal force passes through the
// foot.)
void press(const Model& model, const State& state, Scratch& scratch, Region& region, const RegionContacts& contacts,
           const TipRegion& tips, Real shift_m, ContactStiffness& stiffness) PALPATE_RT {
  const Vec3 before = region.normal_w;
  const LawPoint sum = region_at(tips, shift_m);
  const Real softening = 1.0 / (1.0 + far_slope_m_per_N(tips.far, sum.force_N) * sum.tangent_N_per_m);
  Vec3 sideways;
  region.wrench_w = {};
  region.energy_J = far_energy_J(tips.far, sum.force_N);
  for (std::int32_t k = 0; k < tips.count; ++k) {  // bound: tips
    Contact& contact = contacts[k];
    const SurfaceFoot& foot = foot_of(model, scratch, contact);
    const Real e = tips.tip[k].depth_m - shift_m;
    const LawPoint point = tip_at(tips.tip[k], e);
    contact.force_N = point.force_N;
    const Vec3 aside = tips.tip[k].tabulated ? sideways_force(tips.tip[k], foot, e) : Vec3{};
    const Vec3 force = point.force_N * contact.normal_w + aside;
    const Vec3 arm = foot.centre_w - state.tool_w.position_m;
    sideways += aside;
    region.wrench_w.force_N += force;
    region.wrench_w.torque_Nm += cross(arm, force);
    region.energy_J += tip_energy_J(tips.tip[k], e);
    add_spring(stiffness, softening * point.tangent_N_per_m, contact.normal_w, cross(arm, contact.normal_w));
    if (beyond_range(tips.tip[k], e)) scratch.status |= Status::kDepthBeyondRange;
  }
  const Vec3 usual = squared_norm(before) > 0.5 ? before : contacts[0].normal_w;
  const RegionCentre centre = region_centre(contacts, usual);
  region.stretch_w = carried(region.stretch_w, before, centre.normal_w);
  region.centre_w = centre.position_w;
  region.normal_w = centre.normal_w;
  region.normal_force_N = max_of(dot(region.wrench_w.force_N - sideways, centre.normal_w), 0.0);
  region.far_field_m = shift_m;
  region.depth_equivalent_m = region.depth_max_m;
  region.tangent_N_per_m = softening * sum.tangent_N_per_m;
}

}  // namespace

void compute_response(const Model& model, State& state, Scratch& scratch, const SortedContacts& sorted) PALPATE_RT {
  TipLoad load;
  gather(model, scratch, sorted, load);
  shift_regions(model, state, scratch, sorted, load);
  ContactStiffness stiffness;
  for (std::int32_t r = 0; r < sorted.region_count; ++r) {  // bound: kMaxRegions
    press(model, state, scratch, state.region[sorted.slot[r]], sorted.contacts[r], load.region[r],
          scratch.vector[kShift][r], stiffness);
  }
  for (std::int32_t r = 0; r < sorted.region_count; ++r) {  // bound: kMaxRegions
    Region& region = state.region[sorted.slot[r]];
    FrictionLoad rub;
    rub.tangent_N_per_m = region.tangent_N_per_m;
    slide(model, state, friction_parameters(model.params), sorted.contacts[r], rub, region, stiffness);
    scratch.contact_wrench_w.force_N += region.wrench_w.force_N;
    scratch.contact_wrench_w.torque_Nm += region.wrench_w.torque_Nm;
    scratch.energy_J += region.energy_J;
  }
  store(stiffness, state.contact_stiffness);
  if (is_articulated(model)) load_pieces(model, state, scratch);
}

}  // namespace palpate
