#include "rt_core/nodal/friction_block.h"

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

// Along the given friction direction: the push that closes the gap with |tangent| = mu normal.
Push along(const FrictionBlock& block, Real mu, Real free_normal_m, Real t0, Real t1) PALPATE_RT {
  const Real size = square_root(t0 * t0 + t1 * t1), per_size = size > 0 ? 1.0 / size : 0;
  const Real e0 = t0 * per_size, e1 = t1 * per_size;
  Push push;
  push.normal_N = -free_normal_m / (block.normal + mu * (block.lean[0] * e0 + block.lean[1] * e1));
  push.tangent_N[0] = mu * push.normal_N * e0;
  push.tangent_N[1] = mu * push.normal_N * e1;
  push.slips = true;
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
  return along(block, mu, free_normal_m, t0, t1);
}

// Rayleigh's quotient of the last friction t gives s: (slide + s) t = -c where t is the answer. Negative: no answer.
Real slip_like(const FrictionBlock& block, const Push& last, const Real (&c)[2]) PALPATE_RT {
  const Real t0 = last.tangent_N[0], t1 = last.tangent_N[1], size2 = t0 * t0 + t1 * t1;
  if (!last.slips || !(size2 > 0)) return -1;
  return -((c[0] + block.slide[0] * t0) * t0 + (c[1] + block.slide[1] * t1) * t1) / size2;
}

Push solve(const FrictionBlock& block, Real mu, const Real (&v)[3], const Push& last) PALPATE_RT {
  if (!(v[0] < 0)) return {};
  if (!(mu > 0)) return with_tangent(block, v[0], 0, 0);
  const Real frictionless_N = -v[0] * block.per_normal;
  const Real c[2] = {v[1] + block.lean[0] * frictionless_N, v[2] + block.lean[1] * frictionless_N};
  const Push stick = with_tangent(block, v[0], -c[0] * block.per_slide[0], -c[1] * block.per_slide[1]);
  const Real limit = mu * stick.normal_N;
  const Real size2 = stick.tangent_N[0] * stick.tangent_N[0] + stick.tangent_N[1] * stick.tangent_N[1];
  if (stick.normal_N >= 0 && size2 <= limit * limit) return stick;
  const Real s = slip_like(block, last, c);
  if (!(s > 0)) return slip(block, mu, v[0], c);
  const Real d0 = block.slide[0] + s, d1 = block.slide[1] + s;
  return along(block, mu, v[0], -c[0] * d1, -c[1] * d0);  // only the direction counts
}

}  // namespace

FrictionBlock make_friction_block(const Real (&w)[3][3], Real mu) PALPATE_RT {
  FrictionBlock block;
  block.normal = w[0][0];
  const Real lean0 = w[0][1], lean1 = w[0][2];
  const bool unique = mu * square_root(lean0 * lean0 + lean1 * lean1) < block.normal;
  const Real b0 = unique ? lean0 : 0, b1 = unique ? lean1 : 0;
  const Real a = w[1][1] - b0 * b0 / block.normal, d = w[2][2] - b1 * b1 / block.normal;
  const Real off = w[1][2] - b0 * b1 / block.normal;
  // Jacobi's rotation: the smaller angle that makes the 2 x 2 block diagonal.
  Real tangent = 0;
  if (abs_of(off) > 1e-12 * (abs_of(a) + abs_of(d))) {
    const Real theta = 0.5 * (d - a) / off;
    const Real root = square_root(theta * theta + 1);
    tangent = theta >= 0 ? -1.0 / (theta + root) : 1.0 / (root - theta);
  }
  block.cosine = 1.0 / square_root(1 + tangent * tangent);
  block.sine = tangent * block.cosine;
  block.slide[0] = a + tangent * off;
  block.slide[1] = d - tangent * off;
  block.lean[0] = block.cosine * b0 + block.sine * b1;
  block.lean[1] = -block.sine * b0 + block.cosine * b1;
  block.per_normal = 1.0 / block.normal;
  for (int k = 0; k < 2; ++k) block.per_slide[k] = 1.0 / block.slide[k];
  return block;
}

Push solve_friction(const FrictionBlock& block, Real mu, const Real (&free_m)[3]) PALPATE_RT {
  return solve(block, mu, free_m, {});
}

Push improve_friction(const FrictionBlock& block, Real mu, const Push& now, const Real (&now_m)[3]) PALPATE_RT {
  Real own[3];
  own_displacement(block, now, own);
  return solve(block, mu, {now_m[0] - own[0], now_m[1] - own[1], now_m[2] - own[2]}, now);
}

}  // namespace palpate
