// A surface before and after its repair, side by side: edges drawn, open ones in red, the places of repairs numbered as
// they are printed.
#pragma once

#include <string>

#include "sim_host/mesh/surface_repair.h"

namespace palpate {

// Writes a PNG. Throws std::runtime_error.
void save_mesh_picture(const std::string& path, const SurfaceMesh& before, const RepairedSurface& after);

}  // namespace palpate
