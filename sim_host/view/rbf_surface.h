// The surface that interpolates anchor displacements by radial basis functions (Cui & Xiao 2008), with a moving contact
// point as an extra node that costs no new factorisation.
#pragma once

#include <cstdint>

#include "rt_core/skeleton/rbf.h"

namespace palpate {

// The contact point p as an extra node, by the bordered inverse: q = B g(p), s = -g(p)^T q.
struct RbfContact {
  Vec3 point_w;
  RbfVector q{};
  Real inverse_s = 0;           // 0 when p lies at an anchor (|s| < 1e-6 body sizes, |s| being twice the distance)
  std::int32_t at_anchor = -1;  // that anchor, or -1
};

// Coefficients c = B [d; 0] of the interpolant d(x) = sum g_k(x) c_k. `displacement` has n_anchor entries.
void rbf_coefficients(const Model& model, const Vec3* displacement, Vec3 (&coefficient)[kMaxRbf]);
// sum g_k c_k.
Vec3 rbf_value(const Model& model, const RbfVector& g, const Vec3 (&coefficient)[kMaxRbf]);
// Adds p as a node.
void make_rbf_contact(const Model& model, Vec3 point_w, RbfContact& contact);
// psi(x) = (|x - p| - g(x).q) / s: 1 at p, 0 at every anchor. Zero when p lies at an anchor.
Real rbf_contact_weight(const Model& model, const RbfContact& contact, const RbfVector& g, Vec3 x);

}  // namespace palpate
