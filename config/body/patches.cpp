#include "config/body/patches.h"

#include <algorithm>

#include "config/bake/tool_surface.h"

namespace palpate {

namespace {

// Barycentric weights of the point where the ray from the origin along `ray` meets the triangle; false when it misses.
bool meet(const Vec3 (&corner)[3], Vec3 ray, double (&weight)[3]) {
  // ray ~ w0 a + w1 b + w2 c: Cramer's rule.
  const double w0 = dot(ray, cross(corner[1], corner[2])), w1 = dot(corner[0], cross(ray, corner[2])),
               w2 = dot(corner[0], cross(corner[1], ray));
  const double volume = dot(corner[0], cross(corner[1], corner[2]));
  if (!(volume > 0)) return false;  // the triangle faces away from the centre
  const double sum = w0 + w1 + w2, slack = -1e-9 * volume;
  if (!(w0 >= slack && w1 >= slack && w2 >= slack && sum > 0)) return false;
  const double raw[3] = {std::max(w0, 0.0), std::max(w1, 0.0), std::max(w2, 0.0)};
  const double total = raw[0] + raw[1] + raw[2];
  for (std::size_t k = 0; k < 3; ++k) weight[k] = raw[k] / total;
  return true;
}

PatchWeight nearest_three(Vec3 p, const std::vector<AnchorPoint>& anchors) {
  std::vector<std::pair<double, std::int32_t>> order;
  for (std::size_t i = 0; i < anchors.size(); ++i)
    order.emplace_back(norm(anchors[i].position_m - p), static_cast<std::int32_t>(i));
  std::sort(order.begin(), order.end());
  PatchWeight patch{};
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    patch.anchor[k] = order[k].second;
    patch.weight[k] = 1.0 / (order[k].first + 1e-6);
    sum += patch.weight[k];
  }
  for (double& w : patch.weight) w /= sum;
  return patch;
}

}  // namespace

std::vector<PatchWeight> make_patches(const std::vector<Vec3>& vertex_m, const std::vector<AnchorPoint>& anchors,
                                      Vec3 centre_m) {
  std::vector<Vec3> direction;
  for (const AnchorPoint& a : anchors) direction.push_back(unit_or(a.position_m - centre_m, {0, 1, 0}));
  const std::vector<Corners> hull = convex_hull(direction);
  std::vector<PatchWeight> patches;
  patches.reserve(vertex_m.size());
  for (const Vec3& p : vertex_m) {
    const Vec3 ray = unit_or(p - centre_m, {0, 1, 0});
    PatchWeight patch{};
    bool found = false;
    for (const Corners& c : hull) {
      const Vec3 corner[3] = {direction[static_cast<std::size_t>(c[0])], direction[static_cast<std::size_t>(c[1])],
                              direction[static_cast<std::size_t>(c[2])]};
      if (!meet(corner, ray, patch.weight)) continue;
      std::copy(c.begin(), c.end(), patch.anchor);
      found = true;
      break;
    }
    patches.push_back(found ? patch : nearest_three(p, anchors));
  }
  return patches;
}

}  // namespace palpate
