#include "config/bake/tool_points.h"

#include <algorithm>
#include <cmath>

#include "config/scene/config_error.h"
#include "config/tool/piece_card.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

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
  return count < 1 ? std::vector<Vec3>{} : card_of(core.shape).points(core, count);
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
    piece.bounding_radius_m = card_of(core.shape).reach_m(core) + core.margin_m;
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
