// The finite-element body a scene describes.
#pragma once

#include "config/bake/nodal_body.h"
#include "config/fem/condense.h"
#include "config/scene/scene.h"

namespace palpate {

struct FemBody {
  TetMesh mesh;
  CondensedBody condensed;
  std::vector<float> strain_gauge;  // as Model::strain_gauge
  CompliancePrecision precision = CompliancePrecision::kSingle;
  double precision_error = 0;  // of a press's total force, if the table is rounded
  std::int32_t gauges = 0;
};

// Length of the edges: the scene's, or an eighth of the largest extent.
double tet_edge_m(const SceneDesc& scene, Vec3 size_m);
// Mesh only: made, read, or filled by gmsh, as the scene says. Throws ConfigError.
TetMesh make_tet_mesh(const SceneDesc& scene, std::vector<std::string>& warnings);
// Mesh, supports, compliance and strain gauges. Throws ConfigError. Adds warnings.
FemBody make_fem_body(const SceneDesc& scene, std::vector<std::string>& warnings, const Progress& progress);

}  // namespace palpate
