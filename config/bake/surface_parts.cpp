#include "config/bake/surface_parts.h"

#include <algorithm>

#include "config/body/body_card.h"
#include "config/body/body_pose.h"
#include "config/index.h"
#include "config/scene/config_error.h"
#include "rt_core/surface/foot_search.h"

namespace palpate {

namespace {

// A smooth surface goes on where corners have the same normal: those of each part are longer by so much, so that it
// ends between two of them, too. Far above rounding, far below what any force tells.
constexpr double kSeam = 1e-12;

Vec3 middle_of(const std::vector<Vec3>& vertex_m, const Triangle& t) {
  return (1.0 / 3) * (vertex_m[at(t.vertex[0])] + vertex_m[at(t.vertex[1])] + vertex_m[at(t.vertex[2])]);
}
Vec3 face_of(const std::vector<Vec3>& vertex_m, const Triangle& t) {
  const Vec3 a = vertex_m[at(t.vertex[0])];
  return unit_or(cross(vertex_m[at(t.vertex[1])] - a, vertex_m[at(t.vertex[2])] - a), {0, 1, 0});
}

// Of every triangle, on the body where its shape is made.
std::vector<int> parts_of(const SceneDesc& scene, const ImageContents& image) {
  std::vector<Vec3> own_m = image.vertex_m;
  take_back(scene.body, own_m);
  std::vector<int> part;
  for (const Triangle& t : image.triangle)
    part.push_back(card_of(scene.body.shape).part(middle_of(own_m, t), face_of(own_m, t)));
  return part;
}

// The triangle of a part that is nearest to `from`; the first triangle stands for no part.
std::int32_t nearest_of(const ImageContents& image, const std::vector<int>& part, int of, Vec3 from) {
  std::int32_t nearest = 0;
  double least = kHuge;
  for (std::size_t t = 1; t < part.size(); ++t) {
    const double square = squared_norm(middle_of(image.vertex_m, image.triangle[t]) - from);
    if (part[t] != of || !(square < least)) continue;
    nearest = static_cast<std::int32_t>(t);
    least = square;
  }
  return nearest;
}

}  // namespace

void touch_by_parts(const SceneDesc& scene, ImageContents& image) {
  if (card_of(scene.body.shape).part == nullptr) return;
  const std::vector<int> part = parts_of(scene, image);
  const int parts = *std::ranges::max_element(part);
  const Vec3 from = scene.path.point.empty() ? Vec3{} : scene.path.point.front().position_m;
  std::vector<ToolPoint> points;
  for (ToolPiece& piece : image.piece) {
    if (piece.point_count == 0) continue;
    ToolPoint point = image.tool_point[at(piece.first_point)];
    piece.first_point = static_cast<std::int32_t>(points.size());
    piece.point_count = parts;
    for (int of = 1; of <= parts; ++of) {
      point.begins_at = nearest_of(image, part, of, from + point.position_tool_m);
      points.push_back(point);
    }
  }
  if (points.size() > kMaxPieces)
    throw ConfigError(scene.source.where("body.shape") + ": its surface has " + std::to_string(parts) +
                      " parts that each piece touches, " + std::to_string(points.size()) + " places in all; allowed " +
                      std::to_string(kMaxPieces));
  image.tool_point = std::move(points);
  for (std::size_t t = 0; t < part.size(); ++t)
    for (Vec3& normal : image.corner_normal[t].normal)
      normal = part[t] == 0 ? face_of(image.vertex_m, image.triangle[t]) : (1 + kSeam * part[t]) * normal;
}

std::vector<std::int32_t> part_of(const Model& model, std::int32_t triangle) {
  std::vector<std::int32_t> part{triangle};
  std::vector<bool> known(model.triangle.size());
  known[at(triangle)] = true;
  for (std::size_t i = 0; i < part.size(); ++i)
    for (int edge = 0; edge < 3; ++edge) {
      const std::int32_t next = foot::across(model, part[i], edge);
      if (next < 0 || known[at(next)]) continue;
      known[at(next)] = true;
      part.push_back(next);
    }
  return part;
}

}  // namespace palpate
