// Convex hull of given corners: tool points at corners.
#include <algorithm>
#include <cmath>

#include "config/tool/piece_card.h"
#include "config/tool/tool_mesh.h"

namespace palpate {

std::vector<Corners> convex_hull(const std::vector<Vec3>& point) {
  SurfaceMesh cloud;
  cloud.vertex_m = point;
  const Bounds box = bounds_of(cloud);
  const double size = box.largest_m();
  const Vec3 middle = 0.5 * (box.lower_m + box.upper_m);
  std::vector<Vec3> p = point;
  for (std::size_t i = 0; i < p.size(); ++i) {
    // Points pushed outwards by different tiny amounts: four of them are then never exactly coplanar.
    const double push = 1e-7 * static_cast<double>((i * 7919 + 13) % 101 + 1) / 101;
    p[i] = p[i] + push * (p[i] - middle);
  }
  std::vector<Corners> hull;
  const auto n = static_cast<std::int32_t>(p.size());
  const auto at = [&](std::int32_t i) { return p[static_cast<std::size_t>(i)]; };
  for (std::int32_t i = 0; i < n; ++i)
    for (std::int32_t j = i + 1; j < n; ++j)
      for (std::int32_t k = j + 1; k < n; ++k) {
        const Vec3 normal = unit_or(cross(at(j) - at(i), at(k) - at(i)), {});
        double above = 0, below = 0;
        for (std::int32_t l = 0; l < n; ++l) {
          const double d = l == i || l == j || l == k ? 0 : dot(normal, at(l) - at(i));
          above = std::max(above, d);
          below = std::min(below, d);
        }
        if (above - below <= 1e-6 * size) continue;  // all in one plane: no volume
        if (above <= 0) hull.push_back({i, j, k});
        if (below >= 0) hull.push_back({i, k, j});
      }
  return hull;
}

namespace {

constexpr CardKey kSizes[] = {{"vertices_mm", "corners of the core, up to 64"}};

Refusal check(const PieceDesc& piece) {
  if (piece.vertices_m.size() <= kMostHullCorners) return {};
  return {"vertices_mm",
          std::to_string(piece.vertices_m.size()) + " corners; allowed 1 to " + std::to_string(kMostHullCorners)};
}

PieceCore core(const PieceDesc& piece) {
  return {piece.shape, piece.touches, {0, 0, 0}, is_auto(piece.margin_m) ? 2e-3 : piece.margin_m, piece.vertices_m};
}
double reach_m(const PieceCore& core) {
  double reach = 0;
  for (const Vec3& v : core.vertices_m) reach = std::max(reach, norm(v));
  return reach;
}

// Farthest-point selection of the corners, from the first.
std::vector<Vec3> points(const PieceCore& core, std::int32_t count) {
  std::vector<Vec3> point{core.vertices_m[0]};
  while (static_cast<std::int32_t>(point.size()) < count) {
    double farthest = 0;
    Vec3 next;
    for (const Vec3& v : core.vertices_m) {
      double nearest = kHuge;
      for (const Vec3& p : point) nearest = std::min(nearest, norm(v - p));
      if (nearest > farthest) {
        farthest = nearest;
        next = v;
      }
    }
    if (!(farthest > 0)) break;
    point.push_back(next);
  }
  return point;
}

std::vector<SurfaceSample> samples(const PieceCore& core) {
  std::vector<SurfaceSample> sample;
  const double m = core.margin_m;
  constexpr std::int32_t kSplit = 12;
  for (const Corners& c : convex_hull(core.vertices_m)) {
    const Vec3 a = core.vertices_m[static_cast<std::size_t>(c[0])], b = core.vertices_m[static_cast<std::size_t>(c[1])],
               d = core.vertices_m[static_cast<std::size_t>(c[2])];
    const Vec3 twice = cross(b - a, d - a);
    const Vec3 n = unit_or(twice, {0, 0, 1});
    const double cell = 0.5 * norm(twice) / (kSplit * kSplit);
    for (std::int32_t i = 0; i < kSplit; ++i)
      for (std::int32_t j = 0; j < 2 * (kSplit - i) - 1; ++j) {  // upright and inverted cells of row i
        const double third = j % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
        const double u = (i + third) / kSplit, v = (j / 2 + third) / kSplit;
        sample.push_back({a + u * (b - a) + v * (d - a) + m * n, cell});
      }
  }
  for (const Vec3& corner : core.vertices_m)  // one sphere in all, shared by the corners
    for (const double s : {-1.0, 1.0})
      for (const Vec3 axis : {Vec3{s, 0, 0}, Vec3{0, s, 0}, Vec3{0, 0, s}})
        sample.push_back({corner + m * axis, 4 * kPi * m * m / (6.0 * static_cast<double>(core.vertices_m.size()))});
  return sample;
}

std::vector<Vec3> corners(const PieceCore& core) { return core.vertices_m; }

}  // namespace

extern const PieceCard hull_piece;
const PieceCard hull_piece{.sizes = kSizes,
                           .margin = "rounding, added to the core; auto: 2 mm",
                           .check = check,
                           .core = core,
                           .reach_m = reach_m,
                           .points = points,
                           .samples = samples,
                           .corners = corners};

}  // namespace palpate
