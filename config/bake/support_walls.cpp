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

// Of a box, as far as it reaches into the body's.
void box(Vec3 low_m, Vec3 high_m, const Bounds& body, double apart_m, std::vector<Vec3>& out) {
  const double low[3] = {low_m.x, low_m.y, low_m.z}, high[3] = {high_m.x, high_m.y, high_m.z};
  const double first[3] = {body.lower_m.x, body.lower_m.y, body.lower_m.z};
  const double last[3] = {body.upper_m.x, body.upper_m.y, body.upper_m.z};
  for (std::size_t i = 0; i < 3; ++i)
    for (const double at : {low[i] + kInside_m, high[i] - kInside_m}) {
      if (at < first[i] || at > last[i]) continue;
      double corner[3], side[2][3] = {};
      corner[i] = at;
      for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t along = (i + 1 + k) % 3;
        corner[along] = std::max(low[along] + kInside_m, first[along]);
        side[k][along] = std::max(std::min(high[along] - kInside_m, last[along]) - corner[along], 0.0);
      }
      rectangle({corner[0], corner[1], corner[2]}, {side[0][0], side[0][1], side[0][2]},
                {side[1][0], side[1][1], side[1][2]}, apart_m, out);
    }
}

void border_of(const FixedDesc& entry, const Bounds& body, double lowest_m, double apart_m, std::vector<Vec3>& out) {
  if (entry.region == FixedRegion::kBase)
    rectangle({body.lower_m.x, lowest_m + entry.base_height_m - kInside_m, body.lower_m.z},
              {body.upper_m.x - body.lower_m.x, 0, 0}, {0, 0, body.upper_m.z - body.lower_m.z}, apart_m, out);
  else if (entry.region == FixedRegion::kBox)
    box(entry.from_m, entry.to_m, body, apart_m, out);
  else if (entry.region == FixedRegion::kBall)
    sphere(entry.centre_m, entry.radius_m - kInside_m, apart_m, out);
}

}  // namespace

std::vector<Vec3> support_walls(const SceneDesc& scene, const Model& body, double lowest_m,
                                const std::function<double(Vec3)>& spacing_m) {
  if (card_of(scene.body.shape).supports != nullptr) return {};  // its supports are not regions
  const Bounds bounds = bounds_of(body.vertex_m);
  std::vector<Vec3> kept;
  for (const FixedDesc& entry : held_regions(scene)) {
    if (!is_auto(entry.stiffness_N_per_m3)) continue;  // a bed is of the surface
    std::vector<Vec3> tried;
    border_of(entry, bounds, lowest_m, kDenser * spacing_m(bounds.middle_m()), tried);
    double finest = kHuge;
    for (const Vec3 p : tried) finest = std::min(finest, spacing_m(p));
    tried.clear();
    border_of(entry, bounds, lowest_m, kDenser * finest, tried);
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
