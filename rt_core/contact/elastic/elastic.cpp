// The method `elastic`: whole tips (contact/tips) on the surface of a body that its soft modes carry along. The energy
//   V(p) + sum over the rows of local law, c F^2 and c1 F^3, and of c_kl F_k F_l between them
// is least where V' + sum F_k pull_k = 0. Around the last amplitudes that is linear in the forces,
//   dp = -H^-1 (V' + sum F_k pull_k),   H = V'' + sum F_k turn_k,
// so every region has one far field more, pull H^-1 pull, and its depth is that on the body let go: the tips' solver
// with their exact laws does the rest. kElasticLinearisations of it a tick; a hold ends where rounding does.
#include "rt_core/cholesky.h"
#include "rt_core/contact/contact.h"
#include "rt_core/contact/elastic/elastic_row.h"
#include "rt_core/contact/region_load.h"
#include "rt_core/contact/regions.h"
#include "rt_core/contact/tips/tip_check.h"
#include "rt_core/contact/tips/travel.h"
#include "rt_core/image_check.h"
#include "rt_core/surface/body_box.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

using namespace elastic_layout;

// Of the linear stiffness: a softer linearisation is stiffened, and the next one tells. Keeps a body at a limit point
// from being thrown across it.
constexpr Real kLeastStiffness = 1e-2;
// Of the ball's radius: the longest step of one linearisation.
constexpr Real kLongestStep = 0.25;
// What one linearisation may move the surface under a tip beyond the one before: above it the tick says so.
constexpr Real kElasticTolerance_m = 2e-5;
// Where c1 < 0 would turn a far field back, it goes on by its tangent from where half its compliance is left.
constexpr Real kLeastFarShare = 0.5;

// The lower triangle of h becomes the factor of h + shift; false when a pivot falls below the least stiffness.
bool factor_shifted(const Real* h, Real shift, std::int32_t n, Real* factor) PALPATE_RT {
  for (std::int32_t j = 0; j < n; ++j) {  // bound: soft^3 / 6
    Real diagonal = h[j * n + j] + shift;
    for (std::int32_t k = 0; k < j; ++k) diagonal -= factor[j * n + k] * factor[j * n + k];
    if (!(diagonal >= kLeastStiffness && diagonal < kHuge)) return false;
    const Real pivot = square_root(diagonal), inverse = 1.0 / pivot;
    factor[j * n + j] = pivot;
    for (std::int32_t i = j + 1; i < n; ++i) {
      Real sum = h[i * n + j];
      for (std::int32_t k = 0; k < j; ++k) sum -= factor[i * n + k] * factor[j * n + k];
      factor[i * n + j] = sum * inverse;
    }
  }
  return true;
}

// As stiff as it has to be for that; the linear body where nothing helps. The linear stiffness is 1.
void factor_stiffened(const Real* h, std::int32_t n, Real* factor) PALPATE_RT {
  for (const Real shift : {0.0, 0.1, 0.5, 2.0, 8.0}) {  // bound: 5
    if (factor_shifted(h, shift, n, factor)) return;
  }
  for (std::int32_t i = 0; i < n; ++i)  // bound: soft^2
    for (std::int32_t j = 0; j <= i; ++j) factor[i * n + j] = i == j ? 1.0 : 0.0;
}

Real dot(const Real* a, const Real* b, std::int32_t n) PALPATE_RT {
  Real sum = 0;
  for (std::int32_t i = 0; i < n; ++i) sum += a[i] * b[i];  // bound: soft
  return sum;
}

// Body at its amplitudes: products and energy.
CarriedSurface look(const Model& model, const State& state, Scratch& scratch) PALPATE_RT {
  ElasticWork& work = work_of(scratch);
  soft_products(model.params.elastic_soft, state.elastic.soft_rootJ.data(), work.y);
  soft_energy(model, state.elastic.soft_rootJ.data(), work.y, work.energy);
  return {model, work.y, &scratch.surface_work};
}

// Step of the amplitudes when every force is let go, with H of no force.
void let_go(const Model& model, const SoftEnergy& energy, Real* step) PALPATE_RT {
  const std::int32_t n = model.params.elastic_soft;
  Real factor[kMaxSoftModes * kMaxSoftModes];
  factor_stiffened(energy.curvature, n, factor);
  for (std::int32_t a = 0; a < n; ++a) step[a] = -energy.slope[a];
  cholesky_solve(factor, step, n);
}

class Finder {
 public:
  Finder(const Model& model, State& state, Scratch& scratch) PALPATE_RT : model_(model),
                                                                          state_(state),
                                                                          scratch_(scratch),
                                                                          work_(work_of(scratch)),
                                                                          surface_(look(model, state, scratch)),
                                                                          box_(root_box(model)) {
    let_go(model, work_.energy, let_go_);
    is_moved_ = state.elastic.moved != 0;
  }

  void visit(std::int32_t index) PALPATE_RT {
    const ToolPoint& tool_point = model_.tool_point[static_cast<std::size_t>(index)];
    PointState& point = state_.point[index];
    const Vec3 p = transform(carrier_w(model_, state_, tool_point.piece), tool_point.position_tool_m);
    const bool touched = point.triangle >= 0 && point.gap_m < 0;
    if (!touched && is_far(index, p)) return;
    ElasticRow& row = work_.row[tool_point.piece];
    if (touched) {
      surface_.place(p, tool_point.margin_m, point.triangle, row);
      if (row.foot.triangle >= 0 && free_depth(row) > 0) return keep(index, row);
    }
    search(p, tool_point.margin_m, point, row);
    if (row.foot.triangle < 0) {
      scratch_.status |= Status::kPointsHeld;
      point.gap_m = point.gap_bound_m = 0;
      return;
    }
    const Real depth = free_depth(row);
    point.closest_w = row.foot.foot_w;
    point.normal_w = row.foot.normal_w;
    point.triangle = row.foot.triangle;
    point.gap_m = -depth;
    point.gap_bound_m = min_of(reach_m_, -depth);
    if (depth > 0) keep(index, row);
  }

 private:
  Real free_depth(const ElasticRow& row) const PALPATE_RT {
    return row.travel_m + dot(row.pull, let_go_, model_.params.elastic_soft);
  }

  // Not in reach, and the body at rest: as far as it was less what it moved, or as far as the body's box.
  bool is_far(std::int32_t index, Vec3 p) PALPATE_RT {
    PointState& point = state_.point[index];
    const ToolPoint& tool_point = model_.tool_point[static_cast<std::size_t>(index)];
    const Real box = distance_to(box_, p) - tool_point.margin_m;
    if (is_moved_) {
      if (!(box > kBulge * model_.params.surface_size_m)) return false;
      point.gap_m = point.gap_bound_m = 0;
      return true;
    }
    const Vec3 before = transform(carrier_previous_w(model_, state_, tool_point.piece), tool_point.position_tool_m);
    const Real bound = max_of(point.gap_bound_m - norm(p - before), box);
    if (!(bound > kSearchMargin_m)) return false;
    point.gap_m = point.gap_bound_m = bound;
    return true;
  }

  // From the facet nearest to the centre on the body at rest, as the surface about the last place has moved.
  void search(Vec3 p, Real margin_m, const PointState& point, ElasticRow& row) PALPATE_RT {
    row.foot.triangle = -1;
    if (scratch_.surface_work >= surface_work_share(model_.params)) return;
    Vec3 moved;
    if (is_moved_ && point.triangle >= 0)
      moved = surface_.displacement(model_.triangle[static_cast<std::size_t>(point.triangle)].vertex[0]);
    const SurfacePoint nearest = closest_surface_point(model_, p - moved, kHuge, point.triangle);
    scratch_.surface_work += nearest.looked;
    reach_m_ = nearest.lower_bound_m - margin_m - model_.params.smooth_slack_m;
    if (nearest.truncated) scratch_.status |= Status::kTraversalTruncated;
    if (nearest.found) surface_.place(p, margin_m, nearest.triangle, row);
  }

  void keep(std::int32_t index, const ElasticRow& row) PALPATE_RT {
    const ToolPoint& tool_point = model_.tool_point[static_cast<std::size_t>(index)];
    PointState& point = state_.point[index];
    Contact& contact = scratch_.contact[scratch_.contact_count++];
    contact = Contact{};
    contact.row = contact.point = index;
    contact.piece = tool_point.piece;
    contact.previous = point.region;
    contact.position_w = point.closest_w = row.foot.foot_w;
    contact.normal_w = point.normal_w = row.foot.normal_w;
    contact.depth_m = free_depth(row);
    contact.weight = tool_point.weight;
    contact.area_m2 = tool_point.area_m2;
    point.triangle = row.foot.triangle;
    point.gap_m = point.gap_bound_m = -contact.depth_m;
  }

  // A body under load may stand out of its box at rest by this share of its size; farther off nothing is looked for.
  static constexpr Real kBulge = 0.25;

  const Model& model_;
  State& state_;
  Scratch& scratch_;
  ElasticWork& work_;
  const CarriedSurface surface_;
  const Box box_;
  Real let_go_[kMaxSoftModes];
  Real reach_m_ = 0;
  bool is_moved_;
};

void find_rows(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  scratch.contact_count = scratch.surface_work = 0;
  if (!is_finite(state.tool_w)) {
    for (PointState& point : state.point) point.gap_m = point.gap_bound_m = 0;  // bound: kMaxToolPoints
    return;
  }
  Finder finder(model, state, scratch);
  for (const ToolPiece& piece : model.piece) {  // bound: kMaxPieces, one point each at most
    if (piece.point_count > 0) finder.visit(piece.first_point);
  }
  state.high_water.contacts =
      state.high_water.contacts < scratch.contact_count ? scratch.contact_count : state.high_water.contacts;
  group_points(model, state, scratch, nullptr);
}

// Hertz on a body of mean curvature k instead of a plane: the tip's radius R becomes R / (1 + k R).
struct CurvatureFactor {
  Real value, per_curvature;
};
CurvatureFactor curvature_factor(const TipLaw& law, Real radius_m, Real curvature) PALPATE_RT {
  if (law.half_power != 3) return {1, 0};
  const Real sum = clamp_to(1 + curvature * radius_m, 0.25, 4.0), value = 1.0 / square_root(sum);
  return {value, -0.5 * value * radius_m / sum};
}

// The tips in contact with their own far fields and the body's, and what accounting asks of them.
struct ElasticLoad : TipLaws {
  static constexpr bool kPullsAside = true;
  Tip tip[kMaxPieces];
  const ElasticRow* placed[kMaxPieces];
  Real per_curvature[kMaxPieces];
  TipRegion tips_of[kMaxRegions];
  FarField own[kMaxRegions];  // c and c1 of the region, without the modes

  std::int32_t at(std::int32_t r, std::int32_t k) const PALPATE_RT {
    return static_cast<std::int32_t>(region[r].tip - tip) + k;
  }
  Real softening(std::int32_t r, Real shift_m) const PALPATE_RT {
    const LawPoint sum = load(r, shift_m);
    return 1.0 / (1.0 + far_slope_m_per_N(region[r].far, sum.force_N) * sum.tangent_N_per_m);
  }
  // The force along the surface that the stored energy asks for where c, c1 and the curvature change along it.
  RowLoad row(std::int32_t r, std::int32_t k, Real shift_m) const PALPATE_RT {
    const std::int32_t i = at(r, k);
    const ElasticRow& stands = *placed[i];
    const Real e = tip[i].depth_m - shift_m;
    const LawPoint point = tip_at(tip[i], e);
    const Real energy = tip_energy_J(tip[i], e), f = point.force_N;
    const Vec3 aside = f * (stands.rise - stands.foot.normal_w) + (0.5 * f * f) * stands.c_gradient +
                       (f * f * f / 3) * stands.c1_gradient -
                       (energy / tip[i].scale * per_curvature[i]) * stands.curvature_gradient;
    // Far beyond the range the third power of the force is no physics: never steeper than 45 degrees.
    const Real length = norm(aside), share = length > f ? f / length : 1.0;
    return {point, energy, stands.centre_w, share * aside, e > tip[i].local.tip->depth_max_m};
  }
  Real coupling_J(std::int32_t r, Real force_N, Real) const PALPATE_RT { return far_energy_J(own[r], force_N); }
};

FarField own_field(const ElasticRow& row) PALPATE_RT {
  FarField own{row.c_m_per_N, row.c1_m_per_N2};
  if (own.c1_m_per_N2 < 0) {
    if (!(own.c0_m_per_N > 0)) return {own.c0_m_per_N, 0};
    own.force_max_N = kLeastFarShare * own.c0_m_per_N / (-2 * own.c1_m_per_N2);
  }
  return own;
}

// One linearisation: H's factor, and per region X = H^-1 pull of its deepest row.
class Linearised {
 public:
  Linearised(const Model& model, State& state, Scratch& scratch, ElasticLoad& load) PALPATE_RT
      : model_(model),
        state_(state),
        scratch_(scratch),
        load_(load),
        work_(work_of(scratch)),
        n_(model.params.elastic_soft) {}

  // `force_N`: of every region before.
  void prepare(const Real* force_N) PALPATE_RT {
    Real h[kMaxSoftModes * kMaxSoftModes];
    for (std::int32_t i = 0; i < n_ * n_; ++i) h[i] = work_.energy.curvature[i];  // bound: soft^2
    for (std::int32_t r = 0; r < regions(); ++r) {                                // bound: kMaxRegions pairs
      const ElasticRow& row = leading_row(r);
      std::int32_t pair = 0;
      for (std::int32_t a = 0; a < n_; ++a) {
        for (std::int32_t b = a; b < n_; ++b, ++pair) {
          h[a * n_ + b] += force_N[r] * row.turn[pair];
          if (a != b) h[b * n_ + a] += force_N[r] * row.turn[pair];
        }
      }
    }
    factor_stiffened(h, n_, factor_);
    for (std::int32_t a = 0; a < n_; ++a) free_step_[a] = -work_.energy.slope[a];
    cholesky_solve(factor_, free_step_, n_);
    for (std::int32_t r = 0; r < regions(); ++r) {  // bound: kMaxRegions soft^2
      const ElasticRow& row = leading_row(r);
      for (std::int32_t a = 0; a < n_; ++a) moved_[r][a] = row.pull[a];
      cholesky_solve(factor_, moved_[r], n_);
    }
  }

  // Laws, depths and far fields of all regions, and what couples them.
  void gather() PALPATE_RT {
    std::int32_t next = 0;
    load_.n = regions();
    load_.region = load_.tips_of;
    load_.coupling = {scratch_.system.compliance_m_per_N, nullptr};
    for (std::int32_t r = 0; r < load_.n; ++r) {  // bound: kMaxPieces tips
      const RegionRows rows = rows_of(scratch_, r);
      load_.own[r] = own_field(leading_row(r));
      FarField far = load_.own[r];
      far.c0_m_per_N += dot(leading_row(r).pull, moved_[r], n_);
      load_.tips_of[r] = {&load_.tip[next], 0, far};
      for (std::int32_t k = 0; k < rows.count && next < kMaxPieces; ++k) {
        add_tip(rows[k], next++);
        load_.tips_of[r].count += 1;
      }
      for (std::int32_t j = 0; j < r; ++j) couple(r, j);
    }
  }

  // Moves the amplitudes under the forces found; returns how far that moved the surface under any region.
  Real step(const Real* force_N) PALPATE_RT {
    Real delta[kMaxSoftModes];
    for (std::int32_t a = 0; a < n_; ++a) {  // bound: soft x kMaxRegions
      delta[a] = free_step_[a];
      for (std::int32_t r = 0; r < regions(); ++r) delta[a] -= force_N[r] * moved_[r][a];
    }
    const Real length = square_root(dot(delta, delta, n_)), longest = kLongestStep * model_.params.elastic_radius_rootJ;
    const Real share = length <= longest ? 1.0 : longest / length;
    Real moved = 0, energy = work_.energy.energy_J;
    for (std::int32_t r = 0; r < regions(); ++r)
      moved = max_of(moved, share * abs_of(dot(leading_row(r).pull, delta, n_)));
    for (std::int32_t a = 0; a < n_; ++a) {  // bound: soft^2
      const Real d = share * delta[a];
      energy += d * (work_.energy.slope[a] + 0.5 * share * dot(work_.energy.curvature + a * n_, delta, n_));
      state_.elastic.soft_rootJ[a] += is_finite(d) ? d : 0.0;
    }
    energy_J_ = energy;
    return moved;
  }
  Real energy_J() const PALPATE_RT { return energy_J_; }
  Real linear_energy_J(const Real* force_N) const PALPATE_RT {
    Real energy = 0;
    for (std::int32_t r = 0; r < regions(); ++r)  // bound: kMaxRegions^2 / 2
      for (std::int32_t j = 0; j < r; ++j) energy += linear_[r][j] * force_N[r] * force_N[j];
    return energy;
  }

 private:
  std::int32_t regions() const PALPATE_RT { return scratch_.rows.regions; }
  const ElasticRow& leading_row(std::int32_t r) const PALPATE_RT {
    return work_.row[deepest_of(rows_of(scratch_, r)).piece];
  }
  void add_tip(Contact& contact, std::int32_t at) PALPATE_RT {
    const ElasticRow& row = work_.row[contact.piece];
    const Real margin_m = model_.tool_point[static_cast<std::size_t>(contact.point)].margin_m;
    Tip& tip = load_.tip[at];
    tip = Tip{};
    tip.local = local_law(model_, contact.piece);
    const CurvatureFactor factor = curvature_factor(*tip.local.tip, margin_m, row.curvature_1_per_m);
    tip.scale = factor.value;
    load_.per_curvature[at] = factor.per_curvature;
    load_.placed[at] = &row;
    tip.depth_m = contact.depth_m = row.travel_m + dot(row.pull, free_step_, n_);
    contact.position_w = row.foot.foot_w;
    contact.normal_w = row.foot.normal_w;
  }
  void couple(std::int32_t r, std::int32_t j) PALPATE_RT {
    const std::int32_t n = regions();
    linear_[r][j] = linear_compliance_m_per_N(model_, leading_row(r), leading_row(j));
    Real* c = scratch_.system.compliance_m_per_N;
    c[r * n + j] = c[j * n + r] = linear_[r][j] + dot(leading_row(r).pull, moved_[j], n_);
  }

  const Model& model_;
  State& state_;
  Scratch& scratch_;
  ElasticLoad& load_;
  ElasticWork& work_;
  const std::int32_t n_;
  Real factor_[kMaxSoftModes * kMaxSoftModes];
  Real free_step_[kMaxSoftModes];
  Real moved_[kMaxRegions][kMaxSoftModes];
  Real linear_[kMaxRegions][kMaxRegions];
  Real energy_J_ = 0;
};

// Shifts and forces of the regions.
void solve_forces(const ElasticLoad& load, Scratch& scratch, Real* force_N) PALPATE_RT {
  if (load.n > 1) {
    const RegionSolution result = solve_regions(load, load.n, scratch.system);
    scratch.residual_m = result.residual_m;
    if (result.singular) scratch.status |= Status::kCouplingSingular;
  } else {
    const TravelResult result = solve_travel(load.region[0]);
    scratch.system.shift_m[0] = result.shift_m;
    scratch.residual_m = result.residual_m;
  }
  if (!(scratch.residual_m <= kTravelTolerance_m)) scratch.status |= Status::kNotConverged;
  for (std::int32_t r = 0; r < load.n; ++r)  // bound: kMaxRegions
    force_N[r] = region_at(load.region[r], scratch.system.shift_m[r]).force_N;
}

// Every row at the new amplitudes, from where it was.
void place_again(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  const CarriedSurface surface = look(model, state, scratch);
  for (std::int32_t i = 0; i < scratch.contact_count; ++i) {  // bound: kMaxPieces
    const Contact& contact = scratch.contact[i];
    ElasticRow& row = work_of(scratch).row[contact.piece];
    const ElasticRow before = row;
    surface.place(row.centre_w, model.tool_point[static_cast<std::size_t>(contact.point)].margin_m, row.foot.triangle,
                  row);
    if (row.foot.triangle < 0) row = before;
    state.point[contact.point].triangle = row.foot.triangle;
  }
}

void solve(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  sort_rows(state, scratch);
  const std::int32_t regions = scratch.rows.regions;
  if (regions == 0) return state.elastic.reset();
  state.elastic.moved = 1;
  ElasticLoad load;
  Linearised body(model, state, scratch, load);
  Real force_N[kMaxRegions], moved_m = 0;
  for (std::int32_t r = 0; r < regions; ++r) force_N[r] = state.region[scratch.rows.slot[r]].normal_force_N;
  for (std::int32_t i = 0; i < kElasticLinearisations; ++i) {  // bound: kElasticLinearisations
    if (i > 0) place_again(model, state, scratch);
    body.prepare(force_N);
    body.gather();
    solve_forces(load, scratch, force_N);
    moved_m = body.step(force_N);
  }
  if (!(moved_m <= kElasticTolerance_m)) scratch.status |= Status::kNotConverged;
  if (work_of(scratch).energy.is_outside) scratch.status |= Status::kDepthBeyondRange;
  scratch.residual_m = max_of(scratch.residual_m, moved_m);
  scratch.energy_J += body.energy_J() + body.linear_energy_J(force_N);
  press_regions(load, state, scratch);
}

ImageResult check_data(const Model& model) noexcept {
  const ModelParams& p = model.params;
  const ModelSizes& n = model.sizes;
  if (p.response_law != ResponseLaw::kTip) return broken("response_law", 0);
  if (p.elastic_soft < 1) return broken("elastic_soft", 0);
  if (!(p.elastic_radius_rootJ > 0)) return broken("elastic_radius_rootJ", 0);
  const std::int64_t pair = pairs(p.elastic_soft);
  if (n.n_elastic_vertex != n.n_vertex * vertex_floats(model)) return broken("n_elastic_vertex", 0);
  if (n.n_elastic_cubic != pair * p.elastic_soft) return broken("n_elastic_cubic", 0);
  if (n.n_elastic_quartic != pair * pair) return broken("n_elastic_quartic", 0);
  for (const ImageResult& result :
       {check_tip_laws(model), check_numbers(model.elastic_vertex, "elastic_vertex"),
        check_numbers(model.elastic_cubic, "elastic_cubic"), check_numbers(model.elastic_quartic, "elastic_quartic")})
    if (result.error != ImageError::kNone) return result;
  return {};
}

// Nothing in it is read before the tick has written it.
std::size_t work_bytes(const Model&) noexcept { return sizeof(ElasticWork); }

// The body's energy; one tip on the carried surface, over kFootWalk triangles at worst.
double soft_energy_cost(const Model& model) noexcept {
  const double pair_count = pairs(model.params.elastic_soft);
  return 3000 + 60 * pair_count + 3 * pair_count * pair_count;
}
double place_cost(const Model& model) noexcept { return 8000 + 800.0 * terms(model.params.elastic_soft); }

double least_cost(const Model& model, const SceneSizes& n, Stage stage) noexcept {
  if (stage == Stage::kAccount) return rub_regions_cost(n);
  if (stage == Stage::kFindRows)
    return 3000 + surface_search_cost(model) + soft_energy_cost(model) + n.points * (500 + 2 * place_cost(model)) +
           30 * n.contacts * n.contacts;
  const double pair = 600 + 40.0 * model.params.elastic_linear;
  const double one = soft_energy_cost(model) + n.regions * (12000 + place_cost(model)) + n.regions * n.regions * pair;
  return 5000 + kElasticLinearisations * one;
}

}  // namespace

const ContactMethod elastic_method{find_rows, solve, rub_tips, check_tip_points, check_data, least_cost, work_bytes};

}  // namespace palpate
