#include "sim_host/view/surface_bend.h"

#include <cmath>

#include "rt_core/cholesky.h"

namespace palpate {

namespace {

constexpr std::int32_t kTerms = 6;

// Principal curvatures of height = -(xx x^2 + 2 xy x y + yy y^2)/2 over the plane of `u` and `v`.
SurfaceBend principal(double xx, double xy, double yy, Vec3 u, Vec3 v) {
  const double middle = 0.5 * (xx + yy), half = std::hypot(0.5 * (xx - yy), xy);
  // Direction of the larger one at half the angle of (xx - yy, 2 xy); the smaller one's is across.
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  return {-std::sin(angle) * u + std::cos(angle) * v, middle + half, middle - half};
}

}  // namespace

SurfaceBend surface_bend(const Model& model, Vec3 place_w, Vec3 normal_w, Real radius_m) {
  constexpr Real kFacing = 0.5;  // cosine: not the other side of a thin wall, nor what lies beyond an edge
  const Vec3 u = unit_or(tangential_part(axis_off(normal_w), normal_w), {1, 0, 0}), v = cross(normal_w, u);
  double square[kTerms * kTerms] = {}, height[kTerms] = {};  // normal equations, lengths over radius_m
  int near = 0;
  for (std::size_t i = 0; i < model.vertex_m.size() && i < model.vertex_normal.size(); ++i) {
    const Vec3 from = (1 / radius_m) * (model.vertex_m[i] - place_w);
    if (dot(model.vertex_normal[i], normal_w) < kFacing || !(norm(from) < 1)) continue;
    const double x = dot(from, u), y = dot(from, v), z = dot(from, normal_w);
    const double term[kTerms] = {1, x, y, 0.5 * x * x, x * y, 0.5 * y * y};
    for (std::int32_t a = 0; a < kTerms; ++a) {
      height[a] += term[a] * z;
      for (std::int32_t b = 0; b < kTerms; ++b) square[a * kTerms + b] += term[a] * term[b];
    }
    ++near;
  }
  if (near < 2 * kTerms || !cholesky_factor(square, kTerms)) return {u};
  cholesky_solve(square, height, kTerms);
  return principal(-height[3] / radius_m, -height[4] / radius_m, -height[5] / radius_m, u, v);
}

}  // namespace palpate
