// Signed distance of a point from a convex tool piece, by closed forms.
#pragma once

#include <span>

#include "rt_core/model.h"

namespace palpate {

struct PieceGap {
  Real gap_m = kHuge;  // < 0 inside the piece
  Vec3 normal;         // unit, out of the piece: the direction in which the gap grows
};

// Gap of `point` (piece frame) from the outer surface of the piece: core and margin. Exact inside and outside; where
// two features are equally near (on an axis, on a bisector) one of them, always the same. Hulls have no
// closed form: they give kHuge, and the scene compiler refuses them for this back-end. Bound: constant.
PieceGap piece_gap(const ToolPiece& piece, Vec3 point) PALPATE_RT;

// Places a piece in the world: columns of its rotation, and its origin.
struct PieceFrame {
  Vec3 x, y, z, origin;
  explicit PieceFrame(const Pose& pose) PALPATE_RT : x(rotate(pose.orientation, {1, 0, 0})),
                                                     y(rotate(pose.orientation, {0, 1, 0})),
                                                     z(rotate(pose.orientation, {0, 0, 1})),
                                                     origin(pose.position_m) {}
  Vec3 into(Vec3 point_w) const PALPATE_RT {
    const Vec3 d = point_w - origin;
    return {dot(x, d), dot(y, d), dot(z, d)};
  }
  Vec3 direction_out(Vec3 d) const PALPATE_RT { return d.x * x + d.y * y + d.z * z; }
};

}  // namespace palpate
