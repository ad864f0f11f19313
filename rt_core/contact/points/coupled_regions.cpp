#include "rt_core/contact/points/coupled_regions.h"

#include "rt_core/cholesky.h"

namespace palpate {

namespace {

using Regions = std::span<const RegionContacts>;

Real row_times(const Real* row, const Real* vector, std::int32_t n) PALPATE_RT {
  Real sum = 0;
  for (std::int32_t j = 0; j < n; ++j) sum += row[j] * vector[j];  // bound: regions
  return sum;
}

// Start: each region alone, its law replaced by the tangent at its force-weighted mean depth (the only depth, for one
// point). Overshoots a little for a hardening law, which Newton's first step mends.
void start_alone(const CubicLaw& law, Regions regions, const CoupledWork& work) PALPATE_RT {
  const std::int32_t n = static_cast<std::int32_t>(regions.size());
  for (std::int32_t r = 0; r < n; ++r) {  // bound: regions
    Real force = 0, moment = 0, tangent = 0;
    const RegionContacts& contacts = regions[static_cast<std::size_t>(r)];
    for (std::int32_t k = 0; k < contacts.count; ++k) {  // bound: points
      const Contact& contact = contacts[k];
      const LawPoint point = law_at(law, contact.depth_m);
      force += contact.weight * point.force_N;
      moment += contact.weight * point.force_N * contact.depth_m;
      tangent += contact.weight * point.tangent_N_per_m;
    }
    const Real softening = work.compliance[r * n + r] * tangent;
    work.shift[r] = force > 0 ? moment / force * (softening / (1.0 + softening)) : 0.0;
  }
}

// Forces, root tangents and residuals r = C F - delta at the present shifts. Returns the largest |r|.
Real evaluate(const CubicLaw& law, Regions regions, const CoupledWork& work) PALPATE_RT {
  const std::int32_t n = static_cast<std::int32_t>(regions.size());
  for (std::int32_t r = 0; r < n; ++r) {  // bound: regions
    const LawPoint load = scalar_load(law, regions[static_cast<std::size_t>(r)], work.shift[r]);
    work.force[r] = load.force_N;
    work.root_tangent[r] = square_root(load.tangent_N_per_m);
  }
  Real largest = 0;
  for (std::int32_t r = 0; r < n; ++r) {  // bound: regions
    work.residual[r] = row_times(work.compliance + r * n, work.force, n) - work.shift[r];
    largest = max_of(abs_of(work.residual[r]), largest);
  }
  return largest;
}

// One Newton step; false when the system is not positive definite (C is not what it should be).
bool newton_step(const CoupledWork& work, std::int32_t n) PALPATE_RT {
  const Real* g = work.root_tangent;
  for (std::int32_t i = 0; i < n; ++i) {  // bound: regions^2
    for (std::int32_t j = 0; j <= i; ++j) {
      work.factor[i * n + j] = g[i] * work.compliance[i * n + j] * g[j] + (i == j ? 1.0 : 0.0);
    }
    work.step[i] = -g[i] * work.residual[i];
  }
  if (!cholesky_factor(work.factor, n)) return false;
  cholesky_solve(work.factor, work.step, n);
  for (std::int32_t i = 0; i < n; ++i) work.step[i] *= g[i];  // bound: regions
  for (std::int32_t i = 0; i < n; ++i) {                      // bound: regions^2
    work.shift[i] += work.residual[i] + row_times(work.compliance + i * n, work.step, n);
  }
  return true;
}

}  // namespace

CoupledResult solve_coupled_regions(const CubicLaw& law, std::span<const RegionContacts> regions,
                                    const CoupledWork& work) PALPATE_RT {
  const std::int32_t n = static_cast<std::int32_t>(regions.size());
  CoupledResult result;
  start_alone(law, regions, work);
  result.residual_m = evaluate(law, regions, work);
  for (std::int32_t k = 0; k < kCoupledNewtonIterations; ++k) {  // bound: kCoupledNewtonIterations
    if (result.residual_m <= kCoupledEnough_m) break;
    if (!newton_step(work, n)) {
      result.singular = true;
      return result;
    }
    result.residual_m = evaluate(law, regions, work);
  }
  return result;
}

}  // namespace palpate
