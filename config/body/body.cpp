#include "config/body/body.h"

#include "config/body/body_card.h"
#include "config/body/body_pose.h"
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
  throw ConfigError(label + ": the surface goes through itself at " + position_text(found.where_m) + ", triangle " +
                    std::to_string(found.first) + " (" + std::to_string(found.pairs) +
                    (found.pairs >= kMostCounted ? " or more" : "") +
                    " pairs of triangles cross): which side is inside is not defined there; unite the parts, or remove "
                    "the fold, in a mesh editor");
}

}  // namespace

SurfaceMesh make_body(const SceneDesc& scene, std::vector<std::string>& warnings) {
  std::string label = scene.source.where("body.shape");
  const BodyCard& card = card_of(scene.body.shape);
  SurfaceMesh mesh = card.make(scene, label, warnings);
  if (!card.own_tets) place(scene.body, mesh.vertex_m);  // whose tetrahedra are placed already
  if (scene.body.mesh.empty()) {
    check_mesh(mesh, label);
    return mesh;
  }
  try {
    check_mesh(mesh, label);
    check_crossings(mesh, label, warnings);
  } catch (const ConfigError& error) {
    throw ConfigError(std::string(error.what()) + "; `palpate mesh` repairs most such surfaces");
  }
  return mesh;
}

}  // namespace palpate
