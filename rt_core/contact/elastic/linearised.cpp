#include "rt_core/contact/elastic/linearised.h"

#include "rt_core/cholesky.h"
#include "rt_core/contact/elastic/damped_step.h"
#include "rt_core/contact/elastic/place_pull.h"

namespace palpate {

namespace {

using namespace elastic_layout;

// Of the linear stiffness: a softer linearisation is stiffened, and the next one tells. Keeps a body at a limit point
// from being thrown across it.
constexpr Real kLeastStiffness = 1e-2;
// Of the ball's radius: the longest step of one linearisation.
constexpr Real kLongestStep = 0.25;
// Of a step that turned the last one back, what the next tick goes on with.
constexpr Real kTurnedBack = 0.01;

// The lower triangle of h becomes the factor of h + shift; false when a pivot falls below the least stiffness.
template <class Count>
bool factor_shifted(const Real* h, Real shift, Count n, Real* factor) PALPATE_RT {
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

// As stiff as it has to be for that: returns by how much; the linear body, and kHuge, where nothing helps. The linear
// stiffness is 1.
template <class Count>
Real factor_stiffened(const Real* h, Count n, Real* factor) PALPATE_RT {
  for (const Real shift : {0.0, 0.1, 0.5, 2.0, 8.0}) {  // bound: 5
    if (factor_shifted(h, shift, n, factor)) return shift;
  }
  for (std::int32_t i = 0; i < n; ++i)  // bound: soft^2
    for (std::int32_t j = 0; j <= i; ++j) factor[i * n + j] = i == j ? 1.0 : 0.0;
  return kHuge;
}

// Whether it surely is so by its diagonal.
template <class Count>
bool is_stiff(const Real* h, Count n) PALPATE_RT {
  for (std::int32_t i = 0; i < n; ++i) {  // bound: soft^2
    Real left = h[i * n + i];
    for (std::int32_t j = 0; j < n; ++j) left -= j == i ? 0.0 : abs_of(h[i * n + j]);
    if (!(left >= kLeastStiffness)) return false;
  }
  return true;
}
template <class Count>
void stiffen(Real* h, Count n) PALPATE_RT {
  Real factor[kMaxSoftModes * kMaxSoftModes];
  const Real stiffer = factor_stiffened(h, n, factor);
  for (std::int32_t a = 0; a < n; ++a) {  // bound: soft^2
    for (std::int32_t b = 0; b < a && stiffer >= kHuge; ++b) h[a * n + b] = 0;
    h[a * n + a] = stiffer < kHuge ? h[a * n + a] + stiffer : 1.0;
  }
}

// Of the whole H: what the forces of a region add by the turn of its pull.
template <class Count>
void add_turn(Real force_N, const Real* turn, Count n, Real* h) PALPATE_RT {
  std::int32_t pair = 0;
  for (std::int32_t a = 0; a < n; ++a) {  // bound: pairs
    for (std::int32_t b = a; b < n; ++b, ++pair) {
      h[a * n + b] += force_N * turn[pair];
      if (a != b) h[b * n + a] += force_N * turn[pair];
    }
  }
}
// Friction along one axis: its stiffness and its force.
template <class Count>
void add_rub(const RubAxis& axis, Count n, Real* h, Real* force) PALPATE_RT {
  for (std::int32_t a = 0; a < n; ++a) {  // bound: soft^2
    force[a] += axis.force_N * axis.sweep[a];
    const Real row = axis.stiffness_N_per_m * axis.sweep[a];
    for (std::int32_t b = 0; b < n; ++b) h[a * n + b] += row * axis.sweep[b];
  }
}
template <class Count>
void answer(const Real* factor, const Real* load, Count n, Real* moved) PALPATE_RT {
  for (std::int32_t a = 0; a < n; ++a) moved[a] = load[a];  // bound: soft
  cholesky_solve(factor, moved, n);
}

}  // namespace

CarriedSurface look(const Model& model, const State& state, Scratch& scratch) PALPATE_RT {
  ElasticWork& work = work_of(scratch);
  soft_products(model.params.elastic_soft, state.elastic.soft_rootJ.data(), work.y);
  soft_energy(model, state.elastic.soft_rootJ.data(), work.y, work.energy);
  scratch.work.soft_pairs += soft_work(pairs(model.params.elastic_soft));
  return {model, work.y, &scratch.surface_work, &scratch.work};
}

void let_go(const Model& model, const SoftEnergy& energy, Real* step) PALPATE_RT {
  with_mode_count(model.params.elastic_soft, [&](auto n) PALPATE_RT {
    Real factor[kMaxSoftModes * kMaxSoftModes];
    factor_stiffened(energy.curvature, n, factor);
    for (std::int32_t a = 0; a < n; ++a) step[a] = -energy.slope[a];
    cholesky_solve(factor, step, n);
  });
}

template <class Count>
Linearised<Count>::Linearised(const Model& model, State& state, Scratch& scratch, ElasticLoad& load,
                              Count soft) PALPATE_RT : model_(model),
                                                       state_(state),
                                                       scratch_(scratch),
                                                       load_(load),
                                                       work_(work_of(scratch)),
                                                       friction_(friction_parameters(model.params)),
                                                       n_(soft) {
  for (std::int32_t r = 0; r < regions(); ++r) {  // bound: kMaxRegions
    const RegionRows rows = rows_of(scratch, r);
    const Region& region = state.region[scratch.rows.slot[r]];
    row_[r] = &work_.row_of(rows[0].point);
    work_.rub[r] = begin_rub(region, material_motion(model, state, rows, row_[r]->foot.foot_w));
  }
}

template <class Count>
void Linearised<Count>::prepare(const Real* force_N) PALPATE_RT {
  for (std::int32_t r = 0; r < regions(); ++r) let_stick(model_, state_, *row_[r], work_.rub[r]);  // bound: kMaxRegions
  if (regions() > 1) pairs_.link(model_, row_, regions());
  gather();
  add_places(force_N);
  factorise(force_N);
}

// The force that region r's tip is about to have, as one Newton step from the last with the modes held still has it.
// Returns it, with what its place asks for, at most as much as the force itself, as along the surface.
template <class Count>
Real Linearised<Count>::place_ahead(const Real* force_N, std::int32_t r, PlaceForce& place) const PALPATE_RT {
  const ElasticRow& row = *row_[r];
  const FarField& own = load_.own[r].far;
  Real e = row.travel_m - far_shift_m(own, force_N[r]);
  for (std::int32_t j = 0; j < regions() && regions() > 1; ++j)  // bound: kMaxRegions
    e -= pairs_.linear_m_per_N[r][j] * force_N[j];
  const LawPoint point = tip_at(load_.tip[r], e);
  const Real give = far_slope_m_per_N(own, force_N[r]);
  const Real change = (point.force_N - force_N[r]) / (1.0 + give * point.tangent_N_per_m);
  // A touch that begins, or a snap: that step does not say where the force goes.
  if (!(abs_of(change) < force_N[r])) return 0;
  const Real force = force_N[r] + change;
  e = max_of(e - give * change, 0.0);
  place = load_.place_force(r, e, tip_energy_J(load_.tip[r], e), force);
  const Real length = norm(place.along(row)), inside = clamp_to(2.0 - force / own.force_max_N, 0.0, 1.0);
  // Gone at twice the force up to which c1 holds.
  place.scale(inside * inside * (3 - 2 * inside) * (length > force ? force / length : 1.0));
  return force;
}

// A mode that slides the material under a tip changes c, c1, beta and the curvature there, and with them what the place
// stores: a force on the mode, as the one along the surface is on the tip. Without it a loop over an arch kept 1.5e-4
// of the stored energy. Its slopes in force and amplitudes go into the row's pull and turn: without them a ball of 60
// mm on a block of 20 was thrown from side to side by 64 N (2026-11-25).
template <class Count>
void Linearised<Count>::add_places(const Real* force_N) PALPATE_RT {
  for (std::int32_t a = 0; a < n_; ++a) place_rootJ_[a] = 0;
  for (std::int32_t r = 0; r < regions(); ++r) {  // bound: kMaxRegions (pairs + kMaxRegions)
    ElasticRow& row = *row_[r];
    if (!(force_N[r] > 0) || !row.has_slide) continue;
    PlaceForce place;
    const Real force = place_ahead(force_N, r, place);
    if (force > 0) pull_by_place(place, force, n_, row, place_rootJ_);
  }
}

template <class Count>
bool Linearised<Count>::slips(const Real* force_N) PALPATE_RT {
  Real delta[kMaxSoftModes];
  find_step(force_N, delta);
  bool some = false;
  for (std::int32_t r = 0; r < regions(); ++r) {  // bound: kMaxRegions
    const bool slips = let_slip(friction_, row_[r]->foot.normal_w, force_N[r], delta, n_, work_.rub[r]);
    some = some || slips;
  }
  slips_ = some;
  if (some) factorise(force_N);
  return some;
}

// H of the body and of the pulls' turn.
template <class Count>
void Linearised<Count>::turned(const Real* force_N, Real* h) const PALPATE_RT {
  for (std::int32_t i = 0; i < n_ * n_; ++i) h[i] = work_.energy.curvature[i];              // bound: soft^2
  for (std::int32_t r = 0; r < regions(); ++r) add_turn(force_N[r], row_[r]->turn, n_, h);  // bound: kMaxRegions pairs
}

template <class Count>
void Linearised<Count>::factorise(const Real* force_N) PALPATE_RT {
  Real h[kMaxSoftModes * kMaxSoftModes];
  turned(force_N, h);
  for (std::int32_t a = 0; a < n_; ++a) free_step_[a] = -work_.energy.slope[a] - place_rootJ_[a];
  for (std::int32_t r = 0; r < regions(); ++r) {  // bound: kMaxRegions soft^2
    if (!work_.rub[r].is_on) continue;
    for (const RubAxis& axis : work_.rub[r].axis) add_rub(axis, n_, h, free_step_);  // bound: 2
  }
  factor_stiffened(h, n_, factor_);
  cholesky_solve(factor_, free_step_, n_);
  for (std::int32_t r = 0; r < regions(); ++r) {  // bound: kMaxRegions soft^2
    Real moved[kMaxSoftModes];
    answer(factor_, row_[r]->pull, n_, moved);
    for (std::int32_t a = 0; a < n_; ++a) moved_[a][r] = moved[a];
  }
  for (std::int32_t a = 0; a < n_; ++a) end_lanes(regions(), moved_[a]);
}

template <class Count>
void Linearised<Count>::gather() PALPATE_RT {
  load_.n = regions();
  load_.region = load_.tip_of;
  load_.evaluated = &scratch_.work.tip_laws;
  for (std::int32_t r = 0; r < load_.n; ++r) {  // bound: kMaxRegions
    Contact& contact = rows_of(scratch_, r)[0];
    load_.own[r] = own_field(*local_law(model_, contact.piece).tip, *row_[r]);
    load_.tip_of[r] = {&load_.tip[r], 1, load_.own[r].far};
    add_tip(contact, r);
  }
}

template <class Count>
void Linearised<Count>::let_give(const Real* before_N) PALPATE_RT {
  load_.before_N = before_N;
  for (std::int32_t r = 0; r < load_.n; ++r) {  // bound: kMaxRegions soft, kMaxRegions^2 / 2
    const ElasticRow& row = *row_[r];
    Real soft = 0;
    for (std::int32_t a = 0; a < n_; ++a) soft += row.pull[a] * moved_[a][r];
    load_.tip_of[r].far.c0_m_per_N = load_.own[r].far.c0_m_per_N + soft;
    load_.tip[r].depth_m = rows_of(scratch_, r)[0].depth_m = row.travel_m + dot(row.pull, free_step_, n_);
  }
  if (load_.n > 1) couple();
}

// `delta`: the step, no longer than one may be; returns what share of the whole that is.
template <class Count>
Real Linearised<Count>::find_step(const Real* force_N, Real* delta) const PALPATE_RT {
  for (std::int32_t a = 0; a < n_; ++a) {  // bound: soft x kMaxRegions
    delta[a] = free_step_[a];
    for (std::int32_t r = 0; r < regions(); ++r) delta[a] -= force_N[r] * moved_[a][r];
  }
  const Real length = square_root(dot(delta, delta, n_)), longest = kLongestStep * model_.params.elastic_radius_rootJ;
  const Real share = length <= longest ? 1.0 : longest / length;
  for (std::int32_t a = 0; a < n_; ++a) delta[a] *= share;
  return share;
}

// Shortens the step of every amplitude that goes to and fro; returns whether the motion is one to go on with.
template <class Count>
bool Linearised<Count>::damp_step(Real* delta) PALPATE_RT {
  bool goes_on = false, is_damped = false;
  for (std::int32_t a = 0; a < n_; ++a) {  // bound: soft
    DampedStep& mode = state_.elastic.mode[a];
    goes_on = goes_on || mode.asked != 0;
    const Real share = damp(state_.elastic.step_rootJ[a] + delta[a], mode);
    is_damped = is_damped || share < 1;
    delta[a] *= share;
  }
  return goes_on && !is_damped;
}

template <class Count>
Real Linearised<Count>::step(const Real* force_N) PALPATE_RT {
  Real delta[kMaxSoftModes];
  bool rubs = false;
  for (std::int32_t r = 0; r < regions(); ++r) rubs = rubs || work_.rub[r].is_on;  // bound: kMaxRegions
  const Real share = find_step(force_N, delta);
  const bool goes_on = rubs || damp_step(delta);
  auto &p = state_.elastic.soft_rootJ, &goes = state_.elastic.step_rootJ;
  Real back = 0;
  for (std::int32_t a = 0; a < n_; ++a) back += goes[a] * (goes[a] + delta[a]);  // bound: soft
  // What springs back from under a tip that slips does not go on: a column swung between the two every other tick. Nor
  // does what turns back, but for its direction: steps twice too far alternate where H is off by a third (a ring on its
  // rim, 4e-4 N every other tick, 2026-11-25). With friction every amplitude by itself: jaws that drag a block along
  // bent and twisted it to and fro across the drag, by up to 34 mN for as long as it went on (2026-11-26). Without,
  // that would leave a loop over an arch 1e-6 of the stored energy instead of 4e-8.
  const bool stops = !goes_on || share < 1 || slips_;
  for (std::int32_t a = 0; a < n_; ++a) {  // bound: soft
    const Real d = delta[a], turns = rubs ? goes[a] * (goes[a] + d) : back;
    p[a] += is_finite(d) ? d : 0.0;
    goes[a] = (stops ? 0.0 : turns < 0 ? kTurnedBack : 1.0) * (p[a] - work_.y_begun[a]);
  }
  for (std::int32_t r = 0; r < regions(); ++r) sweep(delta, r);  // bound: kMaxRegions
  return left_m(force_N, delta);
}

// V' + sum F pull + places' - friction where the step ended, and what H^-1 of it moves.
template <class Count>
Real Linearised<Count>::left_m(const Real* force_N, const Real* delta) PALPATE_RT {
  Real left[kMaxSoftModes];
  soft_products(n_, state_.elastic.soft_rootJ.data(), work_.y);
  energy_J_ = soft_slope(model_, state_.elastic.soft_rootJ.data(), work_.y, left);
  for (std::int32_t a = 0; a < n_; ++a) left[a] += place_rootJ_[a];
  for (std::int32_t r = 0; r < regions(); ++r) {  // bound: kMaxRegions pairs
    const ElasticRow& row = *row_[r];
    std::int32_t pair = 0;
    for (std::int32_t a = 0; a < n_; ++a) {
      left[a] += force_N[r] * row.pull[a];
      for (std::int32_t b = a; b < n_; ++b, ++pair) {
        const Real turn = force_N[r] * row.turn[pair];
        left[a] += turn * delta[b];
        if (a != b) left[b] += turn * delta[a];
      }
    }
    if (!work_.rub[r].is_on) continue;
    for (const RubAxis& axis : work_.rub[r].axis) {  // bound: 2
      const Real rubs_N = axis.force_N - axis.stiffness_N_per_m * dot(axis.sweep, delta, n_);
      for (std::int32_t a = 0; a < n_; ++a) left[a] -= rubs_N * axis.sweep[a];
    }
  }
  Real most = 0;
  for (std::int32_t r = 0; r < regions(); ++r) {
    Real moves = 0;
    for (std::int32_t a = 0; a < n_; ++a) moves += moved_[a][r] * left[a];
    most = max_of(most, abs_of(moves));
  }
  return most;
}

// How far the surface under a region went along.
template <class Count>
void Linearised<Count>::sweep(const Real* delta, std::int32_t r) PALPATE_RT {
  BodyRub& rub = work_.rub[r];
  if (!rub.is_on) return;
  for (const RubAxis& axis : rub.axis) rub.moved_w += dot(axis.sweep, delta, n_) * axis.unit_w;  // bound: 2
}

// H as stiff as it has to be without friction: a tangent below zero would not be one to step by.
template <class Count>
void Linearised<Count>::tell_tangent(const Real* force_N) const PALPATE_RT {
  Real h[kMaxSoftModes * kMaxSoftModes];
  turned(force_N, h);
  if (!is_stiff(h, n_)) stiffen(h, n_);
  with_tangent_size(model_, n_, [&](auto size) PALPATE_RT {
    work_.tangent.begin(size, n_, h);
    if (regions() > 1) return tell_pairs(size, force_N);
    ToolTangent::Spring spring;
    aim_normal(size, 0, spring);
    work_.tangent.add(size, load_.place_N_per_m(0, force_N[0], scratch_.system.root_tangent[0]), spring);
  });
}

template <class Count>
template <class Size>
void Linearised<Count>::aim_normal(Size size, std::int32_t r, ToolTangent::Spring& out) const PALPATE_RT {
  const Region& region = state_.region[scratch_.rows.slot[r]];
  const Real* pull = row_[r]->pull;
  aim(
      size, n_, n_ + region.hand * ToolTangent::kTwist, region.normal_w,
      region.centre_w - tool_of(state_, region.hand).position_m, [&](std::int32_t a) PALPATE_RT { return pull[a]; },
      out);
}

// Places that lean on one another beyond the soft modes: with g the roots of their laws' tangents and C what they give,
// g (I + g C g)^-1 g = Y^T Y of as many springs, Y = L^-1 g.
template <class Count>
template <class Size>
void Linearised<Count>::tell_pairs(Size size, const Real* force_N) const PALPATE_RT {
  const std::int32_t n = regions();
  Real g[kMaxRegions], force[kMaxRegions], slope[kMaxRegions], bend[kMaxRegions];
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions
    g[r] = scratch_.system.root_tangent[r];
    force[r] = force_N[r];
  }
  end_lanes(n, g);
  end_lanes(n, force);
  load_.pair.slopes(n, force, slope, bend);
  FactorLanes system;
  for (std::int32_t j = 0; j < n; ++j) {  // bound: kMaxRegions^2 soft / 8
    for (std::int32_t b = j / kRegionLanes * kRegionLanes; b < n; b += kRegionLanes) {
      Double4 c = load_.pair.bends(force, j, b);
      for (std::int32_t a = 0; a < n_; ++a) c -= splat4(row_[j]->pull[a]) * load4(moved_[a] + b);
      store(system.column[j] + b, splat4(g[j]) * c * load4(g + b));
    }
    system.column[j][j] = 1.0 + g[j] * (far_slope_m_per_N(load_.own[j].far, force[j]) + bend[j]) * g[j];
  }
  if (!system.factor(n)) return;
  ToolTangent::Spring spring[kMaxRegions];
  for (std::int32_t k = 0; k < n; ++k) {  // bound: kMaxRegions^2 kMost / 8
    Real* to = spring[k].slope;
    aim_normal(size, k, spring[k]);
    for (std::int32_t b = 0; b < size; b += 4) {
      Double4 left = splat4(g[k]) * load4(to + b);
      for (std::int32_t j = 0; j < k; ++j) left -= splat4(system.column[j][k]) * load4(spring[j].slope + b);
      store(to + b, splat4(system.inverse[k]) * left);
    }
    work_.tangent.add(size, 1.0, spring[k]);
  }
}

template <class Count>
Real Linearised<Count>::linear_energy_J(const Real* force_N) const PALPATE_RT {
  Real energy = 0;
  for (std::int32_t r = 0; r < regions() && regions() > 1; ++r) {  // bound: kMaxRegions^2
    Real first = 0, second = 0;
    for (std::int32_t j = 0; j < regions(); ++j) {
      first += pairs_.linear_m_per_N[r][j] * force_N[j];
      second += load_.pair.h_m_per_N2[r][j] * force_N[j];
    }
    energy += force_N[r] * (0.5 * first + force_N[r] * second);
  }
  return energy;
}

template <class Count>
void Linearised<Count>::add_tip(Contact& contact, std::int32_t at) PALPATE_RT {
  const ElasticRow& row = *row_[at];
  Tip& tip = load_.tip[at];
  tip = Tip{};
  tip.local = local_law(model_, contact.piece);
  place_law(*tip.local.tip, row, load_.law[at]);
  tip.scale = load_.law[at].scale;
  tip.place = &load_.law[at].terms;
  if (load_.law[at].is_line) tip.become(load_.law[at].line);
  if (load_.law[at].is_plate) tip.local = {&load_.law[at].plate, nullptr};
  load_.placed[at] = &row;
  contact.position_w = row.foot.foot_w;
  contact.normal_w = row.foot.normal_w;
}

// c1 is what the modes' travel under one tip does to it; of two tips that hold one another's modes still it is nothing:
// W = c1 F^2 (F + sum share F_j) / 3. A wall pinched from both sides had a place softer than nothing (2026-11-23).
template <class Count>
void Linearised<Count>::couple() PALPATE_RT {
  PairLanes& pair = load_.pair;
  for (std::int32_t r = 0; r < load_.n; ++r) {  // bound: kMaxRegions^2 soft / 4
    const FarField& own = load_.own[r].far;
    const Real force = load_.before_N[r], held = force > own.force_max_N ? own.force_max_N / force : 1.0;
    const Double4 second = splat4(2.0 / 3 * held * own.c1_m_per_N2);
    for (std::int32_t b = 0; b < load_.n; b += kRegionLanes) {
      Double4 c = load4(pairs_.linear_m_per_N[r] + b);
      for (std::int32_t a = 0; a < n_; ++a) c += splat4(row_[r]->pull[a]) * load4(moved_[a] + b);
      store(pair.c_m_per_N[r] + b, c);
      store(pair.h_m_per_N2[r] + b, second * load4(pairs_.share[r] + b));
    }
    pair.c_m_per_N[r][r] = 0;
    end_lanes(load_.n, pair.c_m_per_N[r]);
  }
  for (std::int32_t r = 0; r < load_.n; ++r) {  // bound: kMaxRegions^2
    for (std::int32_t j = 0; j < load_.n; ++j) pair.h_across_m_per_N2[j][r] = pair.h_m_per_N2[r][j];
  }
  for (std::int32_t r = 0; r < load_.n; ++r) end_lanes(load_.n, pair.h_across_m_per_N2[r]);
}

template class Linearised<TwoModes>;
template class Linearised<ThreeModes>;
template class Linearised<FourModes>;
template class Linearised<std::int32_t>;

}  // namespace palpate
