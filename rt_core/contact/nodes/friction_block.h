// Coulomb friction of a single contact, solved exactly in its own frame: the building block of the Gauss-Seidel sweeps
// (Jourdan, Alart & Jean 1998; Duriez et al. 2006).
#pragma once

#include "rt_core/lanes.h"
#include "rt_core/vec.h"

namespace palpate {

// Compliance of one contact to its own push, normal component first. The two tangents are turned about the normal so
// that the tangential compliance at constant normal gap is diagonal: `cosine`, `sine` turn the given frame into it.
// Number: Real, or Double4 for four contacts at once.
template <class Number>
struct FrictionBlockOf {
  Number normal{};                         // W_nn
  Number lean[2] = {};                     // W_nt
  Number slide[2] = {};                    // diagonal of W_tt - W_tn W_nt / W_nn, positive
  Number per_normal{}, per_slide[2] = {};  // 1 / normal, 1 / slide
  Number cosine{}, sine{};
};
using FrictionBlock = FrictionBlockOf<Real>;

// From a symmetric positive definite 3 x 3 compliance (normal, first tangent, second tangent). Where the normal gap
// depends so much on the tangential push that the answer is not unique, mu |W_nt| >= W_nn (a configuration as in
// Painleve's paradox), the coupling is left out.
template <class Number>
inline FrictionBlockOf<Number> make_friction_block(const Number (&w)[3][3], Real mu) PALPATE_RT {
  FrictionBlockOf<Number> block;
  const Number zero{}, one = zero + 1;
  block.normal = w[0][0];
  block.per_normal = 1 / w[0][0];
  const Number lean0 = w[0][1], lean1 = w[0][2];
  const auto unique = mu * mu * (lean0 * lean0 + lean1 * lean1) < block.normal * block.normal;
  const Number b0 = unique ? lean0 : zero, b1 = unique ? lean1 : zero;
  const Number a = w[1][1] - b0 * b0 * block.per_normal, d = w[2][2] - b1 * b1 * block.per_normal;
  const Number off = w[1][2] - b0 * b1 * block.per_normal;
  // Jacobi's rotation: the smaller angle that makes the 2 x 2 block diagonal.
  const auto turns = abs_of(off) > 1e-12 * (abs_of(a) + abs_of(d));
  const Number theta = 0.5 * (d - a) / (turns ? off : one);
  const Number root = square_root(theta * theta + 1);
  const Number angle = theta >= 0 ? -1 / (theta + root) : 1 / (root - theta);
  const Number tangent = turns ? angle : zero;
  block.cosine = 1 / square_root(1 + tangent * tangent);
  block.sine = tangent * block.cosine;
  block.slide[0] = a + tangent * off;
  block.slide[1] = d - tangent * off;
  block.lean[0] = block.cosine * b0 + block.sine * b1;
  block.lean[1] = -block.sine * b0 + block.cosine * b1;
  for (int k = 0; k < 2; ++k) block.per_slide[k] = 1 / block.slide[k];
  return block;
}

struct Push {
  Real normal_N = 0;       // >= 0
  Real tangent_N[2] = {};  // |tangent| <= mu normal
  bool slips = false;
};
// Displacement of the contact by its own push.
inline void own_displacement(const FrictionBlock& block, const Push& push, Real (&u)[3]) PALPATE_RT {
  const Real leaning = block.lean[0] * push.tangent_N[0] + block.lean[1] * push.tangent_N[1];
  u[0] = block.normal * push.normal_N + leaning;
  const Real along = push.normal_N + leaning * block.per_normal;
  u[1] = block.lean[0] * along + block.slide[0] * push.tangent_N[0];
  u[2] = block.lean[1] * along + block.slide[1] * push.tangent_N[1];
}
// Along a friction direction (any length): the push that closes the gap with |tangent| = mu normal.
inline Push slip_along(const FrictionBlock& block, Real mu, Real free_normal_m, Real t0, Real t1) PALPATE_RT {
  const Real size = square_root(t0 * t0 + t1 * t1), per_size = size > 0 ? 1.0 / size : 0;
  const Real e0 = t0 * per_size, e1 = t1 * per_size;
  Push push;
  push.normal_N = -free_normal_m / (block.normal + mu * (block.lean[0] * e0 + block.lean[1] * e1));
  push.tangent_N[0] = mu * push.normal_N * e0;
  push.tangent_N[1] = mu * push.normal_N * e1;
  push.slips = true;
  return push;
}
// The push under which the contact, displaced by `free_m` (normal gap, tangents) without it, is open, sticks (no
// tangential displacement) or slips against its displacement with |tangent| = mu normal. Bound: 8 Newton steps.
Push solve_friction(const FrictionBlock& block, Real mu, const Real (&free_m)[3]) PALPATE_RT;

// The same for a contact displaced by `now_m` under the push `now`. Where that slips already and still does, only its
// direction is improved, by one step: Rayleigh's quotient of the last friction gives the s of (slide + s) t = -c, and
// ends at the answer. For sweeps, which come back: a third of the instructions.
inline Push improve_friction(const FrictionBlock& block, Real mu, const Push& now, const Real (&now_m)[3]) PALPATE_RT {
  Real own[3];
  own_displacement(block, now, own);
  const Real v[3] = {now_m[0] - own[0], now_m[1] - own[1], now_m[2] - own[2]};
  if (!(v[0] < 0)) return {};
  const Real frictionless_N = -v[0] * block.per_normal;
  const Real c0 = v[1] + block.lean[0] * frictionless_N, c1 = v[2] + block.lean[1] * frictionless_N;
  if (!now.slips) {
    Push stick;
    stick.tangent_N[0] = -c0 * block.per_slide[0];
    stick.tangent_N[1] = -c1 * block.per_slide[1];
    stick.normal_N =
        frictionless_N - (block.lean[0] * stick.tangent_N[0] + block.lean[1] * stick.tangent_N[1]) * block.per_normal;
    const Real limit = mu * stick.normal_N;
    const Real size2 = stick.tangent_N[0] * stick.tangent_N[0] + stick.tangent_N[1] * stick.tangent_N[1];
    if (stick.normal_N >= 0 && size2 <= limit * limit) return stick;
  }
  const Real t0 = now.tangent_N[0], t1 = now.tangent_N[1], size2 = t0 * t0 + t1 * t1;
  if (!now.slips || !(size2 > 0)) return solve_friction(block, mu, v);
  const Real s = -((c0 + block.slide[0] * t0) * t0 + (c1 + block.slide[1] * t1) * t1) / size2;
  if (!(s > 0)) return solve_friction(block, mu, v);  // sticks, or turns round
  return slip_along(block, mu, v[0], -c0 * (block.slide[1] + s), -c1 * (block.slide[0] + s));
}

}  // namespace palpate
