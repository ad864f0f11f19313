#include "config/bake/tool_points.h"

#include <algorithm>
#include <cmath>

#include "config/bake/image_writer.h"
#include "config/scene/config_error.h"
#include "config/tool/piece_card.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

// Twice a face's area, of the square of its longest side: less has no direction.
constexpr double kSliver = 1e-9;
// Sine of the angle between faces of one plane, and their distance of the piece's size.
constexpr double kSamePlane = 1e-9;

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

bool in_one_plane(const HullFace& a, const HullFace& b, double size_m) {
  return dot(a.normal, b.normal) > 0 && norm(cross(a.normal, b.normal)) < kSamePlane &&
         std::abs(a.offset_m - b.offset_m) < kSamePlane * size_m;
}

// The planes go through the farthest corners, not through a face's own: of corners that the hull's search took for
// coplanar, a ten millionth of its size, some stand out.
std::vector<HullFace> faces_of(const std::vector<Vec3>& corner) {
  std::vector<HullFace> face;
  for (const Corners& c : convex_hull(corner)) {
    HullFace f{};
    for (std::size_t k = 0; k < 3; ++k) f.corner_m[k] = corner[static_cast<std::size_t>(c[k])];
    const Vec3 ab = f.corner_m[1] - f.corner_m[0], ac = f.corner_m[2] - f.corner_m[0];
    const double longest2 = std::max({squared_norm(ab), squared_norm(ac), squared_norm(ac - ab)});
    if (!(norm(cross(ab, ac)) > kSliver * longest2)) continue;  // three corners in a line: its neighbours cover it
    f.normal = unit_or(cross(ab, ac), {0, 0, 1});
    f.offset_m = -kHuge;
    for (const Vec3& v : corner) f.offset_m = std::max(f.offset_m, dot(f.normal, v));
    face.push_back(f);
  }
  return face;
}

// One face of each plane first: the tick's search asks for planes.
void add_faces(const PieceCore& core, ToolPiece& piece, std::vector<HullFace>& out) {
  piece.first_face = static_cast<std::int32_t>(out.size());
  if (core.shape != PieceShape::kHull) return;
  const double size_m = card_of(core.shape).reach_m(core);
  std::vector<HullFace> plane, more;
  for (const HullFace& f : faces_of(core.vertices_m)) {
    const bool known = std::ranges::any_of(plane, [&](const HullFace& p) { return in_one_plane(p, f, size_m); });
    (known ? more : plane).push_back(f);
  }
  piece.plane_count = static_cast<std::int32_t>(plane.size());
  piece.face_count = static_cast<std::int32_t>(plane.size() + more.size());
  out.insert(out.end(), plane.begin(), plane.end());
  out.insert(out.end(), more.begin(), more.end());
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
    add_faces(core, piece, tool.hull_face);
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

double nearest_points_m(const ImageContents& image) {
  const bool two_tools = image.params.articulation == Articulation::kTwoTools;
  const auto hand = [&](const ToolPoint& p) {
    return two_tools ? image.piece[static_cast<std::size_t>(p.piece)].group : 0;
  };
  double nearest_m = kHuge;
  for (std::size_t a = 0; a < image.tool_point.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const ToolPoint &p = image.tool_point[a], &q = image.tool_point[b];
      if (hand(p) == hand(q)) nearest_m = std::min(nearest_m, norm(p.position_tool_m - q.position_tool_m));
    }
  return nearest_m;
}

void put_tool(Tool tool, ImageContents& image) {
  image.piece = std::move(tool.piece);
  image.tool_point = std::move(tool.point);
  image.hull_vertex_m = std::move(tool.hull_vertex_m);
  image.hull_face = std::move(tool.hull_face);
}

}  // namespace palpate
