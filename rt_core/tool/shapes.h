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

// The faces of one piece; empty unless it is a kHull with a volume.
inline std::span<const HullFace> faces_of(const Model& model, const ToolPiece& piece) PALPATE_RT {
  if (piece.shape != PieceShape::kHull || piece.face_count <= 0) return {};
  return model.hull_face.subspan(static_cast<std::size_t>(piece.first_face),
                                 static_cast<std::size_t>(piece.face_count));
}

// Gap of `point` (piece frame) from the outer surface of the piece: core and margin. Exact inside and outside; where
// two features are equally near (on an axis, on a bisector) one of them, always the same. One point, or four at a time
// with the same bits. `face` holds the piece's faces (kHull only; without them the gap is kHuge). Bound: face.size().
template <class Vector>
[[gnu::always_inline]] inline PieceGapOf<Vector> piece_gap(const ToolPiece& piece, const Vector& p,
                                                           std::span<const HullFace> face = {}) PALPATE_RT {
  switch (piece.shape) {
#define PALPATE_SHAPE(name, word, Shape) \
  case PieceShape::name:                 \
    return Shape::gap(piece, face, p);
    PALPATE_PIECE_SHAPES(PALPATE_SHAPE)
#undef PALPATE_SHAPE
  }
  return HullShape::gap(piece, face, p);
}

inline PieceGap piece_gap(const ToolPiece& piece, Vec3 p, std::span<const HullFace> face = {}) PALPATE_RT {
  return piece_gap<Vec3>(piece, p, face);
}

// No more than the gap, for a search that only asks whether it is small: of a hull the distance from its planes, of all
// others the gap itself.
template <class Vector>
[[gnu::always_inline]] inline auto least_gap(const ToolPiece& piece, const Vector& p,
                                             std::span<const HullFace> face) PALPATE_RT {
  if (piece.shape == PieceShape::kHull) return HullShape::least_gap(piece, face, p);
  return piece_gap(piece, p).gap_m;
}

}  // namespace palpate
