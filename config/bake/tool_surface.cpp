#include "config/bake/tool_surface.h"

#include <algorithm>
#include <cmath>

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

// Half profile of the core from its lower to its upper pole.
std::vector<std::pair<double, double>> core_profile(const PieceCore& core) {
  const double r = core.half_extent_m[0], h = core.half_extent_m[2];
  switch (core.shape) {
    case PieceShape::kSphere:
      return {{0, 0}};
    case PieceShape::kCapsule:
      return {{0, -h}, {0, h}};
    case PieceShape::kCone:
      return {{0, -h}, {r, -h}, {0, h}};
    default:
      return {{0, -h}, {r, -h}, {r, h}, {0, h}};
  }
}

std::vector<SurfaceSample> revolved_samples(const PieceCore& core) {
  const auto profile = core_profile(core);
  const double m = core.margin_m;
  std::vector<Ring> ring;
  double angle = -0.5 * kPi;  // of the outward normal; grows along the profile of a convex body
  for (std::size_t i = 0; i < profile.size(); ++i) {
    double next = 0.5 * kPi;
    if (i + 1 < profile.size())
      next = std::atan2(-(profile[i + 1].first - profile[i].first), profile[i + 1].second - profile[i].second);
    if (next > angle) add_arc(ring, profile[i].first, profile[i].second, m, angle, next);
    angle = std::max(angle, next);
    if (i + 1 < profile.size()) {
      const double nr = m * math::cos(angle), nz = m * math::sin(angle);
      add_line(ring, profile[i].first + nr, profile[i].second + nz, profile[i + 1].first + nr,
               profile[i + 1].second + nz);
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

constexpr std::int32_t kBoxCells = 48;  // per side; even multiples of small lattices leave no ties
constexpr std::int32_t kBoxArc = 8;

// Offset surface of a box: for each of the 27 sign patterns, a face (one non-zero sign), edge (two) or corner (three).
void add_box_patch(const PieceCore& core, const std::array<std::int32_t, 3>& sign, std::vector<SurfaceSample>& sample) {
  const double m = core.margin_m;
  std::vector<Vec3> offset;   // of the rounding, with
  std::vector<double> share;  // its area per unit length or area of the core
  const double s[3] = {static_cast<double>(sign[0]), static_cast<double>(sign[1]), static_cast<double>(sign[2])};
  std::vector<std::size_t> bent, flat;
  for (std::size_t a = 0; a < 3; ++a) (sign[a] != 0 ? bent : flat).push_back(a);
  const auto push = [&](double u, double v, double w, double area) {
    double n[3] = {0, 0, 0};
    const double value[3] = {u, v, w};
    for (std::size_t i = 0; i < bent.size(); ++i) n[bent[i]] = s[bent[i]] * m * value[i];
    offset.push_back({n[0], n[1], n[2]});
    share.push_back(area);
  };
  const double step = 0.5 * kPi / kBoxArc;
  if (bent.size() == 1) push(1, 0, 0, 1);
  for (std::int32_t i = 0; i < kBoxArc && bent.size() >= 2; ++i) {
    const double a = (i + 0.5) * step;
    if (bent.size() == 2) push(math::cos(a), math::sin(a), 0, m * step);
    for (std::int32_t j = 0; j < kBoxArc && bent.size() == 3; ++j) {
      const double low = math::sin(j * step), high = math::sin((j + 1) * step), b = (j + 0.5) * step;
      push(math::cos(a) * math::cos(b), math::sin(a) * math::cos(b), math::sin(b), m * m * step * (high - low));
    }
  }
  const std::int32_t nu = flat.empty() ? 1 : kBoxCells, nv = flat.size() < 2 ? 1 : kBoxCells;
  for (std::int32_t i = 0; i < nu; ++i)
    for (std::int32_t j = 0; j < nv; ++j) {
      double p[3], cell = 1;
      for (std::size_t a = 0; a < 3; ++a) p[a] = s[a] * core.half_extent_m[a];
      if (!flat.empty()) {
        p[flat[0]] = core.half_extent_m[flat[0]] * ((2 * i + 1.0) / nu - 1);
        cell *= 2 * core.half_extent_m[flat[0]] / nu;
      }
      if (flat.size() == 2) {
        p[flat[1]] = core.half_extent_m[flat[1]] * ((2 * j + 1.0) / nv - 1);
        cell *= 2 * core.half_extent_m[flat[1]] / nv;
      }
      for (std::size_t k = 0; k < offset.size(); ++k)
        if (cell * share[k] > 0) sample.push_back({Vec3{p[0], p[1], p[2]} + offset[k], cell * share[k]});
    }
}

std::vector<SurfaceSample> box_samples(const PieceCore& core) {
  std::vector<SurfaceSample> sample;
  for (std::int32_t x = -1; x <= 1; ++x)
    for (std::int32_t y = -1; y <= 1; ++y)
      for (std::int32_t z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0) add_box_patch(core, {x, y, z}, sample);
  return sample;
}

std::vector<SurfaceSample> hull_samples(const PieceCore& core) {
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

}  // namespace

PieceCore piece_core(const PieceDesc& piece) {
  PieceCore core{piece.shape, piece.touches, {0, 0, 0}, piece.margin_m, piece.vertices_m};
  double* half = core.half_extent_m;
  switch (piece.shape) {
    case PieceShape::kSphere:
      core.margin_m = piece.radius_m;
      break;
    case PieceShape::kCapsule:
      core.margin_m = piece.radius_m;
      half[2] = std::max(0.0, 0.5 * piece.length_m - piece.radius_m);
      break;
    case PieceShape::kCylinder:
      if (is_auto(core.margin_m)) core.margin_m = std::min(piece.radius_m, 0.5 * piece.length_m) / 3;
      half[0] = half[1] = piece.radius_m - core.margin_m;
      half[2] = 0.5 * piece.length_m - core.margin_m;
      break;
    case PieceShape::kCone:
      if (is_auto(core.margin_m)) core.margin_m = 2e-3;
      half[0] = half[1] = piece.radius_m;
      half[2] = 0.5 * piece.length_m;
      break;
    case PieceShape::kBox: {
      const double side[3] = {piece.size_m.x, piece.size_m.y, piece.size_m.z};
      if (is_auto(core.margin_m)) core.margin_m = std::min({side[0], side[1], side[2]}) / 6;
      for (std::size_t a = 0; a < 3; ++a) half[a] = 0.5 * side[a] - core.margin_m;
      break;
    }
    case PieceShape::kHull:
      if (is_auto(core.margin_m)) core.margin_m = 2e-3;
      break;
  }
  return core;
}

std::vector<SurfaceSample> surface_samples(const PieceCore& core) {
  if (core.shape == PieceShape::kBox) return box_samples(core);
  if (core.shape == PieceShape::kHull) return hull_samples(core);
  return revolved_samples(core);
}

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

}  // namespace palpate
