// The method `elastic`: whole tips (contact/tips) on the surface of a body that its soft modes carry along. The energy
//   V(p) + sum over the rows of local law, c F^2 and c1 F^3, and of c_kl F_k F_l between them
// is least where V' + sum F_k pull_k = 0. Around the last amplitudes that is linear in the forces,
//   dp = -H^-1 (V' + sum F_k pull_k),   H = V'' + sum F_k turn_k,
// so every region has one far field more, pull H^-1 pull, and its depth is that on the body let go: the tips' solver
// with their exact laws does the rest. One linearisation a tick, around where the body goes if it moves on as in the
// last tick: of a steady motion only its change is left to it, and a hold ends where rounding does.
#include "rt_core/contact/contact.h"
#include "rt_core/contact/elastic/linearised.h"
#include "rt_core/contact/elastic/others_push.h"
#include "rt_core/contact/regions.h"
#include "rt_core/contact/tips/tip_check.h"
#include "rt_core/image_check.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/foot_search.h"
#include "rt_core/surface/plane_proof.h"
#include "rt_core/unwritten.h"

namespace palpate {

namespace {

using namespace elastic_layout;

// What one more linearisation would move the surface under a tip: above it the tick says so.
constexpr Real kElasticTolerance_m = 2e-5;

// Every tip sticks in the first; those that slip under its answer do so in the second. Decided instead by where the
// body would go, the answer was one tick late, and ring and tube let a resting hand buzz for 35 ticks (2026-11-22).
constexpr std::int32_t kSolvesOfFriction = 2;
// How exactly the first tells who slips: a thousandth or less of what friction's spring is stretched by where it does.
// Of lines the tangents' forces after a short step do, too: a thousandth of the force.
constexpr Real kEnoughToSlip_m = 1e-9;
// The second is begun with no fewer evaluations left to it.
constexpr std::int32_t kLeastOfSolve = 3;

// What the places ask of the modes, in tip laws evaluated: two of them, and sums over numbers and modes.
constexpr std::int32_t kPlaceLaws = 5;
// A line's law, in tip laws.
constexpr std::int32_t kLineLaws = 2;

// Tip laws in one evaluation of all.
std::int32_t laws_in(const ElasticLoad& load) PALPATE_RT {
  std::int32_t sum = load.n;
  for (std::int32_t r = 0; r < load.n; ++r) sum += load.law[r].is_line ? kLineLaws - 1 : 0;  // bound: kMaxRegions
  return sum;
}

void count(const RegionSolution& result, const ElasticLoad& load, std::int32_t laws, Work& work) PALPATE_RT {
  work.evaluations += result.evaluations + 2 * result.steps;
  work.tip_laws += count_solution(result, load.n, laws, work);
}

// Shifts and forces of the regions; of several, where another solve may follow, as exactly as to tell who slips.
RegionSolution solve_forces(ElasticLoad& load, std::int32_t laws, Scratch& scratch, bool is_last,
                            Real* force_N) PALPATE_RT {
  RegionSolution result;
  if (load.n > 1) {
    RegionSolution given_up;
    result = load.solve(scratch.system, is_last ? ElasticLoad::kEnough_m : kEnoughToSlip_m, !is_last, given_up);
    if (given_up.evaluations > 0) count(given_up, load, laws, scratch.work);
  } else {
    const TravelResult alone = solve_travel(load.region[0], load.shift_alone_m(0));
    scratch.work.tip_laws += alone.evaluations * laws;
    const LawPoint at = region_at(load.region[0], alone.shift_m);
    scratch.system.shift_m[0] = alone.shift_m;
    scratch.system.force_N[0] = at.force_N;
    scratch.system.root_tangent[0] = square_root(at.tangent_N_per_m);
    result.residual_m = alone.residual_m;
  }
  for (std::int32_t r = 0; r < load.n; ++r) force_N[r] = scratch.system.force_N[r];  // bound: kMaxRegions
  return result;
}

// And to the end, where the first solve is the last.
void finish_forces(ElasticLoad& load, Scratch& scratch, RegionSolution& result, Real* force_N) PALPATE_RT {
  if (load.n > 1) load.finish(scratch.system, result);
  for (std::int32_t r = 0; r < load.n; ++r) force_N[r] = scratch.system.force_N[r];  // bound: kMaxRegions
}

// Of a solve that found no answer: no tip presses deeper than it overlaps the body let go and its deepest depth
// together. A box's corner in an hourglass pressed with 1e10 N (2026-11-29).
void bound_forces(const ElasticLoad& load, Scratch& scratch, Real* force_N) PALPATE_RT {
  for (std::int32_t r = 0; r < load.n; ++r) {  // bound: kMaxRegions
    const Tip& tip = load.tip[r];
    const Real most_m = max_of(tip.depth_m, 0.0) + tip.local.tip->depth_max_m;
    Real& shift_m = scratch.system.shift_m[r];
    if (tip.depth_m - shift_m <= most_m) continue;
    shift_m = tip.depth_m - most_m;
    scratch.system.force_N[r] = force_N[r] = tip_at(tip, most_m).force_N;
    scratch.work.tip_laws += load.law[r].is_line ? kLineLaws : 1;
  }
}

void judge_solution(const ElasticLoad& load, std::int32_t laws, const RegionSolution& result, bool is_last,
                    Scratch& scratch) PALPATE_RT {
  if (load.n > 1) count(result, load, laws, scratch.work);
  scratch.residual_m = result.residual_m;
  if (result.singular) scratch.status |= Status::kCouplingSingular;
  if (is_last && !(scratch.residual_m <= kTravelTolerance_m)) scratch.status |= Status::kNotConverged;
}

// How far the tick moved any place of the surface at most.
Real swept_m(const Model& model, const ElasticWork& work) PALPATE_RT {
  Real sum = 0;
  for (std::int32_t t = 0; t < terms(model.params.elastic_soft); ++t)  // bound: terms
    sum += abs_of(work.y[t] - work.y_begun[t]) * work.reach_m[t];
  return sum;
}

void let_body_rest(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  state.elastic.reset();
  soft_products(model.params.elastic_soft, state.elastic.soft_rootJ.data(), work_of(scratch).y);
  state.elastic.swept_m = swept_m(model, work_of(scratch));
}

template <class Count>
void solve_pressed(const Model& model, State& state, Scratch& scratch, Count soft) PALPATE_RT {
  const std::int32_t regions = scratch.rows.regions;
  ElasticLoad load;
  Real own_bend_m_per_N[kMaxRegions], change_N[kMaxRegions];
  load.own_bend_m_per_N = own_bend_m_per_N;
  load.change_N = change_N;
  Linearised<Count> body(model, state, scratch, load, soft);
  Real before_N[kMaxRegions];
  for (std::int32_t r = 0; r < regions; ++r) before_N[r] = state.region[scratch.rows.slot[r]].normal_force_N;
  Real force_N[kMaxRegions];
  body.prepare(before_N);
  const std::int32_t laws = laws_in(load);
  scratch.work.tip_laws += kPlaceLaws * regions;
  scratch.work.linked += regions * (regions + 1) / 2 * (model.params.elastic_linear + model.params.elastic_soft);
  for (std::int32_t i = 0; i < kSolvesOfFriction; ++i) {  // bound: kSolvesOfFriction
    body.let_give(i == 0 ? before_N : force_N);
    const bool is_last = i + 1 == kSolvesOfFriction;
    RegionSolution result = solve_forces(load, laws, scratch, is_last, force_N);
    scratch.work.mode_cubes += soft * soft * soft;
    scratch.work.linearised += i == 0 ? regions : (regions + 1) / 2;  // the second has most of what the first found
    const bool is_answer = result.foreseen || result.residual_m <= kTravelTolerance_m;  // else it tells no slip
    const bool goes_on = !is_last && is_answer && load.evaluations_left >= kLeastOfSolve && body.slips(force_N);
    if (!goes_on && !is_last) finish_forces(load, scratch, result, force_N);
    judge_solution(load, laws, result, !goes_on, scratch);
    if (!goes_on) break;
    load.go_on_from(scratch.system.shift_m);
  }
  if ((scratch.status & Status::kNotConverged) != 0) bound_forces(load, scratch, force_N);
  const Real left_m = body.step(force_N);
  scratch.work.soft_pairs_again += soft_work(pairs(model.params.elastic_soft)) / 2;
  if (!(left_m <= kElasticTolerance_m)) scratch.status |= Status::kNotConverged;
  if (work_of(scratch).energy.is_outside) scratch.status |= Status::kDepthBeyondRange;
  scratch.residual_m = max_of(scratch.residual_m, left_m);
  state.elastic.swept_m = swept_m(model, work_of(scratch));
  scratch.energy_J += body.energy_J() + body.linear_energy_J(force_N);
  body.pull_aside(force_N);
  press_regions(load, state, scratch);
  for (std::int32_t r = 0; r < regions; ++r) {  // bound: kMaxRegions
    Real& root_tangent = scratch.system.root_tangent[r];
    root_tangent = load.told_root_tangent(r, force_N[r], root_tangent);
    state.region[scratch.rows.slot[r]].tangent_N_per_m = load.rubbed_N_per_m(r, root_tangent);
  }
  body.tell_tangent(force_N);
}

void solve(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  sort_rows(state, scratch);
  if (scratch.rows.regions == 0) return let_body_rest(model, state, scratch);
  state.elastic.moved = 1;
  with_mode_count(model.params.elastic_soft, [&](auto soft) PALPATE_RT { solve_pressed(model, state, scratch, soft); });
}

// Of a tangent that is told by itself: copied, and gone over for every mode.
std::int32_t told_entries(std::int32_t soft, std::int32_t size) PALPATE_RT { return (1 + soft) * size * size; }

// A device that evaluates the tangent does so until the next command, a tick and the delay; in so many times as long
// the motion of the last tick does not bring to slip what sticks, or its stiffness is told as the secant of that way.
// Told whole, a tube that was about to slip out of a clip's arms, or touched them fast, was extrapolated 0.2 to 0.4 N
// too far. With it, LineLaw::arm_back_m() and softer landings 1,260 of 1,280 drawn runs of snap_in with the local model
// are good; 1,236 were (2026-11-29).
constexpr Real kSlipAhead = 3;

// Friction with the stiffness of the place alone, against the surface as the soft modes moved it; then the tangent of
// all springs.
template <class Count, class Size>
class Rubbing {
 public:
  Rubbing(const Model& model, State& state, Scratch& scratch, Count soft, Size size) PALPATE_RT
      : model_(model),
        state_(state),
        scratch_(scratch),
        work_(work_of(scratch)),
        soft_(soft),
        size_(size),
        ahead_ticks_(model.params.local_period_s > 0 ? kSlipAhead * (1 + model.params.delay_s / model.params.period_s)
                                                     : 0) {}

  void account() PALPATE_RT {
    const FrictionParameters law = friction_parameters(model_.params);
    for (std::int32_t r = 0; r < scratch_.rows.regions; ++r) rub(law, r);  // bound: kMaxRegions
    if (slipping_ > 0) tell_before_slip();
    work_.tangent.eliminate(size_, soft_);
    for (std::int32_t r = 0; r < scratch_.rows.regions; ++r) yield_reversal(r);  // bound: kMaxRegions
    add_from(work_.tangent, 1, scratch_.stiffness, scratch_.other.stiffness);
    if (slipping_ > 0) add_from(work_.tangent, -1, scratch_.told_besides, scratch_.other.told_besides);
  }

 private:
  Region& region(std::int32_t r) const PALPATE_RT { return state_.region[scratch_.rows.slot[r]]; }

  Vec3 arm_w(const Region& of) const PALPATE_RT { return of.centre_w - tool_of(state_, of.hand).position_m; }

  void rub(const FrictionParameters& law, std::int32_t r) PALPATE_RT {
    Region& here = region(r);
    here.depth_equivalent_m = here.depth_max_m;
    FrictionLoad load;
    load.tangent_N_per_m = here.tangent_N_per_m;
    load.step_w = material_motion(model_, state_, rows_of(scratch_, r), here.centre_w) - work_.rub[r].moved_w;
    const FrictionForce friction = rub_region(law, load, arm_w(here), here);
    const TangentAxes axes = tangent_axes(friction, here.normal_w);
    Real share = 1;
    if (ahead_ticks_ > 0 && friction.along_N_per_m > 0) {
      const Real way_m = ahead_ticks_ * norm(tangential_part(load.step_w, here.normal_w));
      share = share_before_slip(law, friction, here.normal_force_N, way_m);
    }
    add(r, share * friction.along_N_per_m, axes.along);
    add(r, share * friction.across_N_per_m, axes.across);
    if (!(share < 1)) return;
    const Real rest = 1 - share;
    slips_[slipping_] = {r, rest * friction.along_N_per_m, rest * friction.across_N_per_m, axes};
    slipping_ += 1;
  }
  // The tangent as far as it is there, less the springs that slip ahead, is what a device that evaluates it is told;
  // those come to it afterwards.
  void tell_before_slip() PALPATE_RT {
    ToolTangent told;
    told.begin_as(size_, work_.tangent);
    told.eliminate(size_, soft_);
    add_from(told, 1, scratch_.told_besides, scratch_.other.told_besides);
    scratch_.work.told += told_entries(soft_, size_);
    for (std::int32_t i = 0; i < slipping_; ++i) {  // bound: kMaxRegions
      const Slipping& s = slips_[i];
      add(s.region, s.along_N_per_m, s.axes.along);
      add(s.region, s.across_N_per_m, s.axes.across);
    }
  }
  void add_from(const ToolTangent& tangent, Real times, ContactStiffness& first, ContactStiffness& other) PALPATE_RT {
    add_to(first, tangent.from(soft_), times);
    if (has_two_tools(model_)) add_to(other, tangent.from(soft_ + ToolTangent::kTwist), times);
  }
  void add(std::int32_t r, Real stiffness_N_per_m, Vec3 axis) PALPATE_RT {
    if (!(stiffness_N_per_m > 0)) return;
    ToolTangent::Spring spring;
    aim_along(r, axis, spring);
    work_.tangent.add(size_, stiffness_N_per_m, spring);
  }
  void aim_along(std::int32_t r, Vec3 axis, ToolTangent::Spring& spring) const PALPATE_RT {
    const Region& here = region(r);
    const Vec3* sweep_w = work_.rub[r].sweep_w;
    aim(
        size_, soft_, soft_ + here.hand * ToolTangent::kTwist, axis, arm_w(here),
        [&](std::int32_t a) PALPATE_RT { return dot(axis, sweep_w[a]); }, spring);
  }
  // What slips turns back on a spring in series with what the modes give under it.
  void yield_reversal(std::int32_t r) PALPATE_RT {
    Real& stiffness = region(r).reversal_N_per_m;
    if (!(stiffness > 0)) return;
    ToolTangent::Spring back;
    aim_along(r, unit_or(region(r).stretch_w, {}), back);
    stiffness /= 1.0 + stiffness * work_.tangent.yield_m_per_N(soft_, back);
  }

  const Model& model_;
  State& state_;
  Scratch& scratch_;
  ElasticWork& work_;
  const Count soft_;
  const Size size_;
  const Real ahead_ticks_;  // in which what a device is told now is extrapolated; 0: it holds forces
  struct Slipping {
    std::int32_t region;
    Real along_N_per_m, across_N_per_m;  // beyond what is told
    TangentAxes axes;
  };
  Unwritten<Slipping, kMaxRegions> slips_;
  std::int32_t slipping_ = 0;
};

void rub(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  if (scratch.rows.regions > 0)
    with_mode_count(model.params.elastic_soft, [&](auto soft) PALPATE_RT {
      with_tangent_size(model, soft, [&](auto size) PALPATE_RT {
        Rubbing<decltype(soft), decltype(size)>(model, state, scratch, soft, size).account();
      });
    });
  sum_up(model, state, scratch);
}

// Whether the number that says how many there are is one.
bool has_drawn_shapes(const Model& model) noexcept {
  const std::int64_t blocks = all_vertex_floats(model);
  if (model.sizes.n_elastic_vertex <= blocks) return false;
  const float count = model.elastic_vertex[static_cast<std::size_t>(blocks)];
  return count >= 0 && count <= static_cast<float>(kMostDrawnShapes) &&
         static_cast<float>(static_cast<std::int32_t>(count)) == count;
}

// Of solids (config/tool/rounded_solid.h): plates have two axes and a flat tip, edges leave less than all.
bool is_sound(const ToolPiece& piece, const TipLaw& law) noexcept {
  const double* half = piece.half_extent_m;
  if (piece.shape == PieceShape::kBox) return half[0] > 1e-6 && half[1] > 1e-6 && law.half_power == 2;
  return piece.shape != PieceShape::kCapsule || (half[0] >= 0 && half[0] < 1 && half[1] >= 0 && half[1] < 1);
}

// A row for every point: one of a piece, or one for each part of the surface.
ImageResult check_points(const Model& model) noexcept {
  if (model.tool_point.size() > static_cast<std::size_t>(kMaxPieces)) return broken("n_tool_point", 0);
  for (std::size_t i = 0; i < model.tool_point.size(); ++i) {
    const ToolPoint& point = model.tool_point[i];
    const auto piece = static_cast<std::size_t>(point.piece);
    if (point.begins_at != 0 && !in_range(point.begins_at, model.triangle.size()))
      return broken("tool_point.begins_at", i);
    if (piece < model.tip_law.size() && !is_sound(model.piece[piece], model.tip_law[piece]))
      return broken("piece.half_extent_m", piece);
    if (point.begins_at == 0 && model.piece[piece].point_count > 1) return not_together("piece.tip_points", piece);
  }
  return {};
}

ImageResult check_moduli(const Model& model) noexcept {
  if (!has_moduli(model)) return {};
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(model.sizes.n_vertex); ++v) {
    const Real ratio = modulus_ratio(model, v);
    if (!(ratio >= kLeastModulusRatio && ratio <= kMostModulusRatio))
      return broken("elastic_vertex",
                    static_cast<std::size_t>(model.sizes.n_elastic_vertex - model.sizes.n_vertex + v));
  }
  return {};
}

ImageResult check_data(const Model& model) noexcept {
  const ModelParams& p = model.params;
  const ModelSizes& n = model.sizes;
  if (p.response_law != ResponseLaw::kTip) return broken("response_law", 0);
  if (p.elastic_soft < 1) return broken("elastic_soft", 0);
  if (!(p.elastic_radius_rootJ > 0)) return broken("elastic_radius_rootJ", 0);
  const std::int64_t pair = pairs(p.elastic_soft);
  const std::int64_t blocks = all_vertex_floats(model);
  if (!has_drawn_shapes(model)) return broken("n_elastic_vertex", 0);
  const std::int64_t shapes = blocks + drawn_floats(model);
  if (n.n_elastic_vertex != shapes && n.n_elastic_vertex != shapes + n.n_vertex) return broken("n_elastic_vertex", 0);
  if (n.n_elastic_cubic != pair * p.elastic_soft) return broken("n_elastic_cubic", 0);
  if (n.n_elastic_quartic != pair * pair) return broken("n_elastic_quartic", 0);
  for (const ImageResult& result :
       {check_tip_laws(model), check_numbers(model.elastic_vertex, "elastic_vertex"),
        check_numbers(model.elastic_cubic, "elastic_cubic"), check_numbers(model.elastic_quartic, "elastic_quartic")})
    if (result.error != ImageError::kNone) return result;
  return check_moduli(model);
}

std::size_t work_bytes(const Model& model) noexcept {
  return sizeof(ElasticWork) + model.tool_point.size() * (sizeof(ElasticRow) + sizeof(PartSeeds));
}

Real linear_reach_m(const Model& model) noexcept {
  Real most = 0;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(model.vertex_m.size()); ++v) {
    Real square = 0;
    for (std::int32_t i = 0; i < 3 * model.params.elastic_linear; ++i) {
      const auto one = static_cast<Real>(linear_shapes(model, v)[i]);
      square += one * one;
    }
    most = max_of(most, square);
  }
  return square_root(most);
}

// The shapes' reaches and the parts' seeds. Nothing else is read before the tick has written it.
void create_work(const Model& model, void* block) noexcept {
  ElasticWork& work = *static_cast<ElasticWork*>(block);
  work.points = static_cast<std::int32_t>(model.tool_point.size());
  const std::int32_t count = terms(model.params.elastic_soft);
  for (std::int32_t t = 0; t < count; ++t) {
    Real most = 0;
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(model.vertex_m.size()); ++v) {
      const float* u = vertex_block(model, v) + kTermFloats * t;
      const Vec3 shape{static_cast<Real>(u[0]), static_cast<Real>(u[1]), static_cast<Real>(u[2])};
      most = max_of(most, squared_norm(shape));
    }
    work.reach_m[t] = square_root(most);
  }
  work.linear_reach_m = linear_reach_m(model);
  for (std::int32_t i = 0; i < work.points; ++i) {
    const std::int32_t begins_at = model.tool_point[static_cast<std::size_t>(i)].begins_at;
    if (begins_at > 0) work.seeds_of(i) = spread_over_part(model, begins_at);
  }
}

// A tip stands on the carried surface after kFootWalk facets and a turn about a fan, or on its facet; at an edge on
// both of its sides. Found twice in a tick that loses it.
void add_most_places(const Model& model, const SceneSizes& n, Work& work) noexcept {
  const std::int32_t all = terms(model.params.elastic_soft), places = 2 * n.points;
  work.shown += places * ((3 * (kFootWalk + 2) + 1) * all + kPushTerms);
  work.crossed += places * kFootWalk;
  work.foot_steps += 2 * places * (kFootNewtonSteps + kMaxTurn / foot::kSpokesPerStep);
  work.placed += places;
  work.lines += places;
  work.shapes += places * kMostOfShapes * all;
  if (!touches_in_parts(model)) return;
  const std::int32_t asked = n.points * kMostPartLooks, allowed = kPartShare - 1 + kMostPartLooks;
  work.part_looks += asked < allowed ? asked : allowed;
  work.part_visits += n.points;
}

void add_most_work(const Model& model, const SceneSizes& n, Work& work) noexcept {
  const std::int32_t soft = model.params.elastic_soft, pair = pairs(soft);
  add_most_points(model, n, work);
  work.queries += 2 * n.points;  // a capsule asks three times
  add_most_places(model, n, work);
  // A solve whose step fails ends with it; one that is foreseen may be looked at again.
  const std::int32_t evaluations = kTipEvaluations + 1, steps = kTipEvaluations + 2 * kSolvesOfFriction;
  add_most_regions(n, steps, evaluations, work);
  work.evaluations += evaluations + 2 * steps;
  work.soft_pairs += soft_work(pair);
  const std::int32_t alone = kSolvesOfFriction * (kSeriesIterations + 1), together = (evaluations + 1) * n.regions;
  work.tip_laws += kLineLaws * (alone > together ? alone : together) + kPlaceLaws * n.regions;
  work.linearised += n.regions + (n.regions + 1) / 2;
  work.mode_cubes += kSolvesOfFriction * soft * soft * soft;
  work.linked += n.regions * (n.regions + 1) / 2 * (model.params.elastic_linear + soft);
  work.soft_pairs_again += soft_work(pair) / 2;
  if (model.params.local_period_s > 0)
    with_tangent_size(model, soft, [&](std::int32_t size) PALPATE_RT { work.told += told_entries(soft, size); });
}

}  // namespace

const ContactMethod elastic_method{find_elastic_tips, solve,         rub,        check_points,
                                   check_data,        add_most_work, work_bytes, create_work};

}  // namespace palpate
