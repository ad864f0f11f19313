// Convex parts of a closed surface, for rigid tools, by CGAL's decomposition of Nef polyhedra (Chazelle 1984;
// Hachenberger 2007): exact, cut along the planes of reflex edges. The number of parts grows with the square of the
// reflex edges'.
#pragma once

#include <string>
#include <vector>

#include "config/body/mesh.h"

namespace palpate {

// Corners of each part. Throws ConfigError, naming `label`, for a surface that is not closed or goes through itself.
std::vector<std::vector<Vec3>> convex_parts(const SurfaceMesh& mesh, const std::string& label);

}  // namespace palpate
