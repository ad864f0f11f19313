// The region solver's steps for all tips of an elastic body at once.
#include "rt_core/contact/elastic/elastic_load.h"

namespace palpate {

namespace {

// Of I + g H g, whose pivots are 1 and more without what is of second order in the forces.
constexpr Real kLeastPivot = 0.1;

}  // namespace

void ElasticLoad::start(Real* shift_m) const PALPATE_RT {
  Real bend[kMaxRegions], force_N[kMaxRegions];
  for (std::int32_t r = 0; r < n; ++r) force_N[r] = before_N[r] > 0 ? before_N[r] : begins_N(r);  // bound: kMaxRegions
  end_lanes(n, force_N);
  pair.slopes(n, force_N, shift_m, bend);
  for (std::int32_t r = 0; r < n; ++r)
    shift_m[r] = keeps_dent(r, shift_m[r] + (before_N[r] > 0 ? far_shift_m(region[r].far, force_N[r]) : 0.0));
}

Real ElasticLoad::begins_N(std::int32_t r) const PALPATE_RT {
  if (!law[r].is_line) return 0;
  const Real left_m = left_of_m(r, max_of(dent_m(r, 0), 0.0), region[r].far.c0_m_per_N);
  return left_m * placed[r]->told.tangent_N_per_m;
}

Real ElasticLoad::evaluate(const Real* shift_m, RegionSystem& s) const PALPATE_RT {
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions
    const LawPoint at = load(r, shift_m[r]);
    s.force_N[r] = at.force_N;
    s.root_tangent[r] = square_root(at.tangent_N_per_m);
  }
  end_lanes(n, s.force_N);
  end_lanes(n, s.root_tangent);
  pair.slopes(n, s.force_N, s.residual_m, own_bend_m_per_N);
  Real largest = 0;
  for (std::int32_t r = 0; r < n; ++r) {
    s.residual_m[r] += far_shift_m(region[r].far, s.force_N[r]) - shift_m[r];
    own_bend_m_per_N[r] += far_slope_m_per_N(region[r].far, s.force_N[r]);
    largest = max_of(abs_of(s.residual_m[r]), largest);
  }
  return largest;
}

// The same of two regions, written out: by lanes it took four times as many instructions.
bool ElasticLoad::newton_step_of_two(RegionSystem& s) const PALPATE_RT {
  const Real *g = s.root_tangent, *rest = s.residual_m, *bend = own_bend_m_per_N;
  const Real both = curvature(s.force_N, 0, 1), a = 1.0 + g[0] * bend[0] * g[0], b = 1.0 + g[1] * bend[1] * g[1];
  const Real across = g[0] * both * g[1], least = b - across * across / a;
  if (!(a > 1e-14 && least > 1e-14 * b && a < kHuge * kHuge && least < kHuge * kHuge)) return false;
  const Real second = (-g[1] * rest[1] + across * g[0] * rest[0] / a) / least;
  change_N[0] = g[0] * (-g[0] * rest[0] - across * second) / a;
  change_N[1] = g[1] * second;
  s.step_m[0] = rest[0] + bend[0] * change_N[0] + both * change_N[1];
  s.step_m[1] = rest[1] + bend[1] * change_N[1] + both * change_N[0];
  for (std::int32_t r = 0; r < 2; ++r) s.step_m[r] = bent_step_m(r, s);  // bound: 2
  return true;
}

bool ElasticLoad::factor(const RegionSystem& s, Real second_order, FactorLanes& system) const PALPATE_RT {
  const Real* g = s.root_tangent;
  Real force_N[kMaxRegions];
  for (std::int32_t r = 0; r < n; ++r) force_N[r] = second_order * s.force_N[r];  // bound: kMaxRegions
  end_lanes(n, force_N);
  for (std::int32_t j = 0; j < n; ++j) {  // bound: kMaxRegions^2 / 8 steps of four
    for (std::int32_t b = j / kRegionLanes * kRegionLanes; b < n; b += kRegionLanes)
      store(system.column[j] + b, splat4(g[j]) * pair.bends(force_N, j, b) * load4(g + b));
    system.column[j][j] = 1.0 + g[j] * own_bend(j, second_order) * g[j];
  }
  if (!system.factor(n)) return false;
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions
    if (second_order > 0 && !(system.inverse[r] * system.inverse[r] * kLeastPivot < 1)) return false;
  }
  return true;
}

bool ElasticLoad::newton_step(RegionSystem& s) const PALPATE_RT {
  if (n == 2) return newton_step_of_two(s);
  FactorLanes system;
  const Real* g = s.root_tangent;
  Real y[kMaxRegions], by_force[kMaxRegions], second[kMaxRegions];
  for (std::int32_t j = 0; j < n; ++j) y[j] = -g[j] * s.residual_m[j];  // bound: kMaxRegions
  end_lanes(n, y);
  Real order = 1.0;
  if (!factor(s, order, system)) {
    order = 0.0;
    if (!factor(s, order, system)) return false;
  }
  system.solve(n, y);
  for (std::int32_t b = 0, end = whole_lanes(n, kRegionLanes); b != end; b += kRegionLanes) {  // bound: kMaxRegions / 4
    const Double4 more_N = load4(y + b) * load4(g + b);
    store(y + b, more_N);
    store(by_force + b, splat4(order) * more_N * load4(s.force_N + b));
  }
  pair.apply(n, y, by_force, s.step_m, second);
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions
    s.step_m[r] += s.residual_m[r] + order * s.force_N[r] * second[r] + own_bend(r, order) * y[r];
    change_N[r] = y[r];
    s.step_m[r] = bent_step_m(r, s);
  }
  return true;
}

Real ElasticLoad::bent_step_m(std::int32_t r, const RegionSystem& s) const PALPATE_RT {
  const Real dent = dent_m(r, s.shift_m[r]), step_m = s.step_m[r], bend = own_bend_m_per_N[r];
  const Real force = s.force_N[r], k = s.root_tangent[r] * s.root_tangent[r], gives = bend * k;
  if (!(force > 0)) return law[r].is_line && step_m < dent ? dent - left_of_m(r, dent - step_m, bend) : step_m;
  if (!(dent > 0 && gives > 0)) return step_m;
  // With p the power and x = -step / dent, (1 + p x)^(1 / p) - 1 is x / (1 + (p - 1) / 2 (sqrt(1 + 2 x) - 1)) to second
  // order, and for p = 1 and 2.
  const Real over = clamp_to(k * dent / force - 1.0, 0.0, 2.0);
  const Real longer = square_root(1.0 + 2.0 * max_of(-step_m / dent, -0.45)) - 1.0;
  return step_m / (1.0 + 0.5 * over * gives / (1.0 + gives) * longer);
}

bool ElasticLoad::foresees(RegionSystem& s, Real most) const PALPATE_RT {
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions
    const Real dent = dent_m(r, s.shift_m[r]), step_m = s.step_m[r];
    const bool stays_apart = !(dent > 0 || step_m < dent);
    if (!(stays_apart || abs_of(step_m) <= most * dent)) return false;
  }
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions
    s.force_N[r] = max_of(s.force_N[r] + change_N[r], 0.0);
    s.shift_m[r] += s.step_m[r];
  }
  return true;
}

RegionSolution ElasticLoad::solve_once(RegionSystem& system, Real enough_m, bool roughly) PALPATE_RT {
  const RegionSolution result = solve_regions(*this, n, system, enough_m, roughly);
  evaluations_left -= result.evaluations;
  return result;
}

RegionSolution ElasticLoad::solve(RegionSystem& system, Real enough_m, bool roughly,
                                  RegionSolution& given_up) PALPATE_RT {
  const RegionSolution result = solve_once(system, enough_m, roughly);
  if (result.residual_m <= kNoAnswer_m || evaluations_left < 1 || !pair.has_second_order(n)) return result;
  given_up = result;
  pair.drop_second_order(n);
  return solve_once(system, enough_m, roughly);
}

void ElasticLoad::finish(RegionSystem& system, RegionSolution& result) PALPATE_RT {
  evaluations_left += result.evaluations;  // to the whole of it
  if (result.foreseen) {
    result.foreseen = false;
    result.residual_m = evaluate(system.shift_m, system);
    result.evaluations += 1;
  }
  refine_regions(*this, n, system, kEnough_m, result);
  evaluations_left -= result.evaluations;
}

}  // namespace palpate
