#include "sim_host/mesh/convex_parts.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/convex_decomposition_3.h>

#include "config/scene/config_error.h"
#include "sim_host/mesh/surface_repair.h"

namespace palpate {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;

Polyhedron polyhedron_of(const SurfaceMesh& mesh) {
  std::vector<Kernel::Point_3> point;
  std::vector<std::vector<std::size_t>> face;
  for (const Vec3& p : mesh.vertex_m) point.emplace_back(p.x, p.y, p.z);
  for (const Corners& t : mesh.triangle)
    face.push_back({static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]), static_cast<std::size_t>(t[2])});
  Polyhedron polyhedron;
  pmp::polygon_soup_to_polygon_mesh(point, face, polyhedron);
  return polyhedron;
}

}  // namespace

std::vector<std::vector<Vec3>> convex_parts(const SurfaceMesh& mesh, const std::string& label) {
  check_mesh(mesh, label);
  if (survey(mesh).crossings > 0)
    throw ConfigError(label + ": the surface goes through itself; `palpate mesh` repairs most such surfaces");
  Polyhedron polyhedron = polyhedron_of(mesh);
  Nef nef(polyhedron);
  CGAL::convex_decomposition_3(nef);
  std::vector<std::vector<Vec3>> parts;
  auto volume = nef.volumes_begin();
  for (++volume; volume != nef.volumes_end(); ++volume) {  // the first is what is outside
    if (!volume->mark()) continue;
    Polyhedron part;
    nef.convert_inner_shell_to_polyhedron(volume->shells_begin(), part);
    std::vector<Vec3>& corner = parts.emplace_back();
    for (auto p = part.points_begin(); p != part.points_end(); ++p)
      corner.push_back({CGAL::to_double(p->x()), CGAL::to_double(p->y()), CGAL::to_double(p->z())});
  }
  return parts;
}

}  // namespace palpate
