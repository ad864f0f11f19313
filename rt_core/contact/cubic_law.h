// The contact law of one point: a hardening spring f(D) = k1 D + k3 D^3, the quasi-static part of Duffing's oscillator
// (Luo & Xiao 2006, equation 3). Per unit weight; see region_load.h for the weights.
#pragma once

#include "rt_core/base.h"
#include "rt_core/model.h"

namespace palpate {

// k1, k3 >= 0. Beyond max_depth_m the law continues by its tangent, so that a wild pose cannot ask for a cubic force.
struct CubicLaw {
  Real k1_N_per_m = 0;
  Real k3_N_per_m3 = 0;
  Real max_depth_m = kHuge;
};

inline CubicLaw contact_law(const ModelParams& params) PALPATE_RT {
  return {params.k1_N_per_m, params.k3_N_per_m3, params.max_depth_m};
}

struct LawPoint {
  Real force_N = 0;
  Real tangent_N_per_m = 0;
};

// Force and tangent at a depth D in metres. Zero for D <= 0 (no adhesion) and for NaN; D above kHuge counts as kHuge.
// The force has a kink of k1 at zero depth and is continuously differentiable elsewhere. In the header because the
// coupled solve spends its time here.
inline LawPoint law_at(const CubicLaw& law, Real depth_m) PALPATE_RT {
  if (!(depth_m > 0)) return {};
  const Real inside = min_of(depth_m, law.max_depth_m);
  const Real cubic = law.k3_N_per_m3 * inside * inside;
  const Real tangent = law.k1_N_per_m + 3.0 * cubic;
  const Real force = (law.k1_N_per_m + cubic) * inside;
  if (depth_m <= law.max_depth_m) return {force, tangent};
  return {force + tangent * (min_of(depth_m, kHuge) - inside), tangent};
}
inline Real law_force_N(const CubicLaw& law, Real depth_m) PALPATE_RT { return law_at(law, depth_m).force_N; }
inline Real law_tangent_N_per_m(const CubicLaw& law, Real depth_m) PALPATE_RT {
  return law_at(law, depth_m).tangent_N_per_m;
}
// Integral of the force from zero depth.
inline Real law_energy_J(const CubicLaw& law, Real depth_m) PALPATE_RT {
  if (!(depth_m > 0)) return 0.0;
  const Real inside = min_of(depth_m, law.max_depth_m);
  const Real square = inside * inside;
  const Real energy = (0.5 * law.k1_N_per_m + 0.25 * law.k3_N_per_m3 * square) * square;
  if (depth_m <= law.max_depth_m) return energy;
  const LawPoint edge = law_at(law, inside);
  const Real beyond = min_of(depth_m, kHuge) - inside;
  return energy + (edge.force_N + 0.5 * edge.tangent_N_per_m * beyond) * beyond;
}
// Depth at which the law gives force_N; the continuation included. Zero for a force that is not positive and for a law
// that is zero. Relative error below 1e-15.
Real law_depth_m(const CubicLaw& law, Real force_N) PALPATE_RT;

}  // namespace palpate
