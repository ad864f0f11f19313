// Cylinder about z with rounded edges.
#pragma once

#include "rt_core/tool/shape/gap_forms.h"

namespace palpate {

struct CylinderShape {
  static Vec3 support(const ToolPiece& piece, std::span<const Vec3>, Vec3 direction) PALPATE_RT {
    using namespace piece_gap_forms;
    return rim(piece.half_extent_m[0], with_sign(piece.half_extent_m[2], direction.z), direction);
  }

  template <class Vector>
  [[gnu::always_inline]] static PieceGapOf<Vector> gap(const ToolPiece& piece, std::span<const HullFace>,
                                                       const Vector& p) PALPATE_RT {
    const auto rho = square_root(p.x * p.x + p.y * p.y);
    return piece_gap_forms::revolved(flat(piece.half_extent_m[0], piece.half_extent_m[2], rho, p.z), p, rho,
                                     piece.margin_m);
  }

 private:
  template <class Number>
  static piece_gap_forms::Flat<Number> flat(Real radius, Real half, const Number& rho, const Number& z) PALPATE_RT {
    using namespace piece_gap_forms;
    const Number side = rho - radius, end = abs_of(z) - half, one = one_like(z), zero = 0 * one;
    const auto corner = (side > 0) & (end > 0);
    const auto to_side = side > end;
    const Number distance = square_root(side * side + end * end), inverse_of = corner ? distance : one;
    return {corner ? distance : (to_side ? side : end), corner ? side / inverse_of : (to_side ? one : zero),
            corner ? with_sign(end / inverse_of, z) : (to_side ? zero : with_sign(one, z))};
  }
};

}  // namespace palpate
