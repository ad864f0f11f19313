#include "config/body/body.h"

#include "config/body/body_card.h"

namespace palpate {

SurfaceMesh make_body(const SceneDesc& scene, std::vector<std::string>& warnings) {
  std::string label = scene.source.where("body.shape");
  SurfaceMesh mesh = card_of(scene.body.shape).make(scene, label, warnings);
  check_mesh(mesh, label);
  return mesh;
}

}  // namespace palpate
