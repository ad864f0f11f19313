// Pipe clip of 10 mm, open towards +y (Duriez et al. 2003).
#include "config/bake/fem_body.h"
#include "config/body/body_card.h"
#include "config/fem/tet_procedural.h"

namespace palpate {

namespace {

TetMesh tets(const SceneDesc& scene, std::vector<std::string>&) { return make_clip_mesh(scene.fem.level); }
Supports supports(const TetMesh& mesh) { return clip_supports(mesh); }
SurfaceMesh surface(const SceneDesc& scene, std::string&, std::vector<std::string>& warnings) {
  return surface_of(make_tet_mesh(scene, warnings)).mesh;
}

}  // namespace

extern const BodyCard clip_body;
const BodyCard clip_body{.meaning = "pipe clip of 10 mm, open towards +y (Duriez et al. 2003)",
                         .keys = {},
                         .make = surface,
                         .tets = tets,
                         .own_tets = true,
                         .supports = supports};

}  // namespace palpate
