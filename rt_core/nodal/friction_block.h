// Coulomb friction of a single contact, solved exactly in its own frame: the building block of the Gauss-Seidel sweeps
// (Jourdan, Alart & Jean 1998; Duriez et al. 2006).
#pragma once

#include "rt_core/base.h"

namespace palpate {

// Compliance of one contact to its own push, normal component first. The two tangents are turned about the normal so
// that the tangential compliance at constant normal gap is diagonal: `cosine`, `sine` turn the given frame into it.
struct FrictionBlock {
  Real normal = 0;     // W_nn
  Real lean[2] = {};   // W_nt
  Real slide[2] = {};  // diagonal of W_tt - W_tn W_nt / W_nn, positive
  Real per_normal = 0, per_slide[2] = {};  // 1 / normal, 1 / slide
  Real cosine = 1, sine = 0;
};
// From a symmetric positive definite 3 x 3 compliance (normal, first tangent, second tangent). Where the normal gap
// depends so much on the tangential push that the answer is not unique, mu |W_nt| >= W_nn (a configuration as in
// Painleve's paradox), the coupling is left out.
FrictionBlock make_friction_block(const Real (&compliance)[3][3], Real mu) PALPATE_RT;

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
// The push under which the contact, displaced by `free_m` (normal gap, tangents) without it, is open, sticks (no
// tangential displacement) or slips against its displacement with |tangent| = mu normal. Bound: 8 Newton steps.
Push solve_friction(const FrictionBlock& block, Real mu, const Real (&free_m)[3]) PALPATE_RT;
// The same for a contact displaced by `now_m` under the push `now`; where that slips already, its friction's direction
// improved by one step of an iteration that ends at solve_friction()'s. For sweeps, which come back.
Push improve_friction(const FrictionBlock& block, Real mu, const Push& now, const Real (&now_m)[3]) PALPATE_RT;

}  // namespace palpate
