// The shapes of tool pieces: what each is to the tick, one header a shape (rt_core/tool/shape), joined by the table
// PALPATE_PIECE_SHAPES. What a shape is to a scene and its baker is its card in config/tool.
#pragma once

#include "rt_core/tool/shape/box.h"
#include "rt_core/tool/shape/capsule.h"
#include "rt_core/tool/shape/cone.h"
#include "rt_core/tool/shape/cylinder.h"
#include "rt_core/tool/shape/hull.h"
#include "rt_core/tool/shape/sphere.h"
#include "rt_core/tool/shape/torus.h"

namespace palpate {

// Farthest point of the piece's core (without its margin) along `direction`, both in the piece frame: the support
// mapping of a convex set. The direction need not be a unit vector; zero or not finite gives some point of the core.
// `hull` holds the piece's hull vertices (kHull only; must not be empty then). A cone has its base (radius
// half_extent_m[0]) at z = -half_extent_m[2] and its tip at +half_extent_m[2]. Bound: hull.size().
inline Vec3 core_support(const ToolPiece& piece, std::span<const Vec3> hull, Vec3 direction) PALPATE_RT {
  switch (piece.shape) {
#define PALPATE_SHAPE(name, word, Shape) \
  case PieceShape::name:                 \
    return Shape::support(piece, hull, direction);
    PALPATE_PIECE_SHAPES(PALPATE_SHAPE)
#undef PALPATE_SHAPE
  }
  return {};
}

// The hull vertices of one piece; empty unless it is a kHull.
inline std::span<const Vec3> hull_of(const Model& model, const ToolPiece& piece) PALPATE_RT {
  if (piece.shape != PieceShape::kHull || piece.hull_count <= 0) return {};
  return model.hull_vertex_m.subspan(static_cast<std::size_t>(piece.first_hull),
                                     static_cast<std::size_t>(piece.hull_count));
}

// Gap of `point` (piece frame) from the outer surface of the piece: core and margin. Exact inside and outside; where
// two features are equally near (on an axis, on a bisector) one of them, always the same. One point, or four at a time
// with the same bits. Shapes without a closed form (kHasGap) give kHuge. Bound: constant.
template <class Vector>
[[gnu::always_inline]] inline PieceGapOf<Vector> piece_gap(const ToolPiece& piece, const Vector& p) PALPATE_RT {
  switch (piece.shape) {
#define PALPATE_SHAPE(name, word, Shape) \
  case PieceShape::name:                 \
    return Shape::gap(piece, p);
    PALPATE_PIECE_SHAPES(PALPATE_SHAPE)
#undef PALPATE_SHAPE
  }
  return HullShape::gap(piece, p);
}

inline PieceGap piece_gap(const ToolPiece& piece, Vec3 p) PALPATE_RT { return piece_gap<Vec3>(piece, p); }

// Whether piece_gap is a distance for this shape.
constexpr bool has_gap(PieceShape shape) PALPATE_RT {
#define PALPATE_SHAPE(name, word, Shape) (shape == PieceShape::name && Shape::kHasGap) ||
  return PALPATE_PIECE_SHAPES(PALPATE_SHAPE) false;
#undef PALPATE_SHAPE
}

}  // namespace palpate
