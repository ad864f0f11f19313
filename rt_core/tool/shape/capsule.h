// Capsule: a segment along z and its rounding.
#pragma once

#include "rt_core/tool/shape/gap_forms.h"

namespace palpate {

struct CapsuleShape {
  static Vec3 support(const ToolPiece& piece, std::span<const Vec3>, Vec3 direction) PALPATE_RT {
    return {0, 0, piece_gap_forms::with_sign(piece.half_extent_m[2], direction.z)};
  }

  template <class Vector>
  [[gnu::always_inline]] static PieceGapOf<Vector> gap(const ToolPiece& piece, std::span<const HullFace>,
                                                       const Vector& p) PALPATE_RT {
    using namespace piece_gap_forms;
    const Real half = piece.half_extent_m[2];
    const auto one = one_like(p.x);
    return outside(Vector{p.x, p.y, p.z - smaller(larger(p.z, -half * one), half * one)}, piece.margin_m);
  }
};

}  // namespace palpate
