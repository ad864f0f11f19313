// Support mappings: the farthest point of a convex set along a direction.
#pragma once

#include <span>

#include "rt_core/model.h"

namespace palpate {

// Farthest point of the piece's core (without its margin) along `direction`, both in the piece frame. The direction
// need not be a unit vector; zero or not finite gives some point of the core. `hull` holds the piece's hull vertices
// (kHull only; must not be empty then). A cone has its base (radius half_extent_m[0]) at z = -half_extent_m[2] and its
// tip at +half_extent_m[2]. Bound: hull.size().
Vec3 core_support(const ToolPiece& piece, std::span<const Vec3> hull, Vec3 direction) PALPATE_RT;

// The hull vertices of one piece; empty unless it is a kHull.
std::span<const Vec3> hull_of(const Model& model, const ToolPiece& piece) PALPATE_RT;

}  // namespace palpate
