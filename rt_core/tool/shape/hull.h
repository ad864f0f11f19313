// Convex hull of given corners, rounded.
#pragma once

#include "rt_core/tool/shape/gap_forms.h"

namespace palpate {

struct HullShape {
  // The gap of a hull has no closed form: the loader refuses hulls where nodes touch the exact pieces.
  static constexpr bool kHasGap = false;

  static Vec3 support(const ToolPiece&, std::span<const Vec3> hull, Vec3 direction) PALPATE_RT {
    Vec3 best = hull.empty() ? Vec3{} : hull[0];
    Real farthest = dot(best, direction);
    for (const Vec3& v : hull) {  // bound: hull.size(); ties keep the first
      const Real along = dot(v, direction);
      if (along > farthest) {
        farthest = along;
        best = v;
      }
    }
    return best;
  }

  template <class Vector>
  [[gnu::always_inline]] static PieceGapOf<Vector> gap(const ToolPiece&, const Vector& p) PALPATE_RT {
    const auto one = piece_gap_forms::one_like(p.x), zero = 0 * one;
    return {kHuge * one, {zero, zero, zero}};
  }
};

}  // namespace palpate
