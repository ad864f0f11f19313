// Makes a body's surface of what a file holds: closed, oriented, one piece, that does not go through itself, of evenly
// sized triangles. Every change is told with its place and size. By CGAL's polygon mesh processing.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "config/body/mesh.h"

namespace palpate {

struct RepairOptions {
  // A hole is closed when its largest extent is at most this; 0: a fifth of the body's.
  double largest_hole_m = 0;
  // Leave out every part but the one of the largest area, whatever the size of the others; otherwise only parts of
  // less than kCrumb of its extent.
  bool keep_largest = false;
  bool remesh = true;
  // Length of the new triangles' edges; 0: a fortieth of the largest extent.
  double edge_m = 0;
  // Edges at which the facets turn by more than this stay where they are.
  double sharp_deg = 60;
};
inline constexpr double kCrumb = 0.05;

// How many triangles have each edge, by its two vertices, the lower one first.
using EdgeUsers = std::map<std::pair<std::int32_t, std::int32_t>, int>;
EdgeUsers edge_users(const SurfaceMesh& mesh);

// What the surface is like, before and after.
struct SurfaceState {
  std::int64_t vertices = 0, triangles = 0;
  std::int32_t parts = 0;
  std::int64_t open_edges = 0;
  std::int64_t shared_edges = 0;  // that more than two triangles have
  std::int64_t crossings = 0;     // pairs of triangles that go through one another; counted up to kMostCounted
  double volume_m3 = 0, area_m2 = 0;
  Bounds bounds;
};
SurfaceState survey(const SurfaceMesh& mesh);

// One thing that was mended.
struct Repair {
  std::string what;  // "hole of 12 edges, 41 mm around, closed by 30 triangles"
  Vec3 where_m;
};

struct RepairedSurface {
  SurfaceMesh mesh;
  std::vector<Repair> repair;  // nothing: the surface was sound
  // How far the new surface leaves the repaired one, both ways at their vertices.
  double moved_m = 0;
};

using RepairStep = std::function<void(const char* step)>;

// `mesh`: triangles, welded (read_mesh). Throws ConfigError, naming `label`, place, size and remedy, for what it may
// not mend by itself: large holes, several bodies, crossings that stay.
RepairedSurface repair_surface(const SurfaceMesh& mesh, const RepairOptions& options, const std::string& label,
                               const RepairStep& step = {});

}  // namespace palpate
