#include "config/tool/revolved.h"

#include <algorithm>
#include <cmath>

#include "config/bake/tool_points.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

// Samples around an axis, half a step off: for rings of 3, 4, 5, 6, 8, 10 or 12 points symmetric and never equally far
// from two of them, so that symmetric points get equal areas.
constexpr std::int32_t kAround = 240;
constexpr std::int32_t kAlong = 168;  // per profile line or arc: a multiple of twice 2, 3, 4, 6 and 7 steps

// A ring of the outer surface of a body of revolution.
struct Ring {
  double radius_m, z_m, area_m2;
};

void add_line(std::vector<Ring>& ring, double r0, double z0, double r1, double z1) {
  const double slant = std::hypot(r1 - r0, z1 - z0);
  for (std::int32_t i = 0; i < kAlong; ++i) {
    const double u = (i + 0.5) / kAlong;
    const double r = r0 + u * (r1 - r0);
    ring.push_back({r, z0 + u * (z1 - z0), 2 * kPi * r * slant / kAlong});
  }
}
// Arc of the rounding about profile corner (r, z), between two normal angles; band areas are exact.
void add_arc(std::vector<Ring>& ring, double r, double z, double margin, double from, double to) {
  for (std::int32_t i = 0; i < kAlong; ++i) {
    const double a = from + (to - from) * i / kAlong, b = from + (to - from) * (i + 1) / kAlong;
    const double middle = 0.5 * (a + b);
    const double area = 2 * kPi * margin * (r * (b - a) + margin * (math::sin(b) - math::sin(a)));
    ring.push_back({r + margin * math::cos(middle), z + margin * math::sin(middle), area});
  }
}

// Points of the outer ring of an end that carries `count` points: centre, outer ring, and from 13 on an inner ring.
std::int32_t outer_count(std::int32_t count) {
  if (count <= 3) return count == 3 ? 3 : 0;
  return count < 13 ? count - 1 : 2 * (count - 1) / 3;
}
void add_end(std::vector<Vec3>& point, double radius, double z, std::int32_t count) {
  if (count < 1) return;
  const std::int32_t outer = radius > 0 ? outer_count(count) : 0;
  if (count != 3 || outer == 0) point.push_back({0, 0, z});
  add_ring(point, radius, z, outer, 0);
  if (outer > 0 && count >= 13) add_ring(point, 0.5 * radius, z, count - 1 - outer, 0);
}

// Both ends (a cone's upper end is its apex) and `levels` rings between them, using at most `count` points.
std::vector<Vec3> ringed_points(const PieceCore& core, std::int32_t count, std::int32_t levels, bool cone) {
  const double r = core.half_extent_m[0], h = core.half_extent_m[2];
  std::int32_t end = count;  // points of the lower end
  const auto total = [&] { return end + (cone ? 1 : end) + levels * std::max(outer_count(end), 1); };
  while (end > 1 && total() > count) --end;
  std::vector<Vec3> point;
  if (total() > count) return point;
  add_end(point, r, -h, end);
  for (std::int32_t level = 1; level <= levels; ++level) {
    const double u = static_cast<double>(level) / (levels + 1);
    const std::int32_t ring = std::max(outer_count(end), 1);
    if (ring == 1)
      point.push_back({0, 0, h * (2 * u - 1)});
    else
      add_ring(point, cone ? r * (1 - u) : r, h * (2 * u - 1), ring, level % 2 == 1 ? 0.5 : 0.0);
  }
  add_end(point, r, h, cone ? 1 : end);
  return point;
}

}  // namespace

void add_ring(std::vector<Vec3>& point, double radius, double z, std::int32_t count, double phase) {
  for (std::int32_t k = 0; k < count; ++k) {
    const double angle = 2 * kPi * (k + phase) / count;
    point.push_back({radius * math::cos(angle), radius * math::sin(angle), z});
  }
}

std::vector<SurfaceSample> revolved_samples(const PieceCore& core, const CoreProfile& shape) {
  const std::vector<ProfilePoint>& profile = shape.point;
  const double m = core.margin_m;
  std::vector<Ring> ring;
  double angle = -0.5 * kPi;  // of the outward normal; grows along the profile of a convex body
  for (std::size_t i = 0; i < profile.size(); ++i) {
    double next = shape.ring ? 1.5 * kPi : 0.5 * kPi;
    if (i + 1 < profile.size())
      next =
          std::atan2(-(profile[i + 1].radius_m - profile[i].radius_m), profile[i + 1].height_m - profile[i].height_m);
    if (next > angle) add_arc(ring, profile[i].radius_m, profile[i].height_m, m, angle, next);
    angle = std::max(angle, next);
    if (i + 1 < profile.size()) {
      const double nr = m * math::cos(angle), nz = m * math::sin(angle);
      add_line(ring, profile[i].radius_m + nr, profile[i].height_m + nz, profile[i + 1].radius_m + nr,
               profile[i + 1].height_m + nz);
    }
  }
  const double h = core.half_extent_m[2];
  std::vector<SurfaceSample> sample;
  for (const Ring& band : ring) {
    if (core.touches == TouchingEnd::kPlusZ && !(band.z_m > h)) continue;
    if (core.touches == TouchingEnd::kMinusZ && !(band.z_m < -h)) continue;
    if (!(band.area_m2 > 0)) continue;
    for (std::int32_t k = 0; k < kAround; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / kAround;
      sample.push_back(
          {{band.radius_m * math::cos(phi), band.radius_m * math::sin(phi), band.z_m}, band.area_m2 / kAround});
    }
  }
  return sample;
}

std::vector<Vec3> revolved_points(const PieceCore& core, std::int32_t count, bool cone) {
  const double r = core.half_extent_m[0], h = core.half_extent_m[2];
  std::vector<Vec3> best;
  if (core.touches == TouchingEnd::kPlusZ) {
    add_end(best, r, h, cone ? 1 : count);
    return best;
  }
  if (core.touches == TouchingEnd::kMinusZ) {
    add_end(best, r, -h, count);
    return best;
  }
  if (count == 1) return {{0, 0, cone ? h : 0}};
  const std::vector<SurfaceSample> sample = surface_samples(core);
  double best_gap = kHuge;
  for (std::int32_t levels = 0; levels <= 6; ++levels) {
    std::vector<Vec3> point = ringed_points(core, count, levels, cone);
    if (point.empty()) break;
    const double gap = coverage_gap_m(sample, point, core.margin_m);
    if (gap < best_gap - 1e-9) {
      best_gap = gap;
      best = std::move(point);
    }
  }
  return best;
}

Refusal needs_one_end(const PieceDesc& piece) {
  if (piece.touches != TouchingEnd::kAll) return {};
  return {"touches", "this shape presses with one end; set touches = \"minus_z\" or \"plus_z\""};
}

}  // namespace palpate
