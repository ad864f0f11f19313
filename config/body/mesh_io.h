// Reads surface meshes (OBJ, STL, PLY) through assimp, writes OBJ.
#pragma once

#include <string>

#include "config/body/mesh.h"
#include "config/body/mesh_import.h"

namespace palpate {

struct MeshFile {
  SurfaceMesh mesh;
  std::int32_t welded_vertices = 0;      // vertices of the file that coincided with another
  std::int32_t collapsed_triangles = 0;  // triangles dropped because two of their corners were welded together
};

// Reads `path`, multiplies coordinates by `scale` (file units to metres), welds vertices closer than 1e-7 of the
// extent (STL repeats every vertex) and drops vertices no triangle uses. Does not check the surface: see check_mesh.
// Throws ConfigError naming the file and the reason: missing, unreadable, truncated, unknown extension, no triangles,
// or nothing the library can make sense of within `limits`.
MeshFile read_mesh(const std::string& path, double scale, const ImportLimits& limits = {});

// Writes a surface as Wavefront OBJ, in millimetres. Nine digits: coordinates read back, as the mesh library's floats,
// are the nearest. Throws ConfigError.
void write_obj(const std::string& path, const SurfaceMesh& mesh);

}  // namespace palpate
