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

SurfaceMesh surface(const SceneDesc& scene, std::string&, std::vector<std::string>& warnings) {
  if (scene.contact.backend == Backend::kElastic) {
    SurfaceMesh mesh = surface_of(make_clip_outline()).mesh;
    for (Vec3& p : mesh.vertex_m)
      if (is_of_seat(p)) p.y = -ClipShape{}.inner_m;
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
  const Vec3 out = unit_or({p.x, p.y, 0}, face);
  return dot(out, face) > 0 ? out : -out;
}

// The arms' outsides with their round ends, and the seat. Bent open, the arms stand off a tube between the two.
int part(Vec3 middle, Vec3 face) {
  const ClipShape shape;
  if (std::abs(face.z) > 0.5) return 0;
  if (is_of_seat(middle)) return 3;
  const double angle = math::atan2(std::abs(middle.x), -middle.y);
  const bool is_end = angle > kPi - shape.half_opening_rad,
             is_arm = angle > shape.half_foot_rad && !is_of_hollow(middle);
  return !is_end && !is_arm ? 0 : middle.x < 0 ? 1 : 2;
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
