#include "rt_core/tool/support.h"

namespace palpate {

namespace {

Real with_sign(Real magnitude, Real sign) PALPATE_RT { return sign < 0 ? -magnitude : magnitude; }

// Rim point of a disc of the given radius in the plane z.
Vec3 rim(Real radius, Real z, Vec3 direction) PALPATE_RT {
  const Vec3 u = unit_or({direction.x, direction.y, 0}, {});
  return {radius * u.x, radius * u.y, z};
}

Vec3 cone_support(const ToolPiece& piece, Vec3 direction) PALPATE_RT {
  const Vec3 tip{0, 0, piece.half_extent_m[2]};
  const Vec3 base = rim(piece.half_extent_m[0], -piece.half_extent_m[2], direction);
  return dot(tip, direction) > dot(base, direction) ? tip : base;
}

Vec3 hull_support(std::span<const Vec3> hull, Vec3 direction) PALPATE_RT {
  Vec3 best = hull[0];
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

}  // namespace

Vec3 core_support(const ToolPiece& piece, std::span<const Vec3> hull, Vec3 direction) PALPATE_RT {
  const Real* half = piece.half_extent_m;
  switch (piece.shape) {
    case PieceShape::kSphere:
      return {};
    case PieceShape::kCapsule:
      return {0, 0, with_sign(half[2], direction.z)};
    case PieceShape::kCylinder:
      return rim(half[0], with_sign(half[2], direction.z), direction);
    case PieceShape::kCone:
      return cone_support(piece, direction);
    case PieceShape::kBox:
      return {with_sign(half[0], direction.x), with_sign(half[1], direction.y), with_sign(half[2], direction.z)};
    case PieceShape::kHull:
      return hull.empty() ? Vec3{} : hull_support(hull, direction);
  }
  return {};
}

std::span<const Vec3> hull_of(const Model& model, const ToolPiece& piece) PALPATE_RT {
  if (piece.shape != PieceShape::kHull || piece.hull_count <= 0) return {};
  const auto first = static_cast<std::size_t>(piece.first_hull);
  return {model.hull_vertex_m.data() + first, static_cast<std::size_t>(piece.hull_count)};
}

}  // namespace palpate
