#include "config/bake/tool_points.h"

#include <algorithm>
#include <cmath>

#include "config/scene/config_error.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

void add_ring(std::vector<Vec3>& point, double radius, double z, std::int32_t count, double phase) {
  for (std::int32_t k = 0; k < count; ++k) {
    const double angle = 2 * kPi * (k + phase) / count;
    point.push_back({radius * math::cos(angle), radius * math::sin(angle), z});
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

std::vector<Vec3> segment_points(const PieceCore& core, std::int32_t count) {
  const double h = core.half_extent_m[2];
  if (core.touches == TouchingEnd::kPlusZ) return {{0, 0, h}};
  if (core.touches == TouchingEnd::kMinusZ) return {{0, 0, -h}};
  if (count == 1 || h == 0) return {{0, 0, 0}};
  std::vector<Vec3> point;
  for (std::int32_t k = 0; k < count; ++k) point.push_back({0, 0, h * (2.0 * k / (count - 1) - 1)});
  return point;
}

// Both ends (a cone's upper end is its apex) and `levels` rings between them, using at most `count` points.
std::vector<Vec3> ringed_points(const PieceCore& core, std::int32_t count, std::int32_t levels) {
  const double r = core.half_extent_m[0], h = core.half_extent_m[2];
  const bool cone = core.shape == PieceShape::kCone;
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

std::vector<Vec3> revolved_points(const PieceCore& core, std::int32_t count) {
  const double r = core.half_extent_m[0], h = core.half_extent_m[2];
  std::vector<Vec3> best;
  if (core.touches == TouchingEnd::kPlusZ) {
    add_end(best, r, h, core.shape == PieceShape::kCone ? 1 : count);
    return best;
  }
  if (core.touches == TouchingEnd::kMinusZ) {
    add_end(best, r, -h, count);
    return best;
  }
  if (count == 1) return {{0, 0, core.shape == PieceShape::kCone ? h : 0}};
  const std::vector<SurfaceSample> sample = surface_samples(core);
  double best_gap = kHuge;
  for (std::int32_t levels = 0; levels <= 6; ++levels) {
    std::vector<Vec3> point = ringed_points(core, count, levels);
    if (point.empty()) break;
    const double gap = coverage_gap_m(sample, point, core.margin_m);
    if (gap < best_gap - 1e-9) {
      best_gap = gap;
      best = std::move(point);
    }
  }
  return best;
}

// The surface of the finest lattice with at most `count` points, refined where its step is longest.
std::vector<Vec3> box_points(const PieceCore& core, std::int32_t count) {
  std::array<std::int32_t, 3> n{2, 2, 2};
  const auto surface = [](const std::array<std::int32_t, 3>& m) {
    return m[0] * m[1] * m[2] - std::max(0, m[0] - 2) * std::max(0, m[1] - 2) * std::max(0, m[2] - 2);
  };
  for (;;) {
    std::size_t longest = 3;
    for (std::size_t a = 0; a < 3; ++a) {
      std::array<std::int32_t, 3> next = n;
      ++next[a];
      if (surface(next) > count) continue;
      if (longest == 3 || core.half_extent_m[a] / (n[a] - 1) > core.half_extent_m[longest] / (n[longest] - 1))
        longest = a;
    }
    if (longest == 3) break;
    ++n[longest];
  }
  std::vector<Vec3> point;
  const auto place = [&](std::size_t a, std::int32_t i) { return core.half_extent_m[a] * (2.0 * i / (n[a] - 1) - 1); };
  for (std::int32_t i = 0; i < n[0]; ++i)
    for (std::int32_t j = 0; j < n[1]; ++j)
      for (std::int32_t k = 0; k < n[2]; ++k)
        if (i == 0 || j == 0 || k == 0 || i == n[0] - 1 || j == n[1] - 1 || k == n[2] - 1)
          point.push_back({place(0, i), place(1, j), place(2, k)});
  return point;
}

// Farthest-point selection of the corners, from the first.
std::vector<Vec3> hull_points(const PieceCore& core, std::int32_t count) {
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

double bounding_radius_m(const PieceCore& core) {
  const double* h = core.half_extent_m;
  double reach = 0;
  switch (core.shape) {
    case PieceShape::kSphere:
      break;
    case PieceShape::kCapsule:
      reach = h[2];
      break;
    case PieceShape::kCylinder:
    case PieceShape::kCone:
      reach = std::hypot(h[0], h[2]);
      break;
    case PieceShape::kBox:
      reach = norm({h[0], h[1], h[2]});
      break;
    case PieceShape::kHull:
      for (const Vec3& v : core.vertices_m) reach = std::max(reach, norm(v));
      break;
  }
  return reach + core.margin_m;
}

// Areas of the points: each sample belongs to the nearest one, the first of equals.
std::vector<double> areas_of(const std::vector<SurfaceSample>& sample, const std::vector<Vec3>& point) {
  std::vector<double> area(point.size(), 0.0);
  for (const SurfaceSample& s : sample) {
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < point.size(); ++k)
      if (squared_norm(s.position_m - point[k]) < squared_norm(s.position_m - point[nearest])) nearest = k;
    area[nearest] += s.area_m2;
  }
  return area;
}

}  // namespace

Quat rotation_of(Vec3 rotation_rad) {
  const double angle = norm(rotation_rad);
  if (!(angle > 1e-12)) return {};
  const Vec3 axis = (math::sin(0.5 * angle) / angle) * rotation_rad;
  return normalised({math::cos(0.5 * angle), axis.x, axis.y, axis.z});
}

std::vector<Vec3> core_points(const PieceCore& core, std::int32_t count) {
  if (count < 1) return {};
  switch (core.shape) {
    case PieceShape::kSphere:
      return {{0, 0, 0}};
    case PieceShape::kCapsule:
      return segment_points(core, count);
    case PieceShape::kCylinder:
    case PieceShape::kCone:
      return revolved_points(core, count);
    case PieceShape::kBox:
      return box_points(core, count);
    case PieceShape::kHull:
      return hull_points(core, count);
  }
  return {};
}

double coverage_gap_m(const std::vector<SurfaceSample>& sample, const std::vector<Vec3>& point, double margin_m) {
  double gap = 0;
  for (const SurfaceSample& s : sample) {
    double nearest = kHuge;
    for (const Vec3& p : point) nearest = std::min(nearest, squared_norm(s.position_m - p));
    gap = std::max(gap, std::sqrt(nearest) - margin_m);
  }
  return gap;
}

Tool make_tool(const std::vector<PieceDesc>& pieces) {
  Tool tool;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const PieceDesc& desc = pieces[i];
    const PieceCore core = piece_core(desc);
    const std::vector<Vec3> position = core_points(core, desc.points);
    if (desc.points > 0 && position.empty())
      throw ConfigError("tool.piece[" + std::to_string(i) + "].points: too few for this shape; allowed 2 or more");
    ToolPiece piece{};
    piece.pose_tool = {desc.position_m, rotation_of(desc.rotation_rad)};
    std::copy_n(core.half_extent_m, 3, piece.half_extent_m);
    piece.margin_m = core.margin_m;
    piece.bounding_radius_m = bounding_radius_m(core);
    piece.shape = core.shape;
    piece.first_point = static_cast<std::int32_t>(tool.point.size());
    piece.point_count = static_cast<std::int32_t>(position.size());
    piece.first_hull = static_cast<std::int32_t>(tool.hull_vertex_m.size());
    piece.hull_count = static_cast<std::int32_t>(core.vertices_m.size());
    piece.part = desc.part;
    tool.piece.push_back(piece);
    tool.hull_vertex_m.insert(tool.hull_vertex_m.end(), core.vertices_m.begin(), core.vertices_m.end());
    if (position.empty()) {
      tool.gap_m.push_back(0);
      continue;
    }
    const std::vector<SurfaceSample> sample = surface_samples(core);
    const std::vector<double> area = areas_of(sample, position);
    for (std::size_t k = 0; k < position.size(); ++k)
      tool.point.push_back(
          {transform(piece.pose_tool, position[k]), core.margin_m, area[k], 0.0, static_cast<std::int32_t>(i), 0});
    tool.gap_m.push_back(coverage_gap_m(sample, position, core.margin_m));
  }
  return tool;
}

}  // namespace palpate
