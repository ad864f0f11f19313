// Newton's method for the contact problem of regions that lean on one body: the compliance between regions (a small
// Delassus operator) in series with local laws. One solver; the laws are a functor.
#pragma once

#include "rt_core/cholesky.h"
#include "rt_core/contact/cubic_law.h"
#include "rt_core/contact/problem.h"

namespace palpate {

// Boussinesq's half-space: a normal force F moves the surface at distance r by (1 - nu^2) F / (pi E r). The core radius
// a takes the point load's singularity away, r -> sqrt(r^2 + a^2), and the cosine of the two normals makes opposed
// sides push apart. As a kernel over (position, normal) this is the product of an inverse multiquadric and a Gram
// matrix, both positive semi-definite, hence so is it (Schur): the coupled solve always has exactly one answer. Metres
// of inward motion at i per newton at j. E, a > 0, |nu| < 1.
inline Real far_field_scale_m2_per_N(Real youngs_modulus_Pa, Real poisson_ratio) PALPATE_RT {
  return (1.0 - poisson_ratio * poisson_ratio) / (kPi * youngs_modulus_Pa);
}
inline Real far_field_compliance_m_per_N(Real scale_m2_per_N, Real core_radius_m, Vec3 position_i, Vec3 normal_i,
                                         Vec3 position_j, Vec3 normal_j) PALPATE_RT {
  const Real square = squared_norm(position_i - position_j) + core_radius_m * core_radius_m;
  return square > 0 ? scale_m2_per_N * dot(normal_i, normal_j) / square_root(square) : 0.0;
}

struct RegionSolution {
  Real residual_m = 0;    // largest |shift_r - dW/dF_r|
  bool singular = false;  // a linear system could not be factorised; the last good shift is kept
  std::int32_t steps = 0, evaluations = 0;
  bool foreseen = false;  // the forces are those that the laws' tangents tell after the last step
};

// Laws: the local laws of n regions and the potential W(F) of what couples them.
//   static constexpr: kIterations; kEnough_m, below which another step would change nothing but rounding; kTolerance_m,
//                     above which a solve counts as not converged; kEnoughStepped_m, if any: enough after a step;
//   evaluations_left             if any: of all laws, after which a solve ends where it is
//   start(r)                     a first shift for region r
//   load(r, shift)               LawPoint: F_r and -dF_r/dshift of its rows, all depths reduced by the shift
//   shift_under(force, r)        dW/dF_r
//   curvature(force, i, j)       d2W/dF_i dF_j
// or, of many regions at once, instead of all but the constants: start(), evaluate() and newton_step() themselves.
//   foresees(system, most)       if any: takes a step if it is so short, `most` of the depths, that the tangents of the
//                                laws tell the forces after it; kForeseen, kKnown: such shares; kOffTangents: what of
//                                the residual is left after it; kKnown_m: enough of that
namespace region_solve {

template <class Laws>
concept HasSteps = requires(const Laws& laws, RegionSystem& s) {
  laws.newton_step(s);
};

template <class Laws>
inline constexpr Real kEnoughStepped_m = [] {
  if constexpr (requires { Laws::kEnoughStepped_m; })
    return Laws::kEnoughStepped_m;
  else
    return Laws::kEnough_m;
}();

template <class Laws>
inline constexpr std::int32_t kMostEvaluations = 1 + (kStepHalvings + 1) * Laws::kIterations;

template <class Laws>
std::int32_t most_evaluations(const Laws& laws) PALPATE_RT {
  if constexpr (requires { laws.evaluations_left; })
    return laws.evaluations_left;
  else
    return kMostEvaluations<Laws>;
}

template <class Laws>
void start(const Laws& laws, std::int32_t n, RegionSystem& s) PALPATE_RT {
  if constexpr (HasSteps<Laws>)
    laws.start(s.shift_m);
  else
    for (std::int32_t r = 0; r < n; ++r) s.shift_m[r] = laws.start(r);  // bound: regions
}

// Forces, root tangents and residuals dW/dF - shift at `shift`. Returns the largest.
template <class Laws>
Real evaluate(const Laws& laws, std::int32_t n, const Real* shift, RegionSystem& s) PALPATE_RT
    requires(!HasSteps<Laws>) {
  for (std::int32_t r = 0; r < n; ++r) {  // bound: regions
    const LawPoint load = laws.load(r, shift[r]);
    s.force_N[r] = load.force_N;
    s.root_tangent[r] = square_root(load.tangent_N_per_m);
  }
  Real largest = 0;
  for (std::int32_t r = 0; r < n; ++r) {  // bound: regions^2
    s.residual_m[r] = laws.shift_under(s.force_N, r) - shift[r];
    largest = max_of(abs_of(s.residual_m[r]), largest);
  }
  return largest;
}

// Newton step, from (I + g H g) y = -g r, step = r + H g y; false when that is not positive definite.
template <class Laws>
bool newton_step(const Laws& laws, std::int32_t n, RegionSystem& s) PALPATE_RT requires(!HasSteps<Laws>) {
  const Real* g = s.root_tangent;
  Real* y = s.trial_m;
  Real h[kMaxRegions * kMaxRegions];      // both uses ask for it once
  for (std::int32_t i = 0; i < n; ++i) {  // bound: regions^2
    for (std::int32_t j = 0; j < n; ++j) h[i * n + j] = laws.curvature(s.force_N, i, j);
    for (std::int32_t j = 0; j <= i; ++j) s.factor[i * n + j] = g[i] * h[i * n + j] * g[j] + (i == j ? 1.0 : 0.0);
    y[i] = -g[i] * s.residual_m[i];
  }
  if (!cholesky_factor(s.factor, n)) return false;
  cholesky_solve(s.factor, y, n);
  for (std::int32_t i = 0; i < n; ++i) y[i] *= g[i];  // bound: regions
  for (std::int32_t i = 0; i < n; ++i) {              // bound: regions^2
    Real sum = 0;
    for (std::int32_t j = 0; j < n; ++j) sum += h[i * n + j] * y[j];
    s.step_m[i] = s.residual_m[i] + sum;
  }
  return true;
}

template <class Laws>
Real evaluate(const Laws& laws, std::int32_t, const Real* shift, RegionSystem& s) PALPATE_RT requires HasSteps<Laws> {
  return laws.evaluate(shift, s);
}
template <class Laws>
bool newton_step(const Laws& laws, std::int32_t, RegionSystem& s) PALPATE_RT requires HasSteps<Laws> {
  return laws.newton_step(s);
}

// Whether a step has been taken by the laws' tangents, after which nothing is to be looked at again.
template <class Laws>
bool foresees(const Laws& laws, RegionSystem& s, bool roughly, RegionSolution& result) PALPATE_RT {
  if constexpr (requires { laws.foresees(s, 0.0); }) {
    const Real left_m = Laws::kOffTangents * result.residual_m;
    if (!(roughly || left_m <= Laws::kKnown_m)) return false;
    if (!laws.foresees(s, roughly ? Laws::kForeseen : Laws::kKnown)) return false;
    result.residual_m = left_m;
    result.foreseen = true;
    return true;
  }
  return false;
}

}  // namespace region_solve

// Goes on with a solution until no more than enough_m is left, or after a step `stepped_m`, or a step is foreseen:
// `roughly`, a longer one. Bound: Laws::kIterations steps, most_evaluations() of all laws, of which one is made at
// least.
template <class Laws>
void refine_regions(const Laws& laws, std::int32_t n, RegionSystem& system, Real enough_m, RegionSolution& result,
                    bool roughly = false, Real stepped_m = region_solve::kEnoughStepped_m<Laws>) PALPATE_RT {
  const std::int32_t most = region_solve::most_evaluations(laws);
  for (std::int32_t k = 0; k < Laws::kIterations; ++k) {  // bound: Laws::kIterations
    if (result.residual_m <= (result.steps > 0 ? max_of(enough_m, stepped_m) : enough_m)) break;
    if (result.evaluations >= most) break;
    result.steps += 1;
    if (!region_solve::newton_step(laws, n, system)) {
      result.singular = true;
      break;
    }
    if (region_solve::foresees(laws, system, roughly, result)) break;
    const Real before = result.residual_m;
    Real share = 1.0;
    for (std::int32_t h = 0; h <= kStepHalvings; ++h) {  // bound: kStepHalvings
      for (std::int32_t r = 0; r < n; ++r) system.trial_m[r] = system.shift_m[r] + share * system.step_m[r];
      result.residual_m = region_solve::evaluate(laws, n, system.trial_m, system);
      result.evaluations += 1;
      if (result.residual_m < before || result.residual_m <= Laws::kTolerance_m || result.evaluations >= most) break;
      share *= 0.5;
    }
    for (std::int32_t r = 0; r < n; ++r) system.shift_m[r] = system.trial_m[r];  // bound: regions
  }
}

// Solves shift_r = dW/dF_r(F), F_r = F_r(shift_r) by Newton's method in symmetric form: with r = dW/dF - shift, H the
// Hessian of W and g = sqrt(-F'), (I + g H g) y = -g r by Cholesky, shift += r + H g y. A step that leaves more than
// kTolerance_m and more than before is halved. The forces are the gradient of one potential, so with W held fixed no
// closed path returns energy; the caller holds it for as long as two regions last together (see set_lean in
// region_load.h). Measured for cubic laws (2026-11-21, 2000 random 15-region problems, C_ii to 1.5e-4 m/N): see
// tests/force/test_coupled_regions.cpp. Leaves shift_m and force_N in `system`. Bound: Laws::kIterations steps of
// regions^3/6 multiply-adds and kStepHalvings + 1 evaluations.
template <class Laws>
RegionSolution solve_regions(const Laws& laws, std::int32_t n, RegionSystem& system, Real enough_m = Laws::kEnough_m,
                             bool roughly = false) PALPATE_RT {
  RegionSolution result;
  region_solve::start(laws, n, system);
  result.residual_m = region_solve::evaluate(laws, n, system.shift_m, system);
  result.evaluations = 1;
  refine_regions(laws, n, system, enough_m, result, roughly);
  return result;
}

}  // namespace palpate
