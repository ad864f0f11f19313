// A camera that a mouse turns about a point: azimuth and elevation, distance, and what it looks at. The world's y is
// up.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>

#include "sim_host/view/mesh_raster.h"

namespace palpate {

// Column-major, as OpenGL takes it.
using Matrix4 = std::array<float, 16>;

enum class StandardView { kOblique, kFront, kBack, kLeft, kRight, kTop, kBottom };
// By the names a person writes.
const std::map<std::string, StandardView>& standard_views();

class OrbitCamera {
 public:
  OrbitCamera() = default;
  // Seen as `camera` sees it, turning about the point of its view axis nearest to `pivot_m`.
  OrbitCamera(const Camera& camera, Vec3 pivot_m);

  Camera camera() const;
  double distance_m() const { return distance_m_; }
  Vec3 target_m() const { return target_m_; }
  double azimuth_rad() const { return azimuth_rad_; }
  double elevation_rad() const { return elevation_rad_; }
  // Mouse motion in pixels, of a view `height` pixels high: half a turn for a drag over its whole height.
  void orbit(double dx, double dy, int height);
  // The point under the mouse, at the target's depth, goes with the mouse.
  void pan(double dx, double dy, int height);
  // Nearer by a factor for each positive step of the wheel; never into the target, never out of sight.
  void zoom(double steps);
  // The direction changes, target and distance stay.
  void look_from(StandardView view);

 private:
  double azimuth_rad_ = 0.55, elevation_rad_ = 0.42;  // from +z towards +x; above the horizon
  double distance_m_ = 0.3, nearest_m_ = 0.003, farthest_m_ = 30;
  double fov_rad_ = 0.5;
  Vec3 target_m_;
};

// Clip space of OpenGL for the whole picture `width` by `height`; what lies between near_m and far_m is seen.
Matrix4 view_projection(const Camera& camera, int width, int height, double near_m, double far_m);

// Where the line of sight through a pixel meets the plane through `through_m` that faces the camera: how a tool that
// was grabbed there follows the mouse. `deeper_m` moves it along the view.
Vec3 drag_point(const Projection& projection, Vec3 through_m, double x, double y, double deeper_m = 0);

// Distance along the ray (in lengths of `direction`) to the nearest triangle, or a negative number when it misses.
double ray_hit(const RenderMesh& mesh, Vec3 origin_m, Vec3 direction);

}  // namespace palpate
