// Pipe clip of 10 mm, open towards +y (Duriez et al. 2003).
#include <cmath>

#include "config/bake/fem_body.h"
#include "config/body/body_card.h"
#include "config/fem/tet_procedural.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

TetMesh tets(const SceneDesc& scene, std::vector<std::string>&) { return make_clip_mesh(scene.fem.level); }
Supports supports(const TetMesh& mesh) { return clip_supports(mesh); }

// Where a tube that fills the hollow stands on its bottom: so wide, and flat. On the hollow's own circle, as wide as
// the tube, any place would be as good as another.
constexpr double kSeat_rad = 5 * kPi / 180;
bool is_of_hollow(Vec3 p) {
  const ClipShape shape;
  return norm(Vec3{p.x, p.y, 0}) < shape.inner_m + 0.1 * shape.thickness_m;
}
bool is_of_seat(Vec3 p) {
  return is_of_hollow(p) && p.y < 0 && std::abs(p.x) < 1.001 * ClipShape{}.inner_m * math::sin(kSeat_rad);
}
// Where one that is pushed aside meets an arm's inside: as wide and flat, with some play, so that none is met before
// the seat.
constexpr double kPlay_m = 0.15e-3;
bool is_of_pad(Vec3 p) { return is_of_hollow(p) && std::abs(p.y) < ClipShape{}.inner_m * math::sin(kSeat_rad); }
bool is_on_pad(Vec3 p) { return is_of_pad(p) && std::abs(p.x) > ClipShape{}.inner_m + 0.99 * kPlay_m; }

SurfaceMesh surface(const SceneDesc& scene, std::string&, std::vector<std::string>& warnings) {
  if (scene.contact.backend == Backend::kElastic) {
    SurfaceMesh mesh = surface_of(make_clip_outline()).mesh;
    for (Vec3& p : mesh.vertex_m) {
      if (is_of_seat(p)) p.y = -ClipShape{}.inner_m;
      if (is_of_pad(p)) p.x = (p.x < 0 ? -1 : 1) * (ClipShape{}.inner_m + kPlay_m);
    }
    return mesh;
  }
  return surface_of(make_tet_mesh(scene, warnings)).mesh;
}

// Of its circles. From faces of 15 degrees around the arms' tips they were off, and what slides there felt each.
Vec3 normal(const BodyDesc&, Vec3 p, Vec3 face, double) {
  const ClipShape shape;
  if (std::abs(face.z) > 0.5) return {0, 0, face.z > 0 ? 1.0 : -1.0};
  const double middle = shape.inner_m + 0.5 * shape.thickness_m;
  const Vec3 tip{(p.x < 0 ? -middle : middle) * math::sin(shape.half_opening_rad),
                 middle * math::cos(shape.half_opening_rad), p.z};
  const Vec3 arm_end{(p.x < 0 ? -1.0 : 1.0) * math::cos(shape.half_opening_rad), -math::sin(shape.half_opening_rad), 0};
  if (dot(p - tip, arm_end) < 0) return unit_or(p - tip, face);
  if (is_of_seat(p)) return {0, 1, 0};
  if (is_on_pad(p)) return {p.x < 0 ? 1.0 : -1.0, 0, 0};
  const Vec3 out = unit_or({p.x, p.y, 0}, face);
  return dot(out, face) > 0 ? out : -out;
}

// Either arm's outside with its round end and its half of the foot, the seat, either arm's inside, and the flanks.
// Bent open, the ends stand off a tube between the two.
int part(Vec3 middle, Vec3 face) {
  const ClipShape shape;
  if (std::abs(face.z) > 0.5) return face.z > 0 ? 6 : 7;
  if (is_of_seat(middle)) return 3;
  if (is_on_pad(middle)) return middle.x < 0 ? 4 : 5;
  const bool is_end = math::atan2(std::abs(middle.x), -middle.y) > kPi - shape.half_opening_rad;
  if (is_of_hollow(middle) && !is_end) return 0;
  return middle.x < 0 ? 1 : 2;
}

}  // namespace

extern const BodyCard clip_body;
const BodyCard clip_body{.meaning = "pipe clip of 10 mm, open towards +y (Duriez et al. 2003)",
                         .keys = {},
                         .make = surface,
                         .normal = normal,
                         .part = part,
                         .tets = tets,
                         .own_tets = true,
                         .supports = supports};

}  // namespace palpate
