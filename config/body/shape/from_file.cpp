// Bodies from a file: a surface mesh, or tetrahedra.
#include "config/bake/fem_body.h"
#include "config/body/body_card.h"
#include "config/body/mesh_io.h"
#include "config/fem/tet_io.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

constexpr CardKey kMeshKeys[] = {{"mesh", "file (.obj, .stl, .ply); y is up"},
                                 {"scale", "metres per unit of the file"},
                                 {"fix_orientation", "turn triangles that face inwards"}};
constexpr CardKey kTetsKeys[] = {{"mesh", "file (.msh, .vtu); y is up"}, {"scale", "metres per unit of the file"}};

Refusal check_mesh_file(const BodyDesc& body) {
  if (!body.mesh.empty()) return {};
  return {"mesh", "missing; shape = \"mesh\" needs the path of an .obj, .stl or .ply file"};
}
Refusal check_tets_file(const BodyDesc& body) {
  if (!body.mesh.empty()) return {};
  return {"mesh", "missing; shape = \"tets\" needs the path of an .msh or .vtu file"};
}

SurfaceMesh mesh(const SceneDesc& scene, std::string& label, std::vector<std::string>& warnings) {
  const BodyDesc& body = scene.body;
  const std::string path = body_file(scene);
  label = scene.source.where("body.mesh") + ": " + path;
  MeshFile read;
  try {
    read = read_mesh(path, body.scale);
  } catch (const ConfigError& error) {
    throw ConfigError(scene.source.where("body.mesh") + ": " + error.what());
  }
  if (read.collapsed_triangles > 0)
    warnings.push_back(path + ": dropped " + std::to_string(read.collapsed_triangles) +
                       " triangles whose corners coincide");
  if (body.fix_orientation) orient_mesh(read.mesh);
  return std::move(read.mesh);
}

TetMesh tets(const SceneDesc& scene, std::vector<std::string>& warnings) {
  const std::string path = body_file(scene);
  TetFile read;
  try {
    read = read_tet_mesh(path, scene.body.scale);
  } catch (const ConfigError& error) {
    throw ConfigError(scene.source.where("body.mesh") + ": " + error.what());
  }
  if (read.unused_nodes > 0)
    warnings.push_back(path + ": dropped " + std::to_string(read.unused_nodes) + " nodes that no tetrahedron uses");
  return read.mesh;
}

SurfaceMesh surface(const SceneDesc& scene, std::string&, std::vector<std::string>& warnings) {
  return surface_of(make_tet_mesh(scene, warnings)).mesh;
}

}  // namespace

extern const BodyCard mesh_body, tets_body;
const BodyCard mesh_body{
    .meaning = "surface mesh from a file", .keys = kMeshKeys, .check = check_mesh_file, .make = mesh};
const BodyCard tets_body{.meaning = "tetrahedral mesh from a file",
                         .keys = kTetsKeys,
                         .check = check_tets_file,
                         .make = surface,
                         .tets = tets,
                         .own_tets = true};

}  // namespace palpate
