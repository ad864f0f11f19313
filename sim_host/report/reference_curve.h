// What a press by large-strain finite elements says: the curve that models are compared with, and its file.
#pragma once

#include <string>
#include <vector>

#include "config/scene/progress.h"
#include "sim_host/report/model_variants.h"
#include "sim_host/report/surface_error.h"

namespace palpate {

struct ReferenceCurve {
  PressPlace press;
  std::vector<double> depth_m;   // rising, above 0
  std::vector<Vec3> force_N;     // of the body on the ball, world
  std::vector<double> coarse_N;  // along the normal, by a coarser mesh; NaN where that one ended earlier
  ReferenceSurface surface;      // at the deepest; empty where the file has none
  std::string solver, mesh, made;
  double normal_N(std::size_t i) const { return dot(force_N[i], press.normal); }
  // How far the two meshes are apart at most, of the force; 0 without a second one.
  double uncertainty() const;
};

// Solves on two meshes: axisymmetric where the body is one of revolution pressed at its top, otherwise tetrahedra
// refined under the ball. Throws ConfigError or std::runtime_error.
ReferenceCurve solve_reference(const SceneDesc& scene, const PressPlace& press, const Progress& progress = {});

// One CSV file: lines `# key = value`, then depth_mm, fx_N, fy_N, fz_N, coarse_N; its surface in another beside it.
// Throws std::runtime_error naming file and line.
ReferenceCurve read_reference(const std::string& path);
void write_reference(const std::string& path, const ReferenceCurve& curve);
// Where a scene's reference lies: beside it.
std::string reference_path(const std::string& scene_path);

}  // namespace palpate
