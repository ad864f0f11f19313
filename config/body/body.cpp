#include "config/body/body.h"

#include <cmath>

#include "config/body/body_card.h"
#include "config/body/self_intersection.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

// A surface from a file may go through itself and still be closed and oriented; then what is inside depends on the
// sheet met first. What is made here cannot.
void check_crossings(const SurfaceMesh& mesh, const std::string& label, std::vector<std::string>& warnings) {
  const SelfIntersections found = find_self_intersections(mesh);
  if (!found.complete)
    warnings.push_back(label +
                       ": looked for places where the surface goes through itself in part of it only (long thin "
                       "triangles); remesh it");
  if (found.pairs == 0) return;
  const auto mm = [](double x_m) { return number_text(std::round(1e5 * x_m) / 100); };
  throw ConfigError(label + ": the surface goes through itself at (" + mm(found.where_m.x) + ", " +
                    mm(found.where_m.y) + ", " + mm(found.where_m.z) + ") mm, triangle " + std::to_string(found.first) +
                    " (" + std::to_string(found.pairs) + (found.pairs >= kMostCounted ? " or more" : "") +
                    " pairs of triangles cross): which side is inside is not defined there; unite the parts, or remove "
                    "the fold, in a mesh editor");
}

}  // namespace

SurfaceMesh make_body(const SceneDesc& scene, std::vector<std::string>& warnings) {
  std::string label = scene.source.where("body.shape");
  SurfaceMesh mesh = card_of(scene.body.shape).make(scene, label, warnings);
  check_mesh(mesh, label);
  if (!scene.body.mesh.empty()) check_crossings(mesh, label, warnings);
  return mesh;
}

}  // namespace palpate
