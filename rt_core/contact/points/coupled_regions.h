// Contact regions that lean on the same body: each one's force moves the surface under the others.
#pragma once

#include <span>

#include "rt_core/contact/points/region_load.h"
#include "rt_core/limits.h"

namespace palpate {

// Memory of one solve, lent by the caller. Row-major n x n and length n, n = number of regions; contents on entry
// matter only for `compliance`.
struct CoupledWork {
  Real* compliance;  // in: C, m/N, symmetric positive semi-definite
  Real* factor;
  Real* shift;  // out: delta_r, m: how far the surface under region r is moved inward
  Real* force;  // out: sum of point forces F_r at that shift, N
  Real* root_tangent;
  Real* residual;
  Real* step;
};

struct CoupledResult {
  Real residual_m = 0;    // largest |delta_r - sum_j C_rj F_j(delta_j)|
  bool singular = false;  // a linear system could not be factorised; the last good shift is kept
};

// Above this the solve counts as not converged: 0.1 um, a few mN on the stiffest objects a haptic device can render.
inline constexpr Real kCoupledTolerance_m = 1e-7;
// Below this another Newton step would change nothing but rounding: 1e-11 of a millimetre's depth. Fifteen fingers on
// rubber need two or three steps (2026-11-21).
inline constexpr Real kCoupledEnough_m = 1e-14;

// Solves delta_r = sum_j C_rj F_j(delta_j) with F_r(delta) = sum_i w_i f(D_i - delta), by at most
// kCoupledNewtonIterations Newton steps, each in symmetric form: with r = C F - delta and g = sqrt(-F'),
// (I + g C g) y = -g r by Cholesky, delta += r + C g y. The forces derive from the potential
// sum w_i U(D_i - delta_r) + F.C F / 2, so with C held fixed no closed path returns energy. The caller holds C fixed
// for as long as two regions last together (see set_lean in compute_force.cpp). Measured (2026-11-21, 2000 random
// 15-region problems, C_ii to 1.5e-4 m/N): see tests/force/test_coupled_regions.cpp. Bound: regions^3/6 multiply-adds
// and all points, per iteration.
CoupledResult solve_coupled_regions(const CubicLaw& law, std::span<const RegionContacts> regions,
                                    const CoupledWork& work) PALPATE_RT;

}  // namespace palpate
