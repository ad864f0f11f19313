// An elastic body for the image: modes, soft energy and self terms (config/elastic), shown at the surface's vertices.
#pragma once

#include "config/bake/compile.h"
#include "config/fem/tet_mesh.h"

namespace palpate {

// Finite elements of the body the scene describes: made, read, or filled by gmsh below a surface of triangles about
// body.fem.edge_mm long, with its edges bent to the surface in `image`. Throws ConfigError.
TetMesh make_elastic_mesh(const SceneDesc& scene, const ImageContents& image, std::vector<std::string>& warnings);

// Fills the elastic arrays and parameters. The surface in `image` is complete. Throws ConfigError.
ElasticReport add_elastic_body(const SceneDesc& scene, ImageContents& image, std::vector<std::string>& warnings,
                               const Progress& progress);

}  // namespace palpate
