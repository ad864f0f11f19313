// What a picture is made of: camera, colour map and the meshes of tool pieces.
#include <algorithm>
#include <array>
#include <cmath>

#include "config/hand/hand_mesh.h"
#include "config/hand/hand_model.h"
#include "config/tool/piece_card.h"
#include "rt_core/tool/articulate.h"
#include "rt_core/tool/shapes.h"
#include "sim_host/view/picture.h"

namespace palpate {

namespace {

bool is_hand(const Model& model) { return model.params.articulation == Articulation::kHand; }

// Everything to be seen. What of a long tool lies farther from the body than kToolShown of its radii is
// left to the edge of the picture.
std::vector<Vec3> scene_points(const Model& model, const State& state) {
  constexpr double kToolShown = 2.8;
  std::vector<Vec3> points(model.vertex_m.begin(), model.vertex_m.end());
  Vec3 centre;
  for (const Vec3 v : points) centre += (1.0 / static_cast<double>(model.vertex_m.size())) * v;
  double radius = 0;
  for (const Vec3 v : points) radius = std::max(radius, norm(v - centre));
  for (std::size_t i = 0; i < model.piece.size(); ++i) {
    const Pose carrier = carrier_w(model, state, static_cast<std::int32_t>(i));
    const RenderMesh mesh = is_hand(model) ? hand_render_mesh(model.piece[i], carrier, is_left_hand(model))
                                           : piece_mesh(model, model.piece[i], carrier);
    for (const Vec3 v : mesh.position_m) {
      const double far = norm(v - centre);
      points.push_back(
          is_hand(model) || far < kToolShown * radius ? v : centre + (kToolShown * radius / far) * (v - centre));
    }
  }
  return points;
}

// Where the camera looks along: a unit vector from the eye into the scene.
Vec3 view_direction(const Model& model, const State& state) {
  Vec3 side;
  for (const Region& region : state.region) {
    if (region.id != 0 && region.lost_ticks == 0) side += region.normal_force_N * region.normal_w;
  }
  side = unit_or(side, kWorldUp);
  double azimuth = 0.55;  // radians from +z towards +x: from the front, a little from the right
  if (is_hand(model))
    azimuth = 0.9;  // fingers and thumb from where they close
  else if (std::hypot(side.x, side.z) > 0.4)
    azimuth = std::atan2(side.x, side.z) + 0.7;
  constexpr double kElevation = 0.42;
  return -Vec3{std::cos(kElevation) * std::sin(azimuth), std::sin(kElevation),
               std::cos(kElevation) * std::cos(azimuth)};
}

// The eye's place along one direction of the picture, as near as all points allow. A point at (along, deep) is seen
// within the slopes `low` to `high` from an eye at (at, back) when at >= along - high deep + high back and
// at <= along - low deep + low back.
struct Fit {
  double low, high;
  double most = -1e300, least = 1e300;
  void add(double along, double deep) {
    most = std::max(most, along - high * deep);
    least = std::min(least, along - low * deep);
  }
  double nearest() const { return (least - most) / (high - low); }
  double place(double back) const { return 0.5 * (most + high * back + least + low * back); }
};

}  // namespace

Camera default_camera(const Model& model, const State& state, std::span<const Vec3> points_w, double aspect,
                      std::optional<StandardView> view) {
  constexpr double kFov = 0.5;
  Vec3 forward = view_direction(model, state);
  if (view) {
    OrbitCamera turned;
    turned.look_from(*view);
    forward = Projection(turned.camera(), 1, 1).forward();
  }
  const Vec3 right = unit_or(cross(forward, kWorldUp), {1, 0, 0}), up = cross(right, forward);
  const double slope = std::tan(0.5 * kFov), wide = slope * aspect;
  // Shares of the half picture: the legend stands at the right, the title at the top, scales at the foot, a force's
  // number may stand beyond an arrow's tip.
  Fit across{-0.86 * wide, 0.72 * wide}, upward{-0.78 * slope, 0.72 * slope};
  std::vector<Vec3> points = scene_points(model, state);
  points.insert(points.end(), points_w.begin(), points_w.end());
  for (const Vec3 p : points) {
    across.add(dot(p, right), dot(p, forward));
    upward.add(dot(p, up), dot(p, forward));
  }
  const double back = std::min(across.nearest(), upward.nearest());
  Camera camera;
  camera.eye_m = across.place(back) * right + upward.place(back) * up + back * forward;
  camera.target_m = camera.eye_m + forward;
  camera.up = kWorldUp;
  camera.vertical_fov_rad = kFov;
  return camera;
}

Colour map_colour(double t) {
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
  const std::span<const Vec3> hull = hull_of(model, piece);
  const PieceCore core{piece.shape,
                       TouchingEnd::kAll,
                       {piece.half_extent_m[0], piece.half_extent_m[1], piece.half_extent_m[2]},
                       piece.margin_m,
                       {hull.begin(), hull.end()}};
  const PieceCard& card = card_of(piece.shape);
  if (card.profile == nullptr) return hull_mesh(pose, card.corners(core), piece.margin_m);
  const CoreProfile profile = card.profile(core);
  if (profile.point.size() == 1 && !profile.ring) return sphere_mesh(pose, piece.margin_m);
  std::vector<Point2> point;
  for (const ProfilePoint p : profile.point) point.push_back({p.radius_m, p.height_m});
  return revolved_mesh(pose, point, piece.margin_m, profile.ring);
}

}  // namespace palpate
