#include "config/body/body.h"

#include <filesystem>

#include "config/bake/fem_body.h"
#include "config/body/mesh_io.h"
#include "config/body/procedural.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

// `label` becomes what messages about the mesh begin with.
SurfaceMesh mesh_from_file(const SceneDesc& scene, std::string& label, std::vector<std::string>& warnings) {
  const BodyDesc& body = scene.body;
  const std::filesystem::path file(body.mesh);
  const std::string path = file.is_absolute() ? body.mesh : scene.source.directory + body.mesh;
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

}  // namespace

SurfaceMesh make_body(const SceneDesc& scene, std::vector<std::string>& warnings) {
  const BodyDesc& body = scene.body;
  SurfaceMesh mesh;
  std::string label = scene.source.where("body.shape");
  switch (body.shape) {
    case BodyShape::kEllipsoid:
      mesh = make_ellipsoid(body.half_axes_m, body.triangles);
      break;
    case BodyShape::kSphere:
      mesh = make_ellipsoid({body.radius_m, body.radius_m, body.radius_m}, body.triangles);
      break;
    case BodyShape::kCylinder:
      mesh = make_cylinder(body.radius_m, body.height_m, body.triangles);
      if (body.axis == BodyAxis::kX)  // a turn about z, then onto the plane y = 0 over the origin
        for (Vec3& p : mesh.vertex_m) p = {p.y - 0.5 * body.height_m, body.radius_m - p.x, p.z};
      break;
    case BodyShape::kBox:
      mesh = make_box(body.size_m, body.triangles);
      break;
    case BodyShape::kRevolution:
      mesh = make_revolution(body.profile, body.triangles);
      break;
    case BodyShape::kHeart:
      mesh = make_heart(body.width_m, body.triangles);
      break;
    case BodyShape::kHalfShell:
      mesh = make_half_shell(body.half_axes_m, body.wall_m, body.triangles);
      break;
    case BodyShape::kRing:
      mesh = make_ring(body.radius_m, body.wall_m, body.axis, body.triangles);
      break;
    case BodyShape::kHollowCylinder:
      mesh = make_hollow_cylinder(body.radius_m, body.wall_m, body.height_m, body.axis, body.triangles);
      break;
    case BodyShape::kClip:
    case BodyShape::kTets:
      mesh = surface_of(make_tet_mesh(scene, warnings)).mesh;
      break;
    case BodyShape::kMesh:
      mesh = mesh_from_file(scene, label, warnings);
      break;
  }
  check_mesh(mesh, label);
  return mesh;
}

}  // namespace palpate
