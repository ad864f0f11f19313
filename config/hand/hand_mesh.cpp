#include "config/hand/hand_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "config/hand/hand_model.h"

namespace palpate {

namespace {

// One closed cross-section of a tube: `count` points, counter-clockwise seen against z.
using Ring = std::vector<Vec3>;

// Joins rings of equal size from bottom to top and closes both ends with a point.
SurfaceMesh loft(const std::vector<Ring>& rings, Vec3 bottom, Vec3 top) {
  SurfaceMesh mesh;
  const auto m = static_cast<std::int32_t>(rings.front().size());
  for (const Ring& ring : rings) mesh.vertex_m.insert(mesh.vertex_m.end(), ring.begin(), ring.end());
  const auto last = static_cast<std::int32_t>(rings.size() - 1) * m;
  const auto low = static_cast<std::int32_t>(mesh.vertex_m.size()), high = low + 1;
  mesh.vertex_m.push_back(bottom);
  mesh.vertex_m.push_back(top);
  for (std::int32_t k = 0; k < m; ++k) {
    const std::int32_t next = (k + 1) % m;
    mesh.triangle.push_back({low, next, k});
    mesh.triangle.push_back({high, last + k, last + next});
    for (std::int32_t at = 0; at < last; at += m) {
      mesh.triangle.push_back({at + k, at + next, at + m + k});
      mesh.triangle.push_back({at + next, at + m + next, at + m + k});
    }
  }
  return mesh;
}

bool is_tip(std::int32_t part) { return part % 3 == 1; }  // rows 1, 4, 7, 10, 13 of the table

// Half thickness of a finger part at `u` (0 root joint, 1 far end), as a multiple of its radius: knuckles are thick,
// shafts slim on the back and padded on the palm's side; a fingertip's back is flattened by the nail.
struct Thickness {
  double side, palm, back;
};
Thickness thickness_at(double u, bool tip) {
  const double waist = 4 * u * (1 - u);
  if (!tip) return {1.04 - 0.10 * waist, 1.0 + 0.04 * waist, 1.02 - 0.16 * waist};
  return {1.04 - 0.10 * u, 1.0 + 0.08 * waist, 1.0 - 0.30 * u * u};
}

SurfaceMesh finger_part_mesh(const ToolPiece& piece) {
  constexpr int kAround = 16;
  const double r = piece.margin_m, h = piece.half_extent_m[2];
  const bool tip = is_tip(piece.part);
  // Inverse of the core's share of the part (config/hand/hand_model.cpp).
  const double length = tip ? (2 * h + r) / 0.8 : 2 * h / 0.6;
  const double root = -h - 0.2 * length, far = tip ? h : h + 0.2 * length;
  // Where along the part each ring stands: three on the rounding at either end, three on the shaft between.
  constexpr std::array<double, 3> kRounding{72 * kPi / 180, 40 * kPi / 180, 0};
  std::vector<std::pair<double, double>> stations;  // z, scale of the cross-section
  for (const double angle : kRounding) stations.emplace_back(root - r * std::sin(angle), std::cos(angle));
  for (const double u : {0.25, 0.5, 0.75}) stations.emplace_back(root + u * (far - root), 1.0);
  for (auto angle = kRounding.rbegin(); angle != kRounding.rend(); ++angle)
    stations.emplace_back(far + r * std::sin(*angle), std::cos(*angle));
  std::vector<Ring> rings;
  for (const auto& [z, scale] : stations) {
    const Thickness t = thickness_at(std::clamp((z - root) / (far - root), 0.0, 1.0), tip);
    Ring ring;
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * kPi * k / kAround, x = std::cos(angle);
      ring.push_back({r * scale * (x > 0 ? t.palm : t.back) * x, r * scale * t.side * std::sin(angle), z});
    }
    rings.push_back(std::move(ring));
  }
  return loft(rings, {0, 0, root - r}, {0, 0, far + r});
}

// Half breadth and half thickness of the palm from the wrist (u = 0) to the knuckles (u = 1), metres.
double palm_breadth(double u) { return 0.0225 + 0.0125 * std::sin(0.5 * kPi * std::min(1.0, 1.5 * u)); }

SurfaceMesh palm_mesh() {
  constexpr int kAround = 32, kRings = 11;
  constexpr double kWrist = -0.062, kKnuckles = 0.041;  // x, from the palm's middle (piece frame is -4 mm off)
  std::vector<Ring> rings;
  for (int i = 0; i < kRings; ++i) {
    const double u = static_cast<double>(i) / (kRings - 1);
    const double x = kWrist + u * (kKnuckles - kWrist) + 0.004;
    const double rounding = std::sqrt(std::max(0.08, 1 - std::pow(std::abs(2 * u - 1), 8)));
    const double half_y = palm_breadth(u) * (0.8 + 0.2 * rounding), half_z = 0.0095 * rounding;
    Ring ring;
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * kPi * k / kAround, c = std::cos(angle), s = std::sin(angle);
      // Superellipse: a slab with round edges. Turned so that points run counter-clockwise about +x.
      const double y = half_y * std::copysign(std::pow(std::abs(c), 0.6), c);
      double z = half_z * std::copysign(std::pow(std::abs(s), 0.7), s);
      // The ball of the thumb, on the palm's side.
      const double ball = std::exp(-std::pow((x - 0.0) / 0.022, 2) - std::pow((y - 0.020) / 0.014, 2));
      if (s < 0) z -= 0.007 * ball;
      ring.push_back({x, y - 0.002, z});
    }
    rings.push_back(std::move(ring));
  }
  return loft(rings, {kWrist + 0.001, 0, 0}, {kKnuckles + 0.007, 0, 0});
}

}  // namespace

SurfaceMesh hand_piece_mesh(const ToolPiece& piece, bool left) {
  if (piece.part != kPalmPart) return finger_part_mesh(piece);  // its own mirror image
  SurfaceMesh palm = palm_mesh();
  if (!left) return palm;
  for (Vec3& p : palm.vertex_m) p.y = -p.y;
  for (Corners& corners : palm.triangle) std::swap(corners[1], corners[2]);
  return palm;
}

}  // namespace palpate
