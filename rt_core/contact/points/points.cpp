// The method `points`: cubic springs at the tool's points (contact/points/point_laws.h). Instructions of solve and
// account with the coupled solve: 27 k and 14 k for 15 regions of 54 contacts, 11 k and 8 k for 6 of 19 (callgrind,
// gcc 12 -O3, 2026-11-26).
#include "rt_core/contact/contact.h"
#include "rt_core/contact/points/coupled_points.h"
#include "rt_core/contact/points/slide_together.h"
#include "rt_core/contact/regions.h"

namespace palpate {

void weigh_contacts(ContactWeight law, const RegionRows& rows) PALPATE_RT {
  Real sum = 0;
  for (std::int32_t k = 0; k < rows.count; ++k) {  // bound: points
    Real& weight = rows[k].weight;
    if (!(weight > 0 && weight < kHuge)) weight = 0;
    sum += weight;
  }
  if (law == ContactWeight::kWinkler) return;
  const Real even = rows.count > 0 ? 1.0 / rows.count : 0.0;
  const Real scale = sum > 0 ? 1.0 / sum : 0.0;
  for (std::int32_t k = 0; k < rows.count; ++k) {  // bound: points
    rows[k].weight = law == ContactWeight::kPaper ? even : scale * rows[k].weight;
  }
}

namespace {

bool is_coupled(const Model& model) PALPATE_RT { return model.params.coupling_law == CouplingLaw::kCoupled; }

void find_rows(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  collide(model, state, scratch);
  group_points(model, state, scratch, still_touching);
}

void lean_regions(const Model& model, State& state, const PointLaws& laws, const RowsByRegion& rows) PALPATE_RT {
  for (std::int32_t r = 0; r < rows.regions; ++r) {  // bound: kMaxContacts points
    Region& region = state.region[rows.slot[r]];
    if (has_lean(region)) continue;
    const RegionRows& touching = laws.region[r];
    for (std::int32_t k = 0; k < touching.count; ++k) {
      touching[k].force_N = touching[k].weight * law_force_N(laws.law, touching[k].depth_m);
    }
    set_lean(model, state, region, touching);
  }
}

// C in rows of kRegionStride; far_field_compliance_m_per_N() of four regions at a time.
void fill_compliance(const Model& model, const State& state, const RowsByRegion& rows, Real* compliance) PALPATE_RT {
  const std::int32_t n = rows.regions;
  const Real scale = far_field_scale_m2_per_N(model.params.youngs_modulus_Pa, model.params.poisson_ratio);
  const Real core = model.params.far_field_radius_m;
  if (n == 1) {  // all there is to say about a single region
    for (std::int32_t j = 0; j < kRegionStride; ++j) compliance[j] = j == 0 ? scale / core : 0.0;
    return;
  }
  Vec3x4 place[kRegionStride / 4] = {}, normal[kRegionStride / 4] = {};
  for (std::int32_t i = 0; i < n; ++i) {  // bound: kMaxRegions
    const Region& region = state.region[rows.slot[i]];
    place[i / 4].set(static_cast<std::uint32_t>(i % 4), region.lean_tool_m);
    normal[i / 4].set(static_cast<std::uint32_t>(i % 4), region.lean_normal_tool);
  }
  for (std::int32_t i = 0; i < n; ++i) {  // bound: kMaxRegions^2 / 4
    const Region& region = state.region[rows.slot[i]];
    const Vec3x4 here = splat4(region.lean_tool_m), along = splat4(region.lean_normal_tool);
    for (std::int32_t j = 0; 4 * j < n; ++j) {
      const Vec3x4 off = here - place[j];
      const Double4 square = dot(off, off) + splat4(core * core);
      const Double4 c = splat4(scale) * dot(along, normal[j]) / square_root(square);
      store(compliance + i * kRegionStride + 4 * j, square > Double4{} ? c : Double4{});
    }
  }
}

void note_solution(const RegionSolution& result, std::int32_t n, Scratch& scratch) PALPATE_RT {
  scratch.work.spring_laws += count_solution(result, n, scratch.contact_count, scratch.work);
  scratch.residual_m = result.residual_m;
  if (result.singular) scratch.status |= Status::kCouplingSingular;
  if (!(result.residual_m <= PointLaws::kTolerance_m)) scratch.status |= Status::kNotConverged;
}

// What the regions press with, each shifted by all of them and by itself. A single one has none beside it to be taken
// with, and may have all rows.
void press_coupled(const Model& model, State& state, Scratch& scratch, PointLaws& laws) PALPATE_RT {
  lean_regions(model, state, laws, scratch.rows);
  fill_compliance(model, state, scratch.rows, scratch.system.compliance_m_per_N);
  if (laws.n == 1) {
    laws.compliance_m_per_N = scratch.system.compliance_m_per_N;
    note_solution(solve_regions(laws, laws.n, scratch.system), laws.n, scratch);
    return press_regions(laws, state, scratch);
  }
  const CoupledPoints coupled(laws, scratch.system.compliance_m_per_N);
  Real before_N[kMaxRegions] = {};
  for (std::int32_t r = 0; r < laws.n; ++r) before_N[r] = state.region[scratch.rows.slot[r]].normal_force_N;
  note_solution(coupled.solve(before_N, scratch.system), laws.n, scratch);
  coupled.press(state, scratch);
}

// What each presses with alone, or shifted by those before it.
void press_in_turn(const Model& model, State& state, Scratch& scratch, const PointLaws& laws) PALPATE_RT {
  for (std::int32_t r = 0; r < laws.n; ++r) scratch.system.shift_m[r] = 0;  // bound: kMaxRegions
  if (model.params.coupling_law == CouplingLaw::kTemporalPaper) shift_in_order(model, state, scratch, laws);
  press_regions(laws, state, scratch);
}

void solve(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  sort_rows(state, scratch);
  scratch.rows.geometric = model.params.equivalent_point == EquivalentPoint::kPaper;
  RegionRows region[kMaxRegions];
  const auto weight = model.params.contact_weight;
  for (std::int32_t r = 0; r < scratch.rows.regions; ++r) {  // bound: kMaxContacts points
    region[r] = rows_of(scratch, r);
    weigh_contacts(weight, region[r]);
  }
  if (scratch.rows.regions == 0) return;
  PointLaws laws{contact_law(model.params), region, nullptr, scratch.rows.regions};
  if (is_coupled(model))
    press_coupled(model, state, scratch, laws);
  else
    press_in_turn(model, state, scratch, laws);
}

// The papers' contributions: what other regions' skeletons carry over is added along the normal. All are taken from the
// regions' own normal forces (and last tick's friction) before any is added.
void add_transferred(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  const RowsByRegion& rows = scratch.rows;
  const std::int32_t n = rows.regions, ends = static_cast<std::int32_t>(model.anchor.size());
  const bool mutual = model.params.coupling_law == CouplingLaw::kMutualPaper;
  scratch.work.beams += (mutual ? ends + n : ends) * n;
  scratch.work.carried += (mutual ? n : ends * n) * n;
  Real added[kMaxRegions] = {};
  const bool carried = mutual ? add_mutual_forces(model, state, rows.slot, n, added)
                              : add_transferred_forces(model, state, rows.slot, n, added);
  if (!carried) scratch.status |= Status::kSkeletonDegenerate;
  for (std::int32_t i = 0; i < rows.regions; ++i) {  // bound: kMaxContacts points
    Region& region = state.region[rows.slot[i]];
    const Real own = region.normal_force_N;
    if (!(own > 0)) continue;
    region.normal_force_N = own + added[i];
    const Real scale = region.normal_force_N / own;
    region.wrench_w = {scale * region.wrench_w.force_N, scale * region.wrench_w.torque_Nm};
    const RegionRows touching = rows_of(scratch, i);
    for (std::int32_t k = 0; k < touching.count; ++k) touching[k].force_N *= scale;
  }
}

void account(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  if (carries_over(model.params.coupling_law)) add_transferred(model, state, scratch);
  const bool yields = is_coupled(model);
  const FrictionParameters parameters = friction_parameters(model.params);
  if (scratch.rows.regions > 1) {
    slide_together(model, state, scratch, parameters, yields);
  } else if (scratch.rows.regions == 1) {
    Region& region = state.region[scratch.rows.slot[0]];
    region.depth_equivalent_m = law_depth_m(parameters.contact, region.normal_force_N);
    FrictionLoad load = load_on_points(scratch, parameters, yields, 0, region);
    slide(model, state, scratch, parameters, rows_of(scratch, 0), load, region);
  }
  sum_up(model, state, scratch);
}

// Any tool, and no arrays of its own.
ImageResult accept(const Model&) noexcept { return {}; }

void add_most_work(const Model& model, const SceneSizes& n, Work& work) noexcept {
  add_most_points(model, n, work);
  add_most_regions(n, PointLaws::kIterations, region_solve::kMostEvaluations<PointLaws>, work);
  work.spring_laws += (1 + PointLaws::kIterations * (kStepHalvings + 1)) * n.contacts;
  const bool mutual = model.params.coupling_law == CouplingLaw::kMutualPaper;
  work.beams += (mutual ? n.anchors + n.regions : n.anchors) * n.regions;
  work.carried += (mutual ? 1 : n.anchors) * n.regions * n.regions;
  if (model.params.coupling_law == CouplingLaw::kTemporalPaper) work.standing += n.anchors * n.regions;
}

}  // namespace

const ContactMethod points_method{find_rows, solve, account, accept, accept, add_most_work};

}  // namespace palpate
