// What a picture is made of: camera, colour map and the meshes of tool pieces.
#include <algorithm>
#include <array>
#include <cmath>

#include "rt_core/articulate/carrier.h"
#include "sim_host/hand_mesh.h"
#include "sim_host/picture.h"

namespace palpate {

Camera default_camera(const Model& model, const State& state) {
  Vec3 low = model.vertex_m[0], high = low;
  for (const Vec3 v : model.vertex_m) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  const bool hand = static_cast<Articulation>(model.params.articulation) == Articulation::kHand;
  for (std::size_t i = 0; hand && i < model.piece.size(); ++i) {  // the hand is larger than what it holds
    const Vec3 v =
        transform(carrier_w(model, state, static_cast<std::int32_t>(i)), model.piece[i].pose_tool.position_m);
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  const Vec3 centre = 0.5 * (low + high);
  const double radius = 0.5 * norm(high - low);
  Vec3 side;
  for (const Region& region : state.region) {
    if (region.id != 0 && region.lost_ticks == 0) side += region.normal_force_N * region.normal_w;
  }
  side = unit_or(side, kWorldUp);
  double azimuth = 0.55;  // radians from +z towards +x: from the front, a little from the right
  if (hand)
    azimuth = 0.9;  // fingers and thumb from where they close
  else if (std::hypot(side.x, side.z) > 0.4)
    azimuth = std::atan2(side.x, side.z) + 0.7;
  constexpr double kElevation = 0.42, kFov = 0.5;
  const Vec3 direction{std::cos(kElevation) * std::sin(azimuth), std::sin(kElevation),
                       std::cos(kElevation) * std::cos(azimuth)};
  Camera camera;
  camera.target_m = hand ? centre : centre + 0.38 * radius * kWorldUp;  // room for the tool above
  camera.eye_m = camera.target_m + (1.32 * radius / std::tan(0.5 * kFov)) * direction;
  camera.up = kWorldUp;
  camera.vertical_fov_rad = kFov;
  return camera;
}

Colour displacement_colour(double t) {
  static constexpr std::array kStops{colour(0xf3ece0), colour(0xf5cfa5), colour(0xf1a06c), colour(0xe36a4e),
                                     colour(0xbb3a5b), colour(0x7c2269), colour(0x3a1555)};
  const double place = std::clamp(t, 0.0, 1.0) * (kStops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  return mix(kStops[k], kStops[k + 1], static_cast<float>(place - static_cast<double>(k)));
}

RenderMesh hand_render_mesh(const ToolPiece& piece, const Pose& carrier_w, bool left) {
  const SurfaceMesh mesh = hand_piece_mesh(piece, left);
  const Pose pose = carrier_w * piece.pose_tool;
  RenderMesh render;
  render.normal = vertex_normals(mesh);
  for (const Vec3 v : mesh.vertex_m) render.position_m.push_back(transform(pose, v));
  for (Vec3& n : render.normal) n = rotate(pose.orientation, n);
  render.value.assign(mesh.vertex_m.size(), 0.0);
  render.triangle = mesh.triangle;
  return render;
}

RenderMesh piece_mesh(const Model& model, const ToolPiece& piece, const Pose& carrier_w) {
  const Pose pose = carrier_w * piece.pose_tool;
  const double* half = piece.half_extent_m;
  const double r = half[0], h = half[2];
  switch (static_cast<PieceShape>(piece.shape)) {
    case PieceShape::kSphere:
      return sphere_mesh(pose, piece.margin_m);
    case PieceShape::kCapsule:
      return revolved_mesh(pose, std::array<Point2, 2>{{{0, -h}, {0, h}}}, piece.margin_m);
    case PieceShape::kCylinder:
      return revolved_mesh(pose, std::array<Point2, 4>{{{0, -h}, {r, -h}, {r, h}, {0, h}}}, piece.margin_m);
    case PieceShape::kCone:
      return revolved_mesh(pose, std::array<Point2, 3>{{{0, -h}, {r, -h}, {0, h}}}, piece.margin_m);
    case PieceShape::kBox: {
      std::array<Vec3, 8> corners;
      for (unsigned k = 0; k < 8; ++k) {
        corners[k] = {(k & 1) ? half[0] : -half[0], (k & 2) ? half[1] : -half[1], (k & 4) ? h : -h};
      }
      return hull_mesh(pose, corners, piece.margin_m);
    }
    case PieceShape::kHull:
      return hull_mesh(pose,
                       model.hull_vertex_m.subspan(static_cast<std::size_t>(piece.first_hull),
                                                   static_cast<std::size_t>(piece.hull_count)),
                       piece.margin_m);
  }
  return {};
}

}  // namespace palpate
