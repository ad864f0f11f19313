// Tool pieces for tests, and the exact distance of a point from each core.
#pragma once

#include <algorithm>
#include <cmath>

#include "tests/collide/meshes.h"

namespace palpate::test {

inline ToolPiece piece_of(PieceShape shape, double x, double y, double z, double margin) {
  ToolPiece piece{};
  piece.pose_tool = Pose{};
  piece.half_extent_m[0] = x;
  piece.half_extent_m[1] = y;
  piece.half_extent_m[2] = z;
  piece.margin_m = margin;
  piece.bounding_radius_m = std::sqrt(x * x + y * y + z * z) + margin;
  piece.shape = shape;
  return piece;
}

// Distance of point p (piece frame) from the core, 0 inside. Exact; kHull is not covered.
inline double distance_to_core(const ToolPiece& piece, Vec3 p) {
  const double* h = piece.half_extent_m;
  const double r = std::hypot(p.x, p.y), over_z = std::max(std::abs(p.z) - h[2], 0.0);
  switch (piece.shape) {
    case PieceShape::kSphere:
      return norm(p);
    case PieceShape::kCapsule:
      return std::hypot(r, over_z);
    case PieceShape::kCylinder:
      return std::hypot(std::max(r - h[0], 0.0), over_z);
    case PieceShape::kBox:
      return norm({std::max(std::abs(p.x) - h[0], 0.0), std::max(std::abs(p.y) - h[1], 0.0), over_z});
    case PieceShape::kCone: {                  // in the half plane (r, z): inside, below the base, or off the slant
      const double ex = -h[0], ez = 2 * h[2];  // base rim to tip
      const double qx = r - h[0], qz = p.z + h[2];
      if (p.z >= -h[2] && ex * qz - ez * qx >= 0) return 0;
      const double t = std::clamp((qx * ex + qz * ez) / (ex * ex + ez * ez), 0.0, 1.0);
      return std::min(std::hypot(qx - t * ex, qz - t * ez), std::hypot(std::max(qx, 0.0), qz));
    }
    default:
      return -1;
  }
}

// Distance of the triangle from the core: distance_to_core is convex along the triangle, so nested golden-section
// searches find its minimum. Accurate to about 1e-9 of the triangle's size.
inline double distance_oracle(const ToolPiece& piece, const Pose& piece_pose, const Vec3 (&triangle)[3]) {
  constexpr double kGolden = 0.6180339887498949;
  const auto minimum = [](auto&& f) {
    double a = 0, b = 1, x = 1 - kGolden, y = kGolden, fx = f(x), fy = f(y);
    for (int i = 0; i < 45; ++i) {
      if (fx < fy) {
        b = y, y = x, fy = fx, x = b - kGolden * (b - a), fx = f(x);
      } else {
        a = x, x = y, fx = fy, y = a + kGolden * (b - a), fy = f(y);
      }
    }
    return std::min({fx, fy, f(0.0), f(1.0)});
  };
  Vec3 t[3];
  for (int k = 0; k < 3; ++k) t[k] = inverse_transform(piece_pose, triangle[k]);
  return minimum([&](double u) {
    return minimum([&](double v) { return distance_to_core(piece, (1 - u) * t[0] + u * ((1 - v) * t[1] + v * t[2])); });
  });
}

inline const ToolPiece (&all_pieces())[5] {
  static const ToolPiece pieces[5] = {
      piece_of(PieceShape::kSphere, 0, 0, 0, 5e-3), piece_of(PieceShape::kCapsule, 0, 0, 8e-3, 4e-3),
      piece_of(PieceShape::kCylinder, 6e-3, 6e-3, 9e-3, 2e-3), piece_of(PieceShape::kCone, 7e-3, 7e-3, 6e-3, 2e-3),
      piece_of(PieceShape::kBox, 8e-3, 5e-3, 3e-3, 1e-3)};
  return pieces;
}

}  // namespace palpate::test
