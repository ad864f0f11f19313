#include "sim_host/mesh/mesh_picture.h"

#include <algorithm>
#include <cmath>

#include "config/index.h"
#include "sim_host/view/mesh_raster.h"
#include "sim_host/view/png_file.h"
#include "sim_host/view/raster.h"

namespace palpate {

namespace {

constexpr int kPanel = 900, kHead = 60;
constexpr Colour kPaper = colour(0xfbfaf7), kInk = colour(0x23282d), kSkin = colour(0xd9c9a5),
                 kInside = colour(0xc98f8f), kEdge = colour(0x4b4f55), kOpen = colour(0xc22727);
constexpr double kDepthSlack = 2e-3;  // of the extent: an edge lies on its own facets

// Every facet with corners of its own: flat, as the mesh is.
RenderMesh facets(const SurfaceMesh& mesh) {
  RenderMesh out;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Vec3 normal = unit_or(triangle_cross(mesh, t), {0, 1, 0});
    const auto first = static_cast<std::int32_t>(out.position_m.size());
    for (const std::int32_t corner : mesh.triangle[t]) {
      out.position_m.push_back(mesh.vertex_m[at(corner)]);
      out.normal.push_back(normal);
      out.value.push_back(0);
    }
    out.triangle.push_back({first, first + 1, first + 2});
  }
  return out;
}

// Seen slightly from above, whole.
Camera camera_for(const Bounds& bounds) {
  const Vec3 middle = bounds.middle_m();
  const Vec3 away = unit_or({0.55, 0.5, 1}, {0, 0, 1});
  Camera camera;
  camera.target_m = middle;
  camera.eye_m = middle + (1.75 * norm(bounds.size_m())) * away;
  camera.up = {0, 1, 0};
  camera.vertical_fov_rad = 0.5;
  return camera;
}

class Panel {
 public:
  Panel(const SurfaceMesh& mesh, const Bounds& bounds, Canvas& canvas, int left)
      : mesh_(mesh),
        extent_m_(bounds.largest_m()),
        canvas_(canvas),
        left_(left),
        projection_(camera_for(bounds), kPanel, kPanel),
        layer_(kPanel, kPanel) {}

  void draw() {
    layer_.draw({facets(mesh_), projection_, 0});
    for (int y = 0; y < kPanel; ++y)
      for (int x = 0; x < kPanel; ++x)
        if (const Surfel& s = layer_.at(x, y); s.material == 0) canvas_.set_pixel(left_ + x, kHead + y, shade(s, x, y));
    for (const auto& [ends, users] : edge_users(mesh_)) {
      const Vec3 a = projection_(mesh_.vertex_m[at(ends.first)]), b = projection_(mesh_.vertex_m[at(ends.second)]);
      if (users == 1)
        line(a, b, 3, kOpen, 0.9);
      else if (seen(0.5 * (a + b)))
        line(a, b, 0.8, kEdge, 0.35);
    }
  }
  void mark(const std::vector<Repair>& repairs) {
    for (std::size_t i = 0; i < repairs.size(); ++i) {
      if (repairs[i].where_m == Vec3{}) continue;
      const Vec3 p = projection_(repairs[i].where_m);
      std::vector<Point2> ring;
      for (int k = 0; k <= 24; ++k)
        ring.push_back({left_ + p.x + 12 * std::cos(k * 0.2618), kHead + p.y + 12 * std::sin(k * 0.2618)});
      canvas_.polyline(ring, 2, kOpen);
      canvas_.text(left_ + p.x + 15, kHead + p.y - 8, std::to_string(i + 1), 18, kOpen);
    }
  }

 private:
  Colour shade(const Surfel& s, int x, int y) const {
    const Vec3 normal{static_cast<double>(s.normal[0]), static_cast<double>(s.normal[1]),
                      static_cast<double>(s.normal[2])};
    const double facing = -dot(normal, unit_or(projection_.ray(x, y), {0, 0, 1}));
    const Colour base = facing < 0 ? kInside : kSkin;
    return mix(colour(0x2b2620), base, static_cast<float>(0.35 + 0.65 * std::abs(facing)));
  }
  bool seen(Vec3 p) const {
    const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
    if (!(p.z > 0) || x < 0 || y < 0 || x >= kPanel || y >= kPanel) return false;
    return p.z <= static_cast<double>(layer_.at(x, y).depth_m) + kDepthSlack * extent_m_;
  }
  void line(Vec3 a, Vec3 b, double width, Colour c, double opacity) {
    if (!(a.z > 0 && b.z > 0)) return;
    const Point2 ends[2] = {{left_ + a.x, kHead + a.y}, {left_ + b.x, kHead + b.y}};
    canvas_.polyline(ends, width, c, opacity);
  }

  const SurfaceMesh& mesh_;
  double extent_m_;
  Canvas& canvas_;
  int left_;
  Projection projection_;
  Layer layer_;
};

}  // namespace

void save_mesh_picture(const std::string& path, const SurfaceMesh& before, const RepairedSurface& after) {
  Canvas canvas(2 * kPanel, kPanel + kHead, kPaper);
  const Bounds bounds = bounds_of(before);
  Panel first(before, bounds, canvas, 0), second(after.mesh, bounds, canvas, kPanel);
  first.draw();
  first.mark(after.repair);
  second.draw();
  canvas.text(24, 40, "before: " + std::to_string(before.triangle.size()) + " triangles", 24, kInk);
  canvas.text(kPanel + 24, 40, "after: " + std::to_string(after.mesh.triangle.size()) + " triangles", 24, kInk);
  write_png(path, canvas.width(), canvas.height(), canvas.bytes());
}

}  // namespace palpate
