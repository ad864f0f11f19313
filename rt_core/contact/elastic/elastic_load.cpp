// The region solver's steps for all tips of an elastic body at once.
#include "rt_core/contact/elastic/elastic_load.h"

namespace palpate {

void ElasticLoad::start(Real* shift_m) const PALPATE_RT {
  Real bend[kMaxRegions], force_N[kMaxRegions];
  for (std::int32_t r = 0; r < n; ++r) force_N[r] = before_N[r];  // bound: kMaxRegions
  end_lanes(n, force_N);
  pair.slopes(n, force_N, shift_m, bend);
  for (std::int32_t r = 0; r < n; ++r) shift_m[r] = keeps_dent(r, shift_m[r] + far_shift_m(region[r].far, force_N[r]));
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

bool ElasticLoad::newton_step(RegionSystem& s) const PALPATE_RT {
  FactorLanes system;
  const Real* g = s.root_tangent;
  Real y[kMaxRegions], by_force[kMaxRegions], second[kMaxRegions];
  for (std::int32_t j = 0; j < n; ++j) {  // bound: kMaxRegions^2 / 8 steps of four
    for (std::int32_t b = j / kRegionLanes * kRegionLanes; b < n; b += kRegionLanes)
      store(system.column[j] + b, splat4(g[j]) * pair.bends(s.force_N, j, b) * load4(g + b));
    system.column[j][j] = 1.0 + g[j] * own_bend_m_per_N[j] * g[j];
    y[j] = -g[j] * s.residual_m[j];
  }
  end_lanes(n, y);
  if (!system.factor(n)) return false;
  system.solve(n, y);
  for (std::int32_t b = 0; b < n; b += kRegionLanes) {  // bound: kMaxRegions / 4
    store(y + b, load4(y + b) * load4(g + b));
    store(by_force + b, load4(y + b) * load4(s.force_N + b));
  }
  pair.apply(n, y, by_force, s.step_m, second);
  for (std::int32_t r = 0; r < n; ++r)  // bound: kMaxRegions
    s.step_m[r] += s.residual_m[r] + s.force_N[r] * second[r] + own_bend_m_per_N[r] * y[r];
  return true;
}

}  // namespace palpate
