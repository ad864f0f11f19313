// Sphere: a point and its rounding.
#pragma once

#include "rt_core/tool/shape/gap_forms.h"

namespace palpate {

struct SphereShape {
  static Vec3 support(const ToolPiece&, std::span<const Vec3>, Vec3) PALPATE_RT { return {}; }

  template <class Vector>
  [[gnu::always_inline]] static PieceGapOf<Vector> gap(const ToolPiece& piece, std::span<const HullFace>,
                                                       const Vector& p) PALPATE_RT {
    return piece_gap_forms::outside(p, piece.margin_m);
  }
};

}  // namespace palpate
