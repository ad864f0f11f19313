// Box with rounded edges.
#pragma once

#include "rt_core/tool/shape/gap_forms.h"

namespace palpate {

struct BoxShape {
  static Vec3 support(const ToolPiece& piece, std::span<const Vec3>, Vec3 direction) PALPATE_RT {
    using namespace piece_gap_forms;
    const Real* half = piece.half_extent_m;
    return {with_sign(half[0], direction.x), with_sign(half[1], direction.y), with_sign(half[2], direction.z)};
  }

  template <class Vector>
  [[gnu::always_inline]] static PieceGapOf<Vector> gap(const ToolPiece& piece, std::span<const HullFace>,
                                                       const Vector& p) PALPATE_RT {
    using namespace piece_gap_forms;
    const Real(&half)[3] = piece.half_extent_m;
    const Real margin = piece.margin_m;
    using Number = decltype(Vector::x);
    const Number one = one_like(p.x), zero = 0 * one;
    const Vector q{abs_of(p.x) - half[0], abs_of(p.y) - half[1], abs_of(p.z) - half[2]};
    const auto beyond = (q.x > 0) | (q.y > 0) | (q.z > 0);
    const PieceGapOf<Vector> out = outside(
        Vector{with_sign(larger(q.x, zero), p.x), with_sign(larger(q.y, zero), p.y), with_sign(larger(q.z, zero), p.z)},
        margin);
    const auto x_first = (q.x >= q.y) & (q.x >= q.z);
    const auto y_first = q.y >= q.z;
    const Number in = x_first ? q.x : (y_first ? q.y : q.z);
    return {beyond ? out.gap_m : in - margin,
            {beyond ? out.normal.x : (x_first ? with_sign(one, p.x) : zero),
             beyond ? out.normal.y : (x_first ? zero : (y_first ? with_sign(one, p.y) : zero)),
             beyond ? out.normal.z : (x_first ? zero : (y_first ? zero : with_sign(one, p.z)))}};
  }
};

}  // namespace palpate
