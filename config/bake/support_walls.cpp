#include "config/bake/support_walls.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/body/body_card.h"
#include "config/body/supports.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

// Candidates are so much denser than what is kept of them.
constexpr double kDenser = 0.5;
// No wall is looked at in more places than this along a side.
constexpr int kMostAlong = 400;
constexpr double kToSurface = 0.5, kApart = 0.85;  // of the spacing
// Off the border, into the region: a held node stands in it.
constexpr double kInside_m = 1e-10;

struct Box {
  Vec3 lower_m, upper_m;
};
Box box_of(const Model& body) {
  Box box{body.vertex_m[0], body.vertex_m[0]};
  for (const Vec3 p : body.vertex_m) {
    box.lower_m = {std::min(box.lower_m.x, p.x), std::min(box.lower_m.y, p.y), std::min(box.lower_m.z, p.z)};
    box.upper_m = {std::max(box.upper_m.x, p.x), std::max(box.upper_m.y, p.y), std::max(box.upper_m.z, p.z)};
  }
  return box;
}

// Of a rectangle, from a corner along two sides.
void rectangle(Vec3 corner_m, Vec3 one_m, Vec3 two_m, double apart_m, std::vector<Vec3>& out) {
  const auto along = [&](Vec3 side) { return std::clamp(static_cast<int>(norm(side) / apart_m), 1, kMostAlong); };
  const int n = along(one_m), m = along(two_m);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j)
      out.push_back(corner_m + static_cast<double>(i) / n * one_m + static_cast<double>(j) / m * two_m);
}

// Evenly by the golden angle.
void sphere(Vec3 centre_m, double radius_m, double apart_m, std::vector<Vec3>& out) {
  const double area = 4 * std::numbers::pi * radius_m * radius_m;
  const int n = std::clamp(static_cast<int>(area / (apart_m * apart_m)), 12, kMostAlong * kMostAlong);
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < n; ++i) {
    const double y = 1 - 2 * (i + 0.5) / n, r = std::sqrt(1 - y * y);
    out.push_back(centre_m + radius_m * Vec3{r * std::cos(golden * i), y, r * std::sin(golden * i)});
  }
}

void border_of(const FixedDesc& entry, const Box& body, double apart_m, std::vector<Vec3>& out) {
  const double margin = kInside_m;
  switch (entry.region) {
    case FixedRegion::kBase: {
      const Vec3 corner{body.lower_m.x, body.lower_m.y + entry.base_height_m - margin, body.lower_m.z};
      rectangle(corner, {body.upper_m.x - body.lower_m.x, 0, 0}, {0, 0, body.upper_m.z - body.lower_m.z}, apart_m, out);
      return;
    }
    case FixedRegion::kBox: {
      Vec3 low = entry.from_m, high = entry.to_m;
      double* const lows[] = {&low.x, &low.y, &low.z};
      double* const highs[] = {&high.x, &high.y, &high.z};
      for (int i = 0; i < 3; ++i) *lows[i] += margin, *highs[i] -= margin;
      const Vec3 side[3] = {{high.x - low.x, 0, 0}, {0, high.y - low.y, 0}, {0, 0, high.z - low.z}};
      for (int i = 0; i < 3; ++i)
        for (const Vec3 from : {low, low + side[i]})
          rectangle(from, side[(i + 1) % 3], side[(i + 2) % 3], apart_m, out);
      return;
    }
    case FixedRegion::kBall:
      sphere(entry.centre_m, entry.radius_m - margin, apart_m, out);
      return;
    case FixedRegion::kPatch:
    case FixedRegion::kVertices:
      return;
  }
}

}  // namespace

std::vector<Vec3> support_walls(const SceneDesc& scene, const Model& body,
                                const std::function<double(Vec3)>& spacing_m) {
  if (card_of(scene.body.shape).supports != nullptr) return {};  // its supports are not regions
  const Box box = box_of(body);
  const std::vector<FixedDesc> entries = held_regions(scene);
  std::vector<Vec3> kept;
  for (const FixedDesc& entry : entries) {
    if (!is_auto(entry.stiffness_N_per_m3)) continue;  // a bed is of the surface
    std::vector<Vec3> tried;
    border_of(entry, box, kDenser * spacing_m(0.5 * (box.lower_m + box.upper_m)), tried);
    double finest = kHuge;
    for (const Vec3 p : tried) finest = std::min(finest, spacing_m(p));
    tried.clear();
    border_of(entry, box, kDenser * finest, tried);
    for (const Vec3 p : tried) {
      const double apart = spacing_m(p);
      if (std::ranges::any_of(kept, [&](Vec3 q) { return norm(p - q) < kApart * apart; })) continue;
      const SurfacePoint nearest = closest_surface_point(body, p, kHuge, -1);
      if (nearest.found && nearest.signed_distance_m < -kToSurface * apart) kept.push_back(p);
    }
  }
  return kept;
}

}  // namespace palpate
