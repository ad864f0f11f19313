// Bodies with a hole: half shell, ring, hollow cylinder.
#include <algorithm>
#include <cmath>

#include "config/body/body_card.h"
#include "rt_core/math.h"

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

// Normals of the mesh's facets, weighted by their angles, are up to 3 mrad off about a dome's pole, where a rod that
// stood still swung between the triangles by 31 mN of 10 N (2026-11-26).
constexpr double kFlat = 0.9;  // of a flat face, along the axis

// Outer and inner ellipsoid about the rim's centre, and the rim.
Vec3 shell_normal(const BodyDesc& body, Vec3 p, Vec3 face, double) {
  constexpr double kRim_m = 1e-9;
  if (p.y < kRim_m && face.y < -kFlat) return {0, -1, 0};
  const Vec3 outer = body.half_axes_m, out = out_of_ellipsoid(outer, p);
  if (dot(out, face) > 0) return unit_or(out, face);
  return unit_or(-out_of_ellipsoid(outer - Vec3{body.wall_m, body.wall_m, body.wall_m}, p), face);
}

// It lies or stands on the plane y = 0: from its middle, and off its axis.
struct RoundPlace {
  Vec3 axis, from_middle, radial;
};
RoundPlace about_axis(const BodyDesc& body, Vec3 p, double height_m) {
  const Vec3 axis = body.axis == BodyAxis::kZ ? Vec3{0, 0, 1} : Vec3{0, 1, 0}, from = p - Vec3{0, 0.5 * height_m, 0};
  return {axis, from, tangential_part(from, axis)};
}

Vec3 ring_normal(const BodyDesc& body, Vec3 p, Vec3 face, double height_m) {
  const RoundPlace about = about_axis(body, p, height_m);
  return unit_or(about.from_middle - (body.radius_m - 0.5 * body.wall_m) * unit_or(about.radial, {}), face);
}

Vec3 tube_normal(const BodyDesc& body, Vec3 p, Vec3 face, double height_m) {
  const RoundPlace about = about_axis(body, p, height_m);
  const double end = dot(face, about.axis);
  if (std::abs(end) > kFlat) return end > 0 ? about.axis : -about.axis;
  return unit_or(dot(about.radial, face) > 0 ? about.radial : -about.radial, face);
}

}  // namespace

extern const BodyCard half_shell_body, ring_body, hollow_cylinder_body;
const BodyCard half_shell_body{.meaning = "dome open below",
                               .keys = kShellKeys,
                               .check = check_shell,
                               .make = shell,
                               .anchors = half_shell_anchors,
                               .normal = shell_normal};
const BodyCard ring_body{.meaning = "torus",
                         .keys = kRingKeys,
                         .check = check_round,
                         .make = ring,
                         .anchors = ring_anchors,
                         .normal = ring_normal};
const BodyCard hollow_cylinder_body{.meaning = "tube",
                                    .keys = kCylinderKeys,
                                    .check = check_round,
                                    .make = hollow_cylinder,
                                    .anchors = hollow_cylinder_anchors,
                                    .normal = tube_normal};

}  // namespace palpate
