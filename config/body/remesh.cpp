#include "config/body/remesh.h"

#include <cmath>

#include "config/body/mesh_io.h"
#include "config/scene/child_program.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

// Elements grow from the surface inwards: finer by half is taken as it is.
constexpr double kFineEnough = 0.6;

// Of an even mesh of equilateral triangles with this area and number.
double mean_edge_m(const SurfaceMesh& surface) {
  return std::sqrt(4 / std::sqrt(3.0) * surface_area_m2(surface) / static_cast<double>(surface.triangle.size()));
}

}  // namespace

SurfaceMesh coarser_surface(const SurfaceMesh& surface, double edge_m, const std::string& label,
                            std::vector<std::string>& warnings) {
  if (mean_edge_m(surface) > kFineEnough * edge_m) return surface;
  const TemporaryFolder folder("palpate-remesh");
  write_obj(folder.file("fine.obj"), surface);
  const std::string log = folder.file("log");
  const int status = run_program({own_program("palpate-mesh"), folder.file("fine.obj"), "-o", folder.file("coarse.obj"),
                                  "--edge-mm", number_text(1e3 * edge_m)},
                                 log);
  if (status == kProgramMissing) {
    warnings.push_back(label +
                       ": the elements are as small as the surface's triangles, as the program palpate-mesh "
                       "is not beside this one; build it, or give a coarser surface");
    return surface;
  }
  if (status != 0)
    throw ConfigError(label + ": no coarser surface of edges of " + number_text(1e3 * edge_m) +
                      " mm (body.fem.edge_mm) could be made. It said: " + last_lines(log));
  return read_mesh(folder.file("coarse.obj"), 1e-3).mesh;
}

}  // namespace palpate
