// Reads tetrahedral meshes: Gmsh's .msh (formats 2.2 and 4.1, ASCII) and VTK's .vtu (ASCII); makes them from closed
// surfaces with the program gmsh.
#pragma once

#include <span>
#include <string>

#include "config/fem/tet_mesh.h"

namespace palpate {

struct TetFile {
  TetMesh mesh;
  std::int32_t unused_nodes = 0;    // nodes of the file that no tetrahedron uses: dropped
  std::int32_t other_elements = 0;  // points, lines and surface elements: skipped
};

// Picks the format by the extension and multiplies coordinates by `scale` (file units to metres). Reads 4- and 10-node
// tetrahedra and changes Gmsh's order of middle nodes to ours. Does not check the mesh: see check_tet_mesh.
// Throws ConfigError naming file and line: missing, unreadable, truncated, binary, another format, another kind of
// solid element, no tetrahedra.
TetFile read_tet_mesh(const std::string& path, double scale);
TetFile read_msh(const std::string& path, double scale);
TetFile read_vtu(const std::string& path, double scale);

// Fills a closed surface with linear tetrahedra of about `edge_m` by running gmsh (package gmsh; Delaunay, one thread,
// fixed seed: the same mesh every time). The surface's own triangles and vertices stay, and there is a node at each
// of the places `inner_m`, which must lie inside. Throws ConfigError naming `label` when the program is missing or
// cannot mesh the surface, with what it said.
TetMesh tetrahedralise(const SurfaceMesh& surface, double edge_m, const std::string& label,
                       std::span<const Vec3> inner_m = {});

}  // namespace palpate
