// Cylinder, standing or lying.
#include <cmath>

#include "config/body/body_card.h"

namespace palpate {

namespace {

constexpr CardKey kKeys[] = {{"radius_mm", "radius"},
                             {"height_mm", "length along the axis"},
                             {"axis", "y standing, x lying"},
                             {"triangles", "about this many"}};

Refusal check(const BodyDesc& body) { return axis_other_than(body, BodyAxis::kZ); }

SurfaceMesh make(const SceneDesc& scene, std::string&, std::vector<std::string>&) {
  const BodyDesc& body = scene.body;
  SurfaceMesh mesh = make_cylinder(body.radius_m, body.height_m, body.triangles);
  if (body.axis == BodyAxis::kX)  // a turn about z, then onto the plane y = 0 over the origin
    for (Vec3& p : mesh.vertex_m) p = {p.y - 0.5 * body.height_m, body.radius_m - p.x, p.z};
  return mesh;
}

std::vector<AnchorPoint> anchors(const BodyDesc& body) { return cylinder_anchors(body.radius_m, body.height_m); }

Vec3 normal(const BodyDesc& body, Vec3 p, Vec3 face, double height_m) {
  const bool lying = body.axis == BodyAxis::kX;
  const Vec3 axis = lying ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  if (std::abs(dot(face, axis)) > 0.5) return dot(face, axis) > 0 ? axis : -axis;
  return unit_or(tangential_part(p - Vec3{0, lying ? 0.5 * height_m : 0.0, 0}, axis), face);
}

// A standing one is pressed on its flat face as a layer, otherwise on its side.
BodyCurvature curvature(const BodyDesc& body, bool layer) {
  return body.axis == BodyAxis::kX || !layer ? BodyCurvature{1 / body.radius_m, 0} : BodyCurvature{};
}

bool press(const BodyDesc& body, double, fem::PressBody& press) {
  if (body.axis != BodyAxis::kY) return false;
  press.outer_radius_m = body.radius_m;
  press.height_m = body.height_m;
  return true;
}
double layer_m(const BodyDesc& body) { return body.height_m; }

}  // namespace

extern const BodyCard cylinder_body;
const BodyCard cylinder_body{.meaning = "cylinder",
                             .keys = kKeys,
                             .check = check,
                             .make = make,
                             .anchors = anchors,
                             .normal = normal,
                             .curvature = curvature,
                             .press = press,
                             .layer_m = layer_m};

}  // namespace palpate
