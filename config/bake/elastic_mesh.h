// Finite elements of an elastic body: as the scene describes it, and finer about places where it is pressed for
// checking.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "config/bake/image_writer.h"
#include "config/fem/large_strain_solver.h"
#include "config/fem/tet_mesh.h"
#include "config/scene/scene.h"

namespace palpate {

// Made, read, or filled by gmsh below a surface of triangles about body.fem.edge_mm long, with its edges bent to the
// surface in `image`. Throws ConfigError.
TetMesh make_elastic_mesh(const SceneDesc& scene, const ImageContents& image, std::vector<std::string>& warnings);

struct Refinement {
  Vec3 centre_m;
  double radius_m = 0, edge_m = 0;  // edges about so long up to the radius, growing from there
};
// The body that `base` fills, filled anew by gmsh below a surface split in the zones. Throws ConfigError.
TetMesh refine_elastic_mesh(const SceneDesc& scene, const ImageContents& image, const TetMesh& base,
                            std::span<const Refinement> zones);

// Neo-Hookean, for T10, of the scene's materials, on its elastic beds. Throws ConfigError for what they do not meet.
fem::StrainBody elastic_material(const SceneDesc& scene, const ModelParams& params, const TetMesh& mesh);

}  // namespace palpate
