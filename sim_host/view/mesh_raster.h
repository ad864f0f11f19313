// A small software renderer for triangles: perspective camera, depth buffer, normals interpolated per pixel, lit when
// the picture is resolved. No graphics driver needed, the same picture on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/vec.h"
#include "sim_host/view/raster.h"

namespace palpate {

// Looks from `eye_m` to `target_m`; `up` is any vector that is not parallel to the view.
struct Camera {
  Vec3 eye_m{0, -1, 0}, target_m{}, up{0, 0, 1};
  double vertical_fov_rad = 0.5;
};

// World to pixel coordinates for a picture of the given size.
class Projection {
 public:
  Projection(const Camera& camera, int width, int height);
  // x, y in pixels from the top left; z: distance along the view, metres (<= 0: behind the eye).
  Vec3 operator()(Vec3 point_w) const;
  // Direction from the eye through a pixel, not normalised, one metre deep.
  Vec3 ray(double x, double y) const;
  Vec3 eye() const { return eye_; }
  Vec3 right() const { return right_; }
  Vec3 up() const { return up_; }
  Vec3 forward() const { return forward_; }

 private:
  Vec3 eye_, right_, up_, forward_;
  double scale_, centre_x_, centre_y_;
};

// Triangles with a normal and a scalar per vertex (what the scalar means is the material's business).
struct RenderMesh {
  std::vector<Vec3> position_m, normal;
  std::vector<double> value;
  std::vector<std::array<std::int32_t, 3>> triangle;
};

// Nearest surface per pixel.
struct Surfel {
  float depth_m = 1e30f;
  float value = 0;
  float normal[3] = {};
  std::int32_t material = -1;  // -1: nothing here
};

// A mesh where a projection shows it.
struct PlacedMesh {
  PlacedMesh(RenderMesh drawn, const Projection& projection, std::int32_t of_material);
  RenderMesh mesh;
  std::vector<Vec3> screen;  // of its vertices
  std::int32_t material;
};

// What is seen through each pixel, for so many rows of a picture at a time.
class Layer {
 public:
  Layer(int width, int height, int rows);
  Layer(int width, int height) : Layer(width, height, height) {}
  int width() const { return width_; }
  int height() const { return height_; }
  // Empties it, for the rows from `first` on.
  void begin(int first);
  // Draws where nearer than what is there. Vertices behind the eye drop their triangle.
  void draw(const PlacedMesh& placed);
  // Of the rows that are there.
  const Surfel& at(int x, int y) const {
    return surfels_[static_cast<std::size_t>(y - first_) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x)];
  }

 private:
  void draw_triangle(const PlacedMesh& placed, const std::array<std::int32_t, 3>& corner);
  int width_, height_, rows_, first_ = 0;
  std::vector<Surfel> surfels_;
};

// Building blocks, in the frame of `pose`, with outward normals; lengths in metres.
RenderMesh sphere_mesh(const Pose& pose, double radius_m);
// Rounded surface of revolution about z: the convex core profile (radius, z) from bottom to top, grown by margin_m.
// Cylinder core: {(0,-h), (r,-h), (r,h), (0,h)}; capsule: {(0,-h), (0,h)}; cone: {(0,-h), (r,-h), (0,h)}.
RenderMesh revolved_mesh(const Pose& pose, std::span<const Point2> core, double margin_m, bool ring = false);
// Convex polyhedron given by its vertices, grown by margin_m (the surface of greatest support in every direction).
RenderMesh hull_mesh(const Pose& pose, std::span<const Vec3> vertices_m, double margin_m);
// From tail to tip, with a cone for head.
RenderMesh arrow_mesh(Vec3 tail_w, Vec3 tip_w, double shaft_radius_m);

}  // namespace palpate
