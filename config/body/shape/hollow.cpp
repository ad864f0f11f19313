// Bodies with a hole: half shell, ring, hollow cylinder.
#include <algorithm>

#include "config/body/body_card.h"

namespace palpate {

namespace {

constexpr CardKey kShellKeys[] = {
    {"half_axes_mm", "outer half axes; it stands on its rim"}, {"wall_mm", "wall"}, {"triangles", "about this many"}};
constexpr CardKey kRingKeys[] = {{"radius_mm", "outer radius"},
                                 {"wall_mm", "thickness of its round section"},
                                 {"axis", "y lying flat, z along z"},
                                 {"triangles", "about this many"}};
constexpr CardKey kCylinderKeys[] = {{"radius_mm", "outer radius"},
                                     {"height_mm", "length along the axis"},
                                     {"wall_mm", "wall"},
                                     {"axis", "y standing, z along z"},
                                     {"triangles", "about this many"}};

Refusal check_shell(const BodyDesc& b) {
  return wall_within(b, std::min({b.half_axes_m.x, b.half_axes_m.y, b.half_axes_m.z}));
}
Refusal check_round(const BodyDesc& b) {
  const Refusal axis = axis_other_than(b, BodyAxis::kX);
  return axis.key != nullptr ? axis : wall_within(b, b.radius_m);
}

SurfaceMesh shell(const SceneDesc& scene, std::string&, std::vector<std::string>&) {
  return make_half_shell(scene.body.half_axes_m, scene.body.wall_m, scene.body.triangles);
}
SurfaceMesh ring(const SceneDesc& scene, std::string&, std::vector<std::string>&) {
  const BodyDesc& b = scene.body;
  return make_ring(b.radius_m, b.wall_m, b.axis, b.triangles);
}
SurfaceMesh hollow_cylinder(const SceneDesc& scene, std::string&, std::vector<std::string>&) {
  const BodyDesc& b = scene.body;
  return make_hollow_cylinder(b.radius_m, b.wall_m, b.height_m, b.axis, b.triangles);
}

}  // namespace

extern const BodyCard half_shell_body, ring_body, hollow_cylinder_body;
const BodyCard half_shell_body{.meaning = "dome open below",
                               .keys = kShellKeys,
                               .check = check_shell,
                               .make = shell,
                               .anchors = half_shell_anchors};
const BodyCard ring_body{
    .meaning = "torus", .keys = kRingKeys, .check = check_round, .make = ring, .anchors = ring_anchors};
const BodyCard hollow_cylinder_body{.meaning = "tube",
                                    .keys = kCylinderKeys,
                                    .check = check_round,
                                    .make = hollow_cylinder,
                                    .anchors = hollow_cylinder_anchors};

}  // namespace palpate
