// What the shapes' closed forms are made of: for one number (Real, Vec3) and for four (Double4, Vec3x4) with the same
// bits.
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
inline bool any_of(int mask) PALPATE_RT { return mask != 0; }
inline bool any_of(const Mask4& mask) PALPATE_RT { return bits_of(mask) != 0; }
inline Real one_like(Real) PALPATE_RT { return 1; }
inline Double4 one_like(const Double4&) PALPATE_RT { return splat4(1.0); }

// Rim point of a disc of the given radius in the plane z.
inline Vec3 rim(Real radius, Real z, Vec3 direction) PALPATE_RT {
  const Vec3 u = unit_or({direction.x, direction.y, 0}, {});
  return {radius * u.x, radius * u.y, z};
}

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

template <class Vector, class Number>
inline PieceGapOf<Vector> revolved(const Flat<Number>& flat, const Vector& p, const Number& rho,
                                   Real margin) PALPATE_RT {
  const Number one = one_like(rho);
  const auto off_axis = rho > 0;
  const Number scale = flat.rho / (off_axis ? rho : one);
  return {flat.distance - margin, {off_axis ? scale * p.x : flat.rho, off_axis ? scale * p.y : 0 * one, flat.z}};
}

}  // namespace piece_gap_forms

}  // namespace palpate
