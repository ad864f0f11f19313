// Weights of the anchors at a point of the surface: interpolation by radial basis functions (phi(r) = r, Cui & Xiao
// 2008), whose system the baker inverted.
#pragma once

#include <cstdint>

#include "rt_core/limits.h"
#include "rt_core/model.h"

namespace palpate {

inline constexpr std::int32_t kMaxRbf = kMaxAnchors + 4;

// Polynomial terms beside the radial functions: 1 (constant tail, tail = 0) or 4 (linear tail, tail = 1).
inline constexpr std::int32_t rbf_tail_size(RbfTail tail) PALPATE_RT { return tail == RbfTail::kLinear ? 4 : 1; }

// g(x) = [|x - x_i| ; 1 ; (x)], up to kMaxRbf values.
using RbfVector = Real[kMaxRbf];

// True when the image holds an interpolation that fits its anchors.
bool rbf_available(const Model& model) PALPATE_RT;
// Writes g(x), model.sizes.n_rbf values. Call only when rbf_available.
void rbf_terms(const Model& model, Vec3 x, RbfVector& g) PALPATE_RT;
// q = B g, B the inverse of the system. Bound: n_rbf^2.
void rbf_multiply(const Model& model, const RbfVector& g, RbfVector& q) PALPATE_RT;
// Weights W(x) of the anchors: the first n_anchor entries of B g(x). They sum to one; they may be negative.
void rbf_weights(const Model& model, Vec3 x, RbfVector& weight) PALPATE_RT;

}  // namespace palpate
