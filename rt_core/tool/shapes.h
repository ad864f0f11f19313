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
