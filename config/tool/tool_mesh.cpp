#include "config/tool/tool_mesh.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "config/bake/tool_points.h"
#include "config/bake/tool_surface.h"
#include "config/body/mesh_io.h"
#include "config/scene/child_program.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

using Part = std::vector<Vec3>;

// Of the mesh's size: how far a corner may stand out of a facet's plane. Files keep single precision.
constexpr double kFlat = 1e-6;

bool is_convex(const SurfaceMesh& mesh) {
  const double flat_m = kFlat * bounds_of(mesh).largest_m();
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Vec3 normal = unit_or(triangle_cross(mesh, t), {}),
               on = mesh.vertex_m[static_cast<std::size_t>(mesh.triangle[t][0])];
    if (std::ranges::any_of(mesh.vertex_m, [&](Vec3 p) { return dot(normal, p - on) > flat_m; })) return false;
  }
  return true;
}

// As palpate-mesh writes them: a line x y z in metres a corner, an empty line after each part.
std::vector<Part> read_parts(const std::string& path) {
  std::ifstream file(path);
  std::vector<Part> parts;
  Part part;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    if (Vec3 p; words >> p.x >> p.y >> p.z) {
      part.push_back(p);
    } else if (!part.empty()) {
      parts.push_back(std::move(part));
      part.clear();
    }
  }
  return parts;
}

std::vector<Part> cut(const std::string& path, double scale, const std::string& label) {
  const TemporaryFolder folder("palpate-tool");
  const std::string log = folder.file("log"), out = folder.file("parts.txt");
  const int status =
      run_program({own_program("palpate-mesh"), path, "--convex", "-o", out, "--scale", number_text(scale)}, log);
  if (status == kProgramMissing)
    throw ConfigError(label +
                      ": the mesh is not convex, and the program palpate-mesh, which cuts it into convex parts, "
                      "is not beside this one; build it, or give convex meshes");
  if (status != 0) throw ConfigError(label + ": could not be cut into convex parts. It said: " + last_lines(log));
  return read_parts(out);
}

// Those that the hull has as corners of its triangles.
Part extreme_corners(const Part& part) {
  std::set<std::int32_t> used;
  for (const Corners& c : convex_hull(part)) used.insert(c.begin(), c.end());
  Part corners;
  for (const std::int32_t i : used) corners.push_back(part[static_cast<std::size_t>(i)]);
  return corners;
}

// A hull about the middle of its own box, so that the ball around it is small.
PieceDesc hull_of(const PieceDesc& mesh, const Part& part) {
  PieceDesc hull = mesh;
  hull.is_mesh = false;
  hull.mesh.clear();
  const Vec3 middle = bounds_of(part).middle_m();
  hull.position_m = transform(Pose{mesh.position_m, rotation_of(mesh.rotation_rad)}, middle);
  hull.vertices_m.clear();
  for (const Vec3 p : part) hull.vertices_m.push_back(p - middle);
  return hull;
}

std::vector<PieceDesc> hulls_of(const SceneDesc& scene, const PieceDesc& piece, const std::string& label) {
  const std::string path = (std::filesystem::path(scene.source.directory) / piece.mesh).string(),
                    where = scene.source.where(label + ".mesh");
  SurfaceMesh mesh;
  try {
    mesh = read_mesh(path, piece.scale).mesh;
    check_mesh(mesh, path);
  } catch (const ConfigError& error) {
    throw ConfigError(where + ": " + error.what() + "; `palpate mesh` repairs most such surfaces");
  }
  const std::vector<Part> parts = is_convex(mesh) ? std::vector<Part>{mesh.vertex_m} : cut(path, piece.scale, where);
  const std::size_t room = kMaxPieces - (scene.piece.size() - 1);
  if (parts.size() > room)
    throw ConfigError(where + ": makes " + std::to_string(parts.size()) + " convex parts, and " + std::to_string(room) +
                      " of the " + std::to_string(kMaxPieces) +
                      " pieces of a tool are left; take out what the body cannot touch, or simplify the mesh");
  std::vector<PieceDesc> hulls;
  for (const Part& part : parts) {
    // The hull's search is of the fourth order in the corners.
    const Part corners = part.size() > 2 * kMostHullCorners ? part : extreme_corners(part);
    if (corners.size() > kMostHullCorners)
      throw ConfigError(where + ": a convex part has " + std::to_string(corners.size()) + " corners; allowed " +
                        std::to_string(kMostHullCorners) +
                        ": simplify the mesh, or take a sphere, capsule, cylinder or cone for what is round");
    hulls.push_back(hull_of(piece, corners));
  }
  return hulls;
}

void check_keys(const SceneDesc& scene, const PieceDesc& piece, const std::string& label) {
  if (piece.is_mesh && piece.mesh.empty())
    throw ConfigError(scene.source.where(label + ".mesh") + ": missing; this shape needs the path of a file");
  const auto idle =
      piece.is_mesh ? std::vector<std::string>{".vertices_mm"} : std::vector<std::string>{".mesh", ".scale"};
  for (const std::string& key : idle)
    if (scene.source.has(label + key))
      throw ConfigError(scene.source.where(label + key) + ": has no effect for this shape; remove it");
}

}  // namespace

void cut_tool_meshes(SceneDesc& scene) {
  const std::size_t written = scene.piece.size();
  for (std::size_t i = 0; i < written; ++i) {
    const PieceDesc& piece = scene.piece[i];
    const std::string label = "tool.piece[" + std::to_string(i) + "]";
    check_keys(scene, piece, label);
    if (!piece.is_mesh) continue;
    const std::vector<PieceDesc> hulls = hulls_of(scene, piece, label);
    scene.piece[i] = hulls.front();
    scene.piece.insert(scene.piece.end(), hulls.begin() + 1, hulls.end());
  }
}

}  // namespace palpate
