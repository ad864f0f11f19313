// The method `tips`: one law for each whole tip of the tool, or curves tabulated over the surface, in series with the
// body's far field (contact/tips/travel.h).

#include "rt_core/contact/contact.h"
#include "rt_core/contact/region_load.h"
#include "rt_core/contact/regions.h"
#include "rt_core/contact/tips/tip_check.h"
#include "rt_core/contact/tips/travel.h"
#include "rt_core/image_check.h"
#include "rt_core/unwritten.h"

namespace palpate {

namespace {

// A whole tip touches where its one point does: nothing of it can touch between points.
void find_rows(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  collide(model, state, scratch);
  group_points(model, state, scratch, nullptr);
}

bool beyond_range(const Tip& tip, Real e) PALPATE_RT {
  if (tip.kind != TipKind::kTable) return e > tip.local.tip->depth_max_m;
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

// As printed (Mahvash & Hayward 2002, eq. 3): F = sum n_i f_i(e) U_i, each curve along its own vertex's normal. What
// that is beside the force along the smooth normal, whose size the curves' mean has.
Vec3 printed_aside(const Model& model, const Tip& tip, const SurfaceFoot& foot, Vec3 normal_w, Real e) PALPATE_RT {
  const CornerForces corner = table_forces(tip.table, e);
  const CornerNormals& at = model.corner_normal[static_cast<std::size_t>(foot.triangle)];
  Vec3 sum;
  for (int k = 0; k < 3; ++k) {  // bound: 3
    const Real share_N = tip.table.weight[k] * corner.force_N[k];
    sum += share_N * (at.normal[k] - normal_w);
  }
  return sum;
}

// The tips in contact, by region, and what accounting asks of them. Forces act at the tips' centres, which are fixed to
// the tool: as the field depends on the centres alone, it is then conservative in rotation too. (The line of action of
// the normal force passes through the foot.) The loader refuses more tool points than pieces for these laws.
struct TipLoad : TipLaws {
  static constexpr bool kPullsAside = true;
  static constexpr bool kTellsTangent = false;
  Unwritten<Tip, kMaxPieces> tip;
  const SurfaceFoot* foot[kMaxPieces];
  const Model* model;
  const Scratch* scratch;
  TipRegion tips_of[kMaxRegions];

  Real softening(std::int32_t r, Real shift_m) const PALPATE_RT {
    const LawPoint sum = load(r, shift_m);
    return 1.0 / (1.0 + far_slope_m_per_N(region[r].far, sum.force_N) * sum.tangent_N_per_m);
  }
  RowLoad row(std::int32_t r, std::int32_t k, Real shift_m) const PALPATE_RT {
    const Tip& one = region[r].tip[k];
    const SurfaceFoot& stands = *foot[region[r].tip + k - tip.data()];
    const Real e = one.depth_m - shift_m;
    return {tip_at(one, e), tip_energy_J(one, e), stands.centre_w,
            one.kind == TipKind::kTable ? aside(r, k, one, stands, e) : Vec3{}, beyond_range(one, e)};
  }
  Vec3 aside(std::int32_t r, std::int32_t k, const Tip& one, const SurfaceFoot& stands, Real e) const PALPATE_RT {
    if (model->params.table_interpolation == TableInterpolation::kEnergy) return sideways_force(one, stands, e);
    const RowsByRegion& rows = scratch->rows;
    return printed_aside(*model, one, stands, scratch->contact[rows.index[rows.first[r] + k]].normal_w, e);
  }
  Real coupling_J(std::int32_t r, Real force_N, Real) const PALPATE_RT { return far_energy_J(region[r].far, force_N); }
};

// The far field under a region is that of its deepest tip.
FarField far_field_of(const Model& model, const RegionRows& rows) PALPATE_RT {
  if (model.params.response_law != ResponseLaw::kTip) return {};
  const TipLaw& law = model.tip_law[static_cast<std::size_t>(deepest_of(rows).piece)];
  return {law.c0_m_per_N, law.c1_m_per_N2, law.force_max_N};
}

Tip make_tip(const Model& model, const SurfaceFoot& foot, const Contact& contact) PALPATE_RT {
  Tip tip;
  tip.depth_m = contact.depth_m;
  tip.kind = model.params.response_law != ResponseLaw::kTip ? TipKind::kTable : TipKind::kPower;
  if (tip.kind == TipKind::kTable) {
    tip.table = table_law(model, contact.piece, foot.triangle, foot.weight);
  } else {
    tip.local = local_law(model, contact.piece);
  }
  return tip;
}

void gather(const Model& model, Scratch& scratch, TipLoad& load) PALPATE_RT {
  std::int32_t next = 0;
  load.model = &model;
  load.scratch = &scratch;
  load.n = scratch.rows.regions;
  load.region = load.tips_of;
  load.evaluated = &scratch.work.tip_laws;
  load.coupling = {scratch.system.compliance_m_per_N, scratch.system.second_order_m_per_N2};
  for (std::int32_t r = 0; r < load.n; ++r) {  // bound: kMaxPieces tips
    const RegionRows rows = rows_of(scratch, r);
    load.tips_of[r] = {&load.tip[next], 0, far_field_of(model, rows)};
    for (std::int32_t k = 0; k < rows.count && next < kMaxPieces; ++k) {
      load.foot[next] = &scratch.foot[rows[k].piece];
      load.tip[next] = make_tip(model, *load.foot[next], rows[k]);
      next += 1;
      load.tips_of[r].count += 1;
    }
  }
}

// Coupling of two regions: as stated for the pair of pieces, otherwise Boussinesq's far field.
void fill_pair(const Model& model, const State& state, Scratch& scratch, std::int32_t i, std::int32_t j) PALPATE_RT {
  const std::int32_t n = scratch.rows.regions;
  const std::int32_t a = rows_of(scratch, i)[0].piece, b = rows_of(scratch, j)[0].piece;
  Real *c = scratch.system.compliance_m_per_N, *h = scratch.system.second_order_m_per_N2;
  h[i * n + j] = h[j * n + i] = 0;
  for (const TipPair& pair : model.tip_pair) {  // bound: kMaxTipPairs
    const bool same = pair.piece_a == a && pair.piece_b == b, swapped = pair.piece_a == b && pair.piece_b == a;
    if (!same && !swapped) continue;
    c[i * n + j] = c[j * n + i] = pair.c_m_per_N;
    h[i * n + j] = same ? pair.h_ab_m_per_N2 : pair.h_ba_m_per_N2;
    h[j * n + i] = same ? pair.h_ba_m_per_N2 : pair.h_ab_m_per_N2;
    return;
  }
  const Region &u = state.region[scratch.rows.slot[i]], &v = state.region[scratch.rows.slot[j]];
  const Real scale = far_field_scale_m2_per_N(model.params.youngs_modulus_Pa, model.params.poisson_ratio);
  c[i * n + j] = c[j * n + i] = far_field_compliance_m_per_N(scale, model.params.far_field_radius_m, u.lean_tool_m,
                                                             u.lean_normal_tool, v.lean_tool_m, v.lean_normal_tool);
}

void lean_region(const Model& model, State& state, Scratch& scratch, const TipLoad& load, std::int32_t r) PALPATE_RT {
  Region& region = state.region[scratch.rows.slot[r]];
  if (has_lean(region)) return;
  const RegionRows rows = rows_of(scratch, r);
  for (std::int32_t k = 0; k < rows.count; ++k) rows[k].force_N = load.row(r, k, 0).at.force_N;  // bound: tips
  set_lean(model, state, region, rows);
}

// Shift of the surface under every region; the energy held between them.
void couple(const Model& model, State& state, Scratch& scratch, const TipLoad& load) PALPATE_RT {
  for (std::int32_t r = 0; r < load.n; ++r) {  // bound: kMaxRegions^2 / 2
    lean_region(model, state, scratch, load, r);
    for (std::int32_t j = 0; j < r; ++j) fill_pair(model, state, scratch, r, j);
  }
  const RegionSolution result = solve_regions(load, load.n, scratch.system);
  scratch.work.tip_laws += count_solution(result, load.n, scratch.contact_count, scratch.work);
  scratch.residual_m = result.residual_m;
  if (result.singular) scratch.status |= Status::kCouplingSingular;
  scratch.energy_J += coupling_energy_J(load.n, load.coupling, scratch.system.force_N);
}

void solve(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  sort_rows(state, scratch);
  if (scratch.rows.regions == 0) return;
  TipLoad load;
  gather(model, scratch, load);
  const bool coupled = model.params.coupling_law == CouplingLaw::kCoupled;
  if (coupled && load.n > 1) {
    couple(model, state, scratch, load);
  } else {
    for (std::int32_t r = 0; r < load.n; ++r) {  // bound: kMaxRegions
      const TravelResult result = solve_travel(load.region[r]);
      scratch.work.tip_laws += result.evaluations * load.region[r].count;
      scratch.system.shift_m[r] = result.shift_m;
      scratch.residual_m = max_of(scratch.residual_m, result.residual_m);
    }
  }
  if (!(scratch.residual_m <= kTravelTolerance_m)) scratch.status |= Status::kNotConverged;
  press_regions(load, state, scratch);
}

// Curves: knots strictly ascending from zero, whole rows, forces that start at zero and never fall.
ImageResult check_tables(const Model& model) noexcept {
  const std::size_t knots = model.knot.size();
  if (knots < 2 || model.knot[0] != 0) return broken("knot", 0);
  for (std::size_t i = 1; i < knots; ++i)
    if (!(model.knot[i] > model.knot[i - 1] && model.knot[i] < kHuge)) return not_finite("knot", i);
  if (model.response.empty() || model.response.size() % knots != 0) return broken("n_response", 0);
  const bool root = model.params.response_root == 1;
  for (std::size_t i = 0; i < model.response.size(); ++i) {
    const ResponseKnot& r = model.response[i];
    const bool first = i % knots == 0;
    if (!(r.force_N >= 0 && r.force_N < kHuge && r.slope >= 0 && r.slope < kHuge && is_finite(r.energy_J)))
      return not_finite("response", i);
    // In the root of the depth a slope at zero would be an infinite stiffness.
    if (first ? r.force_N != 0 || (root && r.slope != 0) : r.force_N < model.response[i - 1].force_N)
      return broken("response", i);
  }
  const std::size_t sets = model.vertex_response.size() / model.vertex_m.size();
  if (sets == 0 || model.vertex_response.size() != sets * model.vertex_m.size()) return broken("vertex_response", 0);
  for (std::size_t i = 0; i < model.piece.size(); ++i)
    if (!in_range(model.piece[i].curve_set, sets)) return broken("piece.curve_set", i);
  for (std::size_t i = 0; i < model.vertex_response.size(); ++i)
    if (!in_range(model.vertex_response[i], model.response.size() / knots)) return broken("vertex_response", i);
  return {};
}

ImageResult check_data(const Model& model) noexcept {
  if (model.params.response_law == ResponseLaw::kTip) return check_tip_laws(model);
  if (model.corner_normal.empty()) return broken("n_corner", 0);
  return check_tables(model);
}

void add_most_work(const Model& model, const SceneSizes& n, Work& work) noexcept {
  add_most_points(model, n, work);
  add_most_regions(n, TipLaws::kIterations, region_solve::kMostEvaluations<TipLaws>, work);
  work.tip_laws += (kSeriesIterations + 1 + TipLaws::kIterations * (kStepHalvings + 1)) * n.contacts;
}

}  // namespace

ImageResult check_tip_points(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.piece.size(); ++i)
    if (model.piece[i].point_count > 1) return not_together("piece.tip_points", i);
  return {};
}

ImageResult check_tip_laws(const Model& model) noexcept {
  if (model.corner_normal.empty()) return broken("n_corner", 0);
  if (model.tip_law.size() != model.piece.size()) return broken("n_tip_law", 0);
  for (std::size_t i = 0; i < model.tip_law.size(); ++i) {
    const TipLaw& law = model.tip_law[i];
    if (law.half_power < 2 || law.half_power > 4) return broken("tip_law.half_power", i);
    const bool has_factor = law.first_factor >= 0;
    if (law.first_factor < -1 || (has_factor && int64_t{law.first_factor} + kFactorKnots > model.sizes.n_factor))
      return broken("tip_law.first_factor", i);
    const double sizes[] = {law.coefficient, law.depth_max_m, law.force_max_N};
    for (const double size : sizes)
      if (!(size > 0 && size < kHuge)) return not_finite("tip_law", i);
    const bool gives = law.c0_m_per_N >= 0 && law.c0_m_per_N + 2 * law.c1_m_per_N2 * law.force_max_N >= 0;
    if (!(law.limit_m == 0 || (gives && law.limit_m > law.depth_max_m && law.limit_m < kHuge)))
      return not_finite("tip_law.limit_m", i);
    if (!is_finite(law.c0_m_per_N) || !is_finite(law.c1_m_per_N2)) return not_finite("tip_law.c0_m_per_N", i);
  }
  for (std::size_t i = 0; i < model.factor.size(); ++i) {
    const FactorKnot& knot = model.factor[i];
    if (!is_finite(knot.value) || !is_finite(knot.slope) || !is_finite(knot.energy_J)) return not_finite("factor", i);
  }
  for (std::size_t i = 0; i < model.tip_pair.size(); ++i) {
    const TipPair& pair = model.tip_pair[i];
    if (!in_range(pair.piece_a, model.piece.size()) || !in_range(pair.piece_b, model.piece.size()))
      return broken("tip_pair.piece", i);
    if (!is_finite(pair.c_m_per_N) || !is_finite(pair.h_ab_m_per_N2) || !is_finite(pair.h_ba_m_per_N2))
      return not_finite("tip_pair", i);
  }
  return {};
}

const ContactMethod tips_method{find_rows, solve, rub_tips, check_tip_points, check_data, add_most_work};

}  // namespace palpate
