// Cone about z with rounded edge and apex.
#pragma once

#include "rt_core/tool/shape/gap_forms.h"

namespace palpate {

struct ConeShape {
  // Base (radius half_extent_m[0]) at z = -half_extent_m[2], tip at +half_extent_m[2].
  static Vec3 support(const ToolPiece& piece, std::span<const Vec3>, Vec3 direction) PALPATE_RT {
    const Vec3 tip{0, 0, piece.half_extent_m[2]};
    const Vec3 base = piece_gap_forms::rim(piece.half_extent_m[0], -piece.half_extent_m[2], direction);
    return dot(tip, direction) > dot(base, direction) ? tip : base;
  }

  template <class Vector>
  [[gnu::always_inline]] static PieceGapOf<Vector> gap(const ToolPiece& piece, std::span<const HullFace>,
                                                       const Vector& p) PALPATE_RT {
    const auto rho = square_root(p.x * p.x + p.y * p.y);
    return piece_gap_forms::revolved(flat(piece.half_extent_m[0], piece.half_extent_m[2], rho, p.z), p, rho,
                                     piece.margin_m);
  }

 private:
  // Cone with its base (radius r) at z = -h and its apex at +h.
  template <class Number>
  static piece_gap_forms::Flat<Number> flat(Real r, Real h, const Number& rho, const Number& z) PALPATE_RT {
    using namespace piece_gap_forms;
    const Number one = one_like(z), zero = 0 * one;
    const Real length = square_root(r * r + 4 * h * h);
    const Real n_rho = 2 * h / length, n_z = r / length;  // outward normal of the side
    const Number side = (rho - r) * n_rho + (z + h) * n_z, base = -(z + h);
    const auto inside = (side <= 0) & (base <= 0);
    const auto to_side = side > base;
    // Along the side from the rim to the apex; along the base from the axis to the rim.
    const Number along = smaller(larger(((z + h) * n_rho - (rho - r) * n_z) / length, zero), one);
    const Number side_rho = rho - r * (1 - along), side_z = z + h - 2 * h * along;
    const Number base_rho = larger(rho - r, zero), base_z = z + h;
    const Number side2 = side_rho * side_rho + side_z * side_z, base2 = base_rho * base_rho + base_z * base_z;
    const auto to_base = (base > 0) & (base2 < side2);
    const Number distance = square_root(to_base ? base2 : side2);
    const auto apart = distance > 0;
    const Number by = apart ? distance : one;
    const Number out_rho = apart ? (to_base ? base_rho : side_rho) / by : n_rho * one;
    const Number out_z = apart ? (to_base ? base_z : side_z) / by : n_z * one;
    return {inside ? (to_side ? side : base) : distance, inside ? (to_side ? n_rho * one : zero) : out_rho,
            inside ? (to_side ? n_z * one : -one) : out_z};
  }
};

}  // namespace palpate
