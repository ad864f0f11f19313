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

// On the model's vertices, with a given displacement for each.
DeformedSurface deformed_surface(const Model& model, std::vector<Vec3> displacement_m);
// On the model's vertices, from the shape models of the scene.
DeformedSurface deformed_surface(const Model& model, const State& state);
// The same on a mesh refined for drawing, up to `most_triangles`: edges are halved and the new points rounded by the
// normals (Phong tessellation, Boubekeur & Alexa 2008), which keep creases sharp. Not refined where the shape law
// is only known at the model's vertices (displacement angles, finite elements); modes are straight between vertices.
// Pressure under a tip is that of a frictionless contact of its profile and true radius on a half space (Hertz' for
// balls, contact_profile.h), at a node of a finite-element body its force over its area; springs at tool points have
// none. Refined once, then evaluated for one state after another.
class RefinedBody {
 public:
  // `model` must outlive this.
  explicit RefinedBody(const Model& model, std::size_t most_triangles = 250'000);
  DeformedSurface shape(const State& state) const;

 private:
  void turn_normals(DeformedSurface& surface) const;

  const Model& model_;
  std::vector<Vec3> rest_m_, normal_, face_normal_;  // at rest
  std::vector<std::array<std::int32_t, 3>> triangle_;
  std::vector<std::array<Vec3, 3>> corner_normal_;
  std::vector<std::pair<std::int32_t, std::int32_t>> parents_;  // of the points beyond the model's vertices, in order
};
DeformedSurface refined_surface(const Model& model, const State& state, std::size_t most_triangles = 250'000);

}  // namespace palpate
