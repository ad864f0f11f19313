// A coarser copy of a surface that a file brought, for elements larger than its triangles.
#pragma once

#include <string>
#include <vector>

#include "config/body/mesh.h"

namespace palpate {

// Triangles about `edge_m` long on the same surface, by the program palpate-mesh; a surface whose edges are already
// about so long, or longer, is returned as it is. So it is, with a warning, where that program is missing. Throws
// ConfigError, naming `label`, when it fails.
SurfaceMesh coarser_surface(const SurfaceMesh& surface, double edge_m, const std::string& label,
                            std::vector<std::string>& warnings);

}  // namespace palpate
