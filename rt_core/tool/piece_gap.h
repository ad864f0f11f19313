// Signed distance of points from a convex tool piece, by closed forms: one point, or four at a time with the same bits.
#pragma once

#include <span>

#include "rt_core/lanes.h"
#include "rt_core/model.h"

namespace palpate {

// Vector: Vec3, or Vec3x4 for four points.
template <class Vector>
struct PieceGapOf {
  decltype(Vector::x) gap_m;  // < 0 inside the piece
  Vector normal;              // unit, out of the piece: the direction in which the gap grows
};
using PieceGap = PieceGapOf<Vec3>;

namespace piece_gap_forms {

// Everything below is for one number (Real, Vec3) and for four (Double4, Vec3x4): choices instead of branches.
template <class Number>
inline Number with_sign(const Number& magnitude, const Number& sign) PALPATE_RT {
  return sign < 0 ? -magnitude : magnitude;
}
template <class Number>
inline Number larger(const Number& a, const Number& b) PALPATE_RT {
  return a > b ? a : b;
}
template <class Number>
inline Number smaller(const Number& a, const Number& b) PALPATE_RT {
  return a < b ? a : b;
}
inline Real one_like(Real) PALPATE_RT { return 1; }
inline Double4 one_like(const Double4&) PALPATE_RT { return splat4(1.0); }

// From the nearest point of the core, `offset` away and outside it.
template <class Vector>
[[gnu::always_inline]] inline PieceGapOf<Vector> outside(const Vector& offset, Real margin) PALPATE_RT {
  const auto distance = square_root(dot(offset, offset));
  const auto one = one_like(distance), zero = 0 * one;
  const auto usable = (distance > 1e-300) & (distance < kHuge);
  const auto inverse = 1.0 / (usable ? distance : one);
  return {distance - margin,
          {usable ? inverse * offset.x : zero, usable ? inverse * offset.y : zero, usable ? inverse * offset.z : one}};
}

// Signed distance in the half plane (rho, z) of a body of revolution, as (distance, normal there).
template <class Number>
struct Flat {
  Number distance, rho, z;
};

template <class Number>
inline Flat<Number> cylinder_flat(Real radius, Real half, const Number& rho, const Number& z) PALPATE_RT {
  const Number side = rho - radius, end = abs_of(z) - half, one = one_like(z), zero = 0 * one;
  const auto corner = (side > 0) & (end > 0);
  const auto to_side = side > end;
  const Number distance = square_root(side * side + end * end), inverse_of = corner ? distance : one;
  return {corner ? distance : (to_side ? side : end), corner ? side / inverse_of : (to_side ? one : zero),
          corner ? with_sign(end / inverse_of, z) : (to_side ? zero : with_sign(one, z))};
}

// Cone with its base (radius r) at z = -h and its apex at +h.
template <class Number>
inline Flat<Number> cone_flat(Real r, Real h, const Number& rho, const Number& z) PALPATE_RT {
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

template <class Vector, class Number>
inline PieceGapOf<Vector> revolved(const Flat<Number>& flat, const Vector& p, const Number& rho,
                                   Real margin) PALPATE_RT {
  const Number one = one_like(rho);
  const auto off_axis = rho > 0;
  const Number scale = flat.rho / (off_axis ? rho : one);
  return {flat.distance - margin, {off_axis ? scale * p.x : flat.rho, off_axis ? scale * p.y : 0 * one, flat.z}};
}

template <class Vector>
inline PieceGapOf<Vector> box_gap(const Real (&half)[3], const Vector& p, Real margin) PALPATE_RT {
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

}  // namespace piece_gap_forms

// Gap of `point` (piece frame) from the outer surface of the piece: core and margin. Exact inside and outside; where
// two features are equally near (on an axis, on a bisector) one of them, always the same. Hulls have no
// closed form: they give kHuge, and the scene compiler refuses them for this back-end. Bound: constant.
template <class Vector>
[[gnu::always_inline]] inline PieceGapOf<Vector> piece_gap(const ToolPiece& piece, const Vector& p) PALPATE_RT {
  using Number = decltype(Vector::x);
  const Real(&half)[3] = piece.half_extent_m;
  const Number one = piece_gap_forms::one_like(p.x);
  switch (piece.shape) {
    case PieceShape::kSphere:
      return piece_gap_forms::outside(p, piece.margin_m);
    case PieceShape::kCapsule:
      return piece_gap_forms::outside(
          Vector{p.x, p.y, p.z - piece_gap_forms::smaller(piece_gap_forms::larger(p.z, -half[2] * one), half[2] * one)},
          piece.margin_m);
    case PieceShape::kCylinder: {
      const Number rho = square_root(p.x * p.x + p.y * p.y);
      return piece_gap_forms::revolved(piece_gap_forms::cylinder_flat(half[0], half[2], rho, p.z), p, rho,
                                       piece.margin_m);
    }
    case PieceShape::kCone: {
      const Number rho = square_root(p.x * p.x + p.y * p.y);
      return piece_gap_forms::revolved(piece_gap_forms::cone_flat(half[0], half[2], rho, p.z), p, rho, piece.margin_m);
    }
    case PieceShape::kBox:
      return piece_gap_forms::box_gap(half, p, piece.margin_m);
    case PieceShape::kHull:
      break;  // the baker refuses hulls with this back-end
  }
  return {kHuge * one, {0 * one, 0 * one, 0 * one}};
}

inline PieceGap piece_gap(const ToolPiece& piece, Vec3 p) PALPATE_RT { return piece_gap<Vec3>(piece, p); }

}  // namespace palpate
