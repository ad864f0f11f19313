// Torus about z: a circle and its rounding. Not convex; its distance is exact all the same.
#pragma once

#include <type_traits>

#include "rt_core/tool/shape/gap_forms.h"

namespace palpate {

struct TorusShape {
  // Of the disc that the circle bounds, its convex hull: the overlap test, which decides whether a region that lost its
  // contacts lives on, takes the hole for the piece. It measures no contact and makes no force.
  static Vec3 support(const ToolPiece& piece, std::span<const Vec3>, Vec3 direction) PALPATE_RT {
    return piece_gap_forms::rim(piece.half_extent_m[0], 0, direction);
  }

  template <class Vector>
  [[gnu::always_inline]] static PieceGapOf<Vector> gap(const ToolPiece& piece, std::span<const HullFace>,
                                                       const Vector& p) PALPATE_RT {
    const auto rho = square_root(p.x * p.x + p.y * p.y);
    const auto one = piece_gap_forms::one_like(rho), zero = 0 * one;
    const auto out = rho - piece.half_extent_m[0], distance = square_root(out * out + p.z * p.z);
    const auto apart = distance > 0;
    const auto by = apart ? distance : one;
    return piece_gap_forms::revolved(
        piece_gap_forms::Flat<std::remove_const_t<decltype(rho)>>{distance, apart ? out / by : one,
                                                                  apart ? p.z / by : zero},
        p, rho, piece.margin_m);
  }
};

}  // namespace palpate
