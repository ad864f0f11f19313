// Surface interpolation of anchor displacements by radial basis functions (phi(r) = r, Cui & Xiao 2008), with a moving
// contact point as an extra node that costs no new factorisation.
#pragma once

#include <cstdint>

#include "rt_core/model.h"
#include "rt_core/skeleton/rbf_system.h"

namespace palpate {

// g(x) = [|x - x_i| ; 1 ; (x)], up to kMaxRbf values.
using RbfVector = Real[kMaxRbf];

// The contact point p as an extra node, by the bordered inverse: q = B g(p), s = -g(p)^T q.
struct RbfContact {
  Vec3 point_w;
  RbfVector q{};
  Real inverse_s = 0;           // 0 when p lies at an anchor (|s| < 1e-6 body sizes, |s| being twice the distance)
  std::int32_t at_anchor = -1;  // that anchor, or -1
};

// True when the image holds an interpolation that fits its anchors.
bool rbf_available(const Model& model) PALPATE_RT;
// Writes g(x), model.sizes.n_rbf values. Call only when rbf_available.
void rbf_terms(const Model& model, Vec3 x, RbfVector& g) PALPATE_RT;
// q = B g. Bound: n_rbf^2.
void rbf_multiply(const Model& model, const RbfVector& g, RbfVector& q) PALPATE_RT;
// Weights W(x) of the anchors: the first n_anchor entries of B g(x). They sum to one; they may be negative.
void rbf_weights(const Model& model, Vec3 x, RbfVector& weight) PALPATE_RT;
// Coefficients c = B [d; 0] of the interpolant d(x) = sum g_k(x) c_k. `displacement` has n_anchor entries.
void rbf_coefficients(const Model& model, const Vec3* displacement, Vec3 (&coefficient)[kMaxRbf]) PALPATE_RT;
// sum g_k c_k.
Vec3 rbf_value(const Model& model, const RbfVector& g, const Vec3 (&coefficient)[kMaxRbf]) PALPATE_RT;
// Adds p as a node.
void make_rbf_contact(const Model& model, Vec3 point_w, RbfContact& contact) PALPATE_RT;
// psi(x) = (|x - p| - g(x).q) / s: 1 at p, 0 at every anchor. Zero when p lies at an anchor.
Real rbf_contact_weight(const Model& model, const RbfContact& contact, const RbfVector& g, Vec3 x) PALPATE_RT;

}  // namespace palpate
