#include "sim_host/view/orbit_camera.h"

#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

constexpr double kQuarterTurn = 1.57079632679489662;
// Short of straight up and down, where the azimuth would be lost.
constexpr double kSteepest_rad = kQuarterTurn - 1e-3;

}  // namespace

const std::map<std::string, StandardView>& standard_views() {
  static const std::map<std::string, StandardView> views{
      {"oblique", StandardView::kOblique}, {"front", StandardView::kFront}, {"back", StandardView::kBack},
      {"left", StandardView::kLeft},       {"right", StandardView::kRight}, {"top", StandardView::kTop},
      {"bottom", StandardView::kBottom}};
  return views;
}

OrbitCamera::OrbitCamera(const Camera& camera, Vec3 pivot_m) : fov_rad_(camera.vertical_fov_rad) {
  const Vec3 forward = unit_or(camera.target_m - camera.eye_m, {0, 0, -1});
  elevation_rad_ = std::clamp(std::asin(std::clamp(-forward.y, -1.0, 1.0)), -kSteepest_rad, kSteepest_rad);
  azimuth_rad_ = std::atan2(-forward.x, -forward.z);
  distance_m_ = std::max(1e-3, dot(pivot_m - camera.eye_m, forward));
  target_m_ = camera.eye_m + distance_m_ * forward;
  nearest_m_ = 0.02 * distance_m_;
  farthest_m_ = 50 * distance_m_;
}

Camera OrbitCamera::camera() const {
  const double level = std::cos(elevation_rad_);
  Camera camera;
  camera.target_m = target_m_;
  camera.eye_m = target_m_ + distance_m_ * Vec3{level * std::sin(azimuth_rad_), std::sin(elevation_rad_),
                                                level * std::cos(azimuth_rad_)};
  camera.up = {0, 1, 0};
  camera.vertical_fov_rad = fov_rad_;
  return camera;
}

void OrbitCamera::orbit(double dx, double dy, int height) {
  const double per_pixel = 2 * kQuarterTurn / std::max(1, height);
  azimuth_rad_ = std::remainder(azimuth_rad_ - per_pixel * dx, 4 * kQuarterTurn);
  elevation_rad_ = std::clamp(elevation_rad_ + per_pixel * dy, -kSteepest_rad, kSteepest_rad);
}

void OrbitCamera::pan(double dx, double dy, int height) {
  const double per_pixel = 2 * distance_m_ * std::tan(0.5 * fov_rad_) / std::max(1, height);
  const Projection axes(camera(), 1, 1);
  target_m_ += per_pixel * (-dx * axes.right() + dy * axes.up());
}

void OrbitCamera::zoom(double steps) {
  distance_m_ = std::clamp(distance_m_ * std::pow(0.88, steps), nearest_m_, farthest_m_);
}

void OrbitCamera::look_from(StandardView view) {
  const auto set = [this](double azimuth, double elevation) {
    azimuth_rad_ = azimuth;
    elevation_rad_ = elevation;
  };
  switch (view) {
    case StandardView::kOblique:
      return set(0.55, 0.42);
    case StandardView::kFront:
      return set(0, 0);
    case StandardView::kBack:
      return set(2 * kQuarterTurn, 0);
    case StandardView::kLeft:
      return set(-kQuarterTurn, 0);
    case StandardView::kRight:
      return set(kQuarterTurn, 0);
    case StandardView::kTop:
      return set(0, kSteepest_rad);
    case StandardView::kBottom:
      return set(0, -kSteepest_rad);
  }
}

Matrix4 view_projection(const Camera& camera, int width, int height, double near_m, double far_m) {
  const Projection axes(camera, width, height);
  const double up_scale = 1 / std::tan(0.5 * camera.vertical_fov_rad);
  const double right_scale = up_scale * height / width;
  const double a = (far_m + near_m) / (far_m - near_m), b = -2 * far_m * near_m / (far_m - near_m);
  // Rows: clip x, y, z, w of a world point; depth along the view is w.
  const Vec3 x = right_scale * axes.right(), y = up_scale * axes.up(), f = axes.forward();
  const double deep = -dot(f, axes.eye());
  const double row[4][4] = {{x.x, x.y, x.z, -dot(x, axes.eye())},
                            {y.x, y.y, y.z, -dot(y, axes.eye())},
                            {a * f.x, a * f.y, a * f.z, a * deep + b},
                            {f.x, f.y, f.z, deep}};
  Matrix4 matrix{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) matrix[4 * j + i] = static_cast<float>(row[i][j]);
  return matrix;
}

Vec3 drag_point(const Projection& projection, Vec3 through_m, double x, double y, double deeper_m) {
  const double depth = dot(through_m - projection.eye(), projection.forward()) + deeper_m;
  return projection.eye() + depth * projection.ray(x, y);
}

// Moeller & Trumbore 1997.
double ray_hit(const RenderMesh& mesh, Vec3 origin_m, Vec3 direction) {
  double nearest = -1;
  for (const auto& [i, j, k] : mesh.triangle) {
    const Vec3 a = mesh.position_m[static_cast<std::size_t>(i)];
    const Vec3 e1 = mesh.position_m[static_cast<std::size_t>(j)] - a;
    const Vec3 e2 = mesh.position_m[static_cast<std::size_t>(k)] - a;
    const Vec3 p = cross(direction, e2);
    const double determinant = dot(e1, p);
    if (determinant == 0) continue;
    const Vec3 s = origin_m - a, q = cross(s, e1);
    const double u = dot(s, p) / determinant, v = dot(direction, q) / determinant, t = dot(e2, q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && t > 0 && (nearest < 0 || t < nearest)) nearest = t;
  }
  return nearest;
}

}  // namespace palpate
