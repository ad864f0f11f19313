// Convex hull of given corners, rounded.
#pragma once

#include "rt_core/tool/shape/gap_forms.h"

namespace palpate {

struct HullShape {
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

  // Never more than the gap: the largest distance from a face's plane, which within the core and over a face is exact.
  // Bound: piece.plane_count.
  template <class Vector>
  static auto least_gap(const ToolPiece& piece, std::span<const HullFace> face, const Vector& p) PALPATE_RT {
    using namespace piece_gap_forms;
    auto most = -kHuge * one_like(p.x);
    for (const HullFace& f : planes_of(piece, face)) most = larger(most, beyond(f, p));  // bound: plane_count
    return most - piece.margin_m;
  }

  // Within the core from the plane that is nearest, the first of equals; outside from the nearest of the triangles that
  // the point can see. Without faces kHuge. Bound: piece.plane_count + face.size().
  template <class Vector>
  static PieceGapOf<Vector> gap(const ToolPiece& piece, std::span<const HullFace> face, const Vector& p) PALPATE_RT {
    using namespace piece_gap_forms;
    using Number = decltype(Vector::x);
    const Number one = one_like(p.x), zero = 0 * one;
    if (face.empty()) return {kHuge * one, {zero, zero, one}};
    Number plane = -kHuge * one;
    Vector normal{zero, zero, zero};
    for (const HullFace& f : planes_of(piece, face)) {  // bound: plane_count
      const Number s = beyond(f, p);
      const auto more = s > plane;
      plane = more ? s : plane;
      normal = {more ? f.normal.x * one : normal.x, more ? f.normal.y * one : normal.y,
                more ? f.normal.z * one : normal.z};
    }
    const auto is_out = plane > kOnPlane_m;
    if (!any_of(is_out)) return {plane - piece.margin_m, normal};
    Offset<Vector> nearest{kHuge * one, {zero, zero, zero}};
    for (const HullFace& f : face) {  // bound: face.size()
      const Number s = beyond(f, p);
      const auto may_be = (s > 0) & (s * s < nearest.distance2);
      if (any_of(may_be)) nearest = nearer(nearest, from_triangle(f, s, p), may_be);
    }
    const PieceGapOf<Vector> out = outside(nearest.from, piece.margin_m);
    return {is_out ? out.gap_m : plane - piece.margin_m,
            {is_out ? out.normal.x : normal.x, is_out ? out.normal.y : normal.y, is_out ? out.normal.z : normal.z}};
  }

 private:
  // A point no farther out than this is on its plane: the direction from the nearest point would be rounding.
  static constexpr Real kOnPlane_m = 1e-12;

  static std::span<const HullFace> planes_of(const ToolPiece& piece, std::span<const HullFace> face) PALPATE_RT {
    return face.first(static_cast<std::size_t>(piece.plane_count));
  }

  template <class Vector>
  struct Offset {
    decltype(Vector::x) distance2;
    Vector from;  // the nearest point, to the point asked for
  };

  template <class Vector>
  static auto beyond(const HullFace& f, const Vector& p) PALPATE_RT {
    return f.normal.x * p.x + f.normal.y * p.y + f.normal.z * p.z - f.offset_m;
  }

  template <class Vector, class Mask>
  static Offset<Vector> nearer(const Offset<Vector>& a, const Offset<Vector>& b, const Mask& may_be) PALPATE_RT {
    const auto taken = may_be & (b.distance2 < a.distance2);
    return {taken ? b.distance2 : a.distance2,
            {taken ? b.from.x : a.from.x, taken ? b.from.y : a.from.y, taken ? b.from.z : a.from.z}};
  }

  // `s` beyond its plane: straight down where that meets the triangle, else to the nearest of its edges.
  template <class Vector>
  static Offset<Vector> from_triangle(const HullFace& f, const decltype(Vector::x)& s, const Vector& p) PALPATE_RT {
    using namespace piece_gap_forms;
    using Number = decltype(Vector::x);
    const Number one = one_like(s), zero = 0 * one;
    Offset<Vector> edge{kHuge * one, {zero, zero, zero}};
    Number outermost = -kHuge * one;
    for (int k = 0; k < 3; ++k) {  // bound: 3
      const Vec3 a = f.corner_m[k], e = f.corner_m[(k + 1) % 3] - a, out = cross(e, f.normal);
      const Real per_m2 = 1 / squared_norm(e);
      const Vector arm{p.x - a.x, p.y - a.y, p.z - a.z};
      const Number along = smaller(larger((arm.x * e.x + arm.y * e.y + arm.z * e.z) * per_m2, zero), one);
      const Vector from{arm.x - along * e.x, arm.y - along * e.y, arm.z - along * e.z};
      outermost = larger(outermost, arm.x * out.x + arm.y * out.y + arm.z * out.z);
      const Number distance2 = dot(from, from);
      edge = nearer(edge, {distance2, from}, distance2 >= 0);
    }
    const auto within = outermost <= 0;
    return {within ? s * s : edge.distance2,
            {within ? s * f.normal.x : edge.from.x, within ? s * f.normal.y : edge.from.y,
             within ? s * f.normal.z : edge.from.z}};
  }
};

}  // namespace palpate
