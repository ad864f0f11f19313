// The whole deformed surface of a body at one state: what pictures and ParaView files show. The real-time core
// evaluates the same displacement field on demand only.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

struct DeformedSurface {
  std::vector<Vec3> rest_m;
  std::vector<std::array<std::int32_t, 3>> triangle;  // counter-clockwise seen from outside
  std::vector<Vec3> displacement_m;                   // world frame, per vertex
  std::vector<Vec3> position_m;                       // rest position plus displacement
  std::vector<Vec3> normal;                           // of the deformed surface, angle-weighted, outward
  std::vector<double> pressure_Pa;                    // of the contacts, per vertex; empty where the model has none
  // Of a refined surface only, per triangle and corner: normals that do not average over creases.
  std::vector<std::array<Vec3, 3>> corner_normal;
};

Vec3 face_normal(const std::vector<Vec3>& position_m, const std::array<std::int32_t, 3>& triangle);
// Angle-weighted vertex normals, as the rest surface's are (Baerentzen & Aanaes 2005).
std::vector<Vec3> mesh_normals(const std::vector<Vec3>& position_m,
                               const std::vector<std::array<std::int32_t, 3>>& triangle);

// Halves every edge; new points come last and are rounded by the corners' normals, which go along (Phong tessellation,
// Boubekeur & Alexa 2008). `parents`: the ends between which each new point stands, one after another.
void refine(std::vector<Vec3>& point_m, std::vector<std::array<std::int32_t, 3>>& triangle,
            std::vector<std::array<Vec3, 3>>& corner_normal,
            std::vector<std::pair<std::int32_t, std::int32_t>>& parents);

// On the model's vertices, with a given displacement for each.
DeformedSurface deformed_surface(const Model& model, std::vector<Vec3> displacement_m);
// On the model's vertices, from the shape models of the scene.
DeformedSurface deformed_surface(const Model& model, const State& state);
// The same on a mesh refined for drawing, up to `most_triangles`, with creases kept sharp. Not refined where the shape
// law is only known at the model's vertices (displacement angles, finite elements); modes are straight between
// vertices. Pressure under a tip is that of a frictionless contact of its profile and true radius on a half space
// (Hertz' for balls, contact_profile.h), at a node of a finite-element body its force over its area; springs at tool
// points have none. Refined once, then evaluated for one state after another.
class RefinedBody {
 public:
  // `model` must outlive this.
  explicit RefinedBody(const Model& model, std::size_t most_triangles = 250'000);
  DeformedSurface shape(const State& state) const;

  // For whoever evaluates it elsewhere. At rest; `parents`: the ends between which each point beyond the model's
  // vertices stands, in order. Points of a coarser mesh come before all finer ones, and of a triangle's four children
  // the first three have its corners first.
  const std::vector<Vec3>& rest_m() const { return rest_m_; }
  const std::vector<Vec3>& rest_normal() const { return normal_; }
  const std::vector<std::array<std::int32_t, 3>>& triangle() const { return triangle_; }
  const std::vector<std::array<Vec3, 3>>& corner_normal() const { return corner_normal_; }
  const std::vector<std::pair<std::int32_t, std::int32_t>>& parents() const { return parents_; }
  int halvings() const { return halvings_; }
  // A corner's normal at rest turns as its point's does, but for corners on a crease: those turn with their triangle.
  static bool turns_with_point(Vec3 corner_normal, Vec3 rest_normal) { return dot(corner_normal, rest_normal) > 0.97; }

 private:
  void turn_normals(DeformedSurface& surface) const;

  const Model& model_;
  std::vector<Vec3> rest_m_, normal_, face_normal_;  // at rest
  std::vector<std::array<std::int32_t, 3>> triangle_;
  std::vector<std::array<Vec3, 3>> corner_normal_;
  std::vector<std::pair<std::int32_t, std::int32_t>> parents_;
  int halvings_ = 0;
};
DeformedSurface refined_surface(const Model& model, const State& state, std::size_t most_triangles = 250'000);

}  // namespace palpate
