// Ellipsoid and sphere.
#include "config/body/body_card.h"

namespace palpate {

namespace {

constexpr CardKey kEllipsoidKeys[] = {
    {"half_axes_mm", "half axes along x, y, z"}, {"triangles", "about this many"}, {"pattern", "of the triangles"}};
constexpr CardKey kSphereKeys[] = {
    {"radius_mm", "radius"}, {"triangles", "about this many"}, {"pattern", "of the triangles"}};

Vec3 axes_of(const BodyDesc& b) {
  return b.shape == BodyShape::kSphere ? Vec3{b.radius_m, b.radius_m, b.radius_m} : b.half_axes_m;
}

SurfaceMesh make(const SceneDesc& scene, std::string&, std::vector<std::string>&) {
  return make_ellipsoid(axes_of(scene.body), scene.body.triangles, scene.body.pattern);
}

std::vector<AnchorPoint> anchors(const BodyDesc& body) { return axis_end_anchors(axes_of(body)); }

Vec3 ellipsoid_normal(const BodyDesc& body, Vec3 p, Vec3 face, double) {
  const Vec3 h = body.half_axes_m;
  return unit_or(out_of_ellipsoid(h, p - Vec3{0, h.y, 0}), face);
}
Vec3 sphere_normal(const BodyDesc& body, Vec3 p, Vec3 face, double) {
  return unit_or(p - Vec3{0, body.radius_m, 0}, face);
}

BodyCurvature curvature(const BodyDesc& body, bool) { return {1 / body.radius_m, 1 / body.radius_m}; }

// Of revolution about y alone.
bool press(const BodyDesc& body, double base_m, fem::PressBody& press) {
  const Vec3 half = axes_of(body);
  if (half.x != half.z) return false;
  press.kind = fem::PressBody::Kind::kEllipsoid;
  press.outer_radius_m = half.x;
  press.height_m = half.y;
  press.fixed_below_m = base_m - half.y;
  return true;
}

}  // namespace

extern const BodyCard ellipsoid_body, sphere_body;
const BodyCard ellipsoid_body{.meaning = "ellipsoid",
                              .keys = kEllipsoidKeys,
                              .make = make,
                              .anchors = anchors,
                              .normal = ellipsoid_normal,
                              .press = press};
const BodyCard sphere_body{.meaning = "sphere",
                           .keys = kSphereKeys,
                           .make = make,
                           .anchors = anchors,
                           .normal = sphere_normal,
                           .curvature = curvature,
                           .press = press};

}  // namespace palpate
