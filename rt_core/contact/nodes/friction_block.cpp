#include "rt_core/contact/nodes/friction_block.h"

#include "rt_core/vec.h"

namespace palpate {

namespace {

constexpr int kSlipSteps = 8;

Push with_tangent(const FrictionBlock& block, Real free_normal_m, Real t0, Real t1) PALPATE_RT {
  Push push;
  push.normal_N = -(free_normal_m + block.lean[0] * t0 + block.lean[1] * t1) * block.per_normal;
  push.tangent_N[0] = t0;
  push.tangent_N[1] = t1;
  return push;
}

// Slipping: tangent(s)_k = -c_k / (slide_k + s) with the s > 0 at which its length is mu times the normal push. Newton
// on the inverse of their ratio, which is nearly linear in s (Hebden 1973; More & Sorensen 1983), inside a bracket.
Push slip(const FrictionBlock& block, Real mu, Real free_normal_m, const Real (&c)[2]) PALPATE_RT {
  Real s = 0, low = 0, high = kHuge, t0 = 0, t1 = 0;
  for (int step = 0; step < kSlipSteps; ++step) {  // bound: kSlipSteps
    const Real d0 = 1.0 / (block.slide[0] + s), d1 = 1.0 / (block.slide[1] + s);
    t0 = -c[0] * d0;
    t1 = -c[1] * d1;
    const Real normal_N = -(free_normal_m + block.lean[0] * t0 + block.lean[1] * t1) * block.per_normal;
    const Real size2 = t0 * t0 + t1 * t1, size = square_root(size2), limit = mu * normal_N;
    if (abs_of(size - limit) <= 1e-12 * size) break;
    (size > limit ? low : high) = s;
    Real next = -1;
    if (limit > 0 && size > 0) {
      const Real size_slope = -(t0 * t0 * d0 + t1 * t1 * d1) / size2;
      const Real normal_slope = (block.lean[0] * t0 * d0 + block.lean[1] * t1 * d1) * block.per_normal / normal_N;
      const Real slope = size_slope - normal_slope;
      if (slope < 0) next = s - (size / limit - 1) / slope;
    }
    const Real middle = high < kHuge ? 0.5 * (low + high) : 4 * s + block.slide[0] + block.slide[1];
    s = next > low && next < high ? next : middle;
  }
  return slip_along(block, mu, free_normal_m, t0, t1);
}

}  // namespace

Push solve_friction(const FrictionBlock& block, Real mu, const Real (&v)[3]) PALPATE_RT {
  if (!(v[0] < 0)) return {};
  if (!(mu > 0)) return with_tangent(block, v[0], 0, 0);
  const Real frictionless_N = -v[0] * block.per_normal;
  const Real c[2] = {v[1] + block.lean[0] * frictionless_N, v[2] + block.lean[1] * frictionless_N};
  const Push stick = with_tangent(block, v[0], -c[0] * block.per_slide[0], -c[1] * block.per_slide[1]);
  const Real limit = mu * stick.normal_N;
  const Real size2 = stick.tangent_N[0] * stick.tangent_N[0] + stick.tangent_N[1] * stick.tangent_N[1];
  if (stick.normal_N >= 0 && size2 <= limit * limit) return stick;
  return slip(block, mu, v[0], c);
}

}  // namespace palpate
