// The linear system of the surface interpolation, inverted once when a scene is baked.
#pragma once

#include <span>

#include "rt_core/skeleton/rbf.h"
#include "rt_core/vec.h"

namespace palpate {

// Inverts M = [Phi P; P^T 0], Phi_ij = |x_i - x_j| in metres, P = [1] or [1 x y z] (the biharmonic interpolant of
// Cui & Xiao 2008). Writes the n x n inverse, n = anchors.size() + rbf_tail_size(tail), row-major, symmetric, into
// `inverse`, which must hold at least n * n values: ModelSizes::n_rbf = n, Model::rbf_inverse = inverse.
// Returns false, leaving `inverse` unspecified, when there is no anchor or more than kMaxAnchors, when `inverse` is too
// small, when a coordinate is not finite, or when the system is singular: two anchors closer than about 1e-9 of their
// extent, or a linear tail whose anchors are (within about 1e-9 of their extent) coplanar. A constant tail then works.
bool invert_rbf_system(std::span<const Vec3> anchors, RbfTail tail, std::span<double> inverse) noexcept;

}  // namespace palpate
