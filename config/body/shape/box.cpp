// Box.
#include <algorithm>
#include <cmath>

#include "config/bake/fem_body.h"
#include "config/body/body_card.h"
#include "config/fem/tet_procedural.h"

namespace palpate {

namespace {

constexpr CardKey kKeys[] = {{"size_mm", "sides along x, y, z"}, {"triangles", "about this many"}};

SurfaceMesh make(const SceneDesc& scene, std::string&, std::vector<std::string>&) {
  return make_box(scene.body.size_m, scene.body.triangles);
}

std::vector<AnchorPoint> anchors(const BodyDesc& body) { return box_corner_anchors(body.size_m); }

BodyCurvature curvature(const BodyDesc&, bool) { return {}; }

bool press(const BodyDesc& body, double, fem::PressBody& press) {
  press.outer_radius_m = 0.5 * std::min(body.size_m.x, body.size_m.z);
  press.height_m = body.size_m.y;
  return true;
}
double layer_m(const BodyDesc& body) { return body.size_m.y; }

TetMesh tets(const SceneDesc& scene, std::vector<std::string>&) {
  const Vec3 size = scene.body.size_m;
  const double edge = tet_edge_m(scene, size);
  const auto cells = [&](double side) { return std::max(1, static_cast<std::int32_t>(std::lround(side / edge))); };
  return make_mirrored_box_tets(size, {cells(size.x), cells(size.y), cells(size.z)});
}

}  // namespace

extern const BodyCard box_body;
const BodyCard box_body{.meaning = "box",
                        .keys = kKeys,
                        .make = make,
                        .anchors = anchors,
                        .curvature = curvature,
                        .press = press,
                        .layer_m = layer_m,
                        .tets = tets};

}  // namespace palpate
