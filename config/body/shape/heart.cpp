// Heart.
#include "config/body/body_card.h"

namespace palpate {

namespace {

constexpr CardKey kKeys[] = {{"width_mm", "width along x; it is about as high"}, {"triangles", "about this many"}};

SurfaceMesh make(const SceneDesc& scene, std::string&, std::vector<std::string>&) {
  return make_heart(scene.body.width_m, scene.body.triangles);
}

}  // namespace

extern const BodyCard heart_body;
const BodyCard heart_body{.meaning = "heart", .keys = kKeys, .make = make};

}  // namespace palpate
