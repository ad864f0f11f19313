// Superellipsoid (Barr 1981): from a rounded box through the ellipsoid to a rounded double cone.
#include <cmath>

#include "config/body/body_card.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

constexpr CardKey kKeys[] = {{"half_axes_mm", "half axes along x, y, z"},
                             {"e1", "squareness seen from the side: 0.2 box, 1 round, 1.8 pointed"},
                             {"e2", "squareness seen from above, likewise"},
                             {"triangles", "about this many"}};

// ((|x|/a)^(2/e2) + (|z|/c)^(2/e2))^(e2/e1) + (|y|/b)^(2/e1) = 1. The left side grows with the (2/e1)th power along a
// ray from the centre, so every direction of a sphere's mesh meets the surface once: closed, and star-shaped.
SurfaceMesh make(const SceneDesc& scene, std::string&, std::vector<std::string>&) {
  const BodyDesc& body = scene.body;
  const Vec3 half = body.half_axes_m;
  const double e1 = body.e1, e2 = body.e2;
  SurfaceMesh mesh = make_ellipsoid({1, 1, 1}, body.triangles);
  for (Vec3& p : mesh.vertex_m) {
    const Vec3 u{p.x, p.y - 1, p.z};
    const auto power = [](double x, double exponent) { return x > 0 ? math::pow(x, exponent) : 0.0; };
    const double around = power(std::abs(u.x) / half.x, 2 / e2) + power(std::abs(u.z) / half.z, 2 / e2);
    const double value = power(around, e2 / e1) + power(std::abs(u.y) / half.y, 2 / e1);
    p = power(value, -0.5 * e1) * u + Vec3{0, half.y, 0};
  }
  const double lowest = bounds_of(mesh).lower_m.y;  // above 0 where no vertex of the sphere is its lowest point
  for (Vec3& p : mesh.vertex_m) p.y -= lowest;
  return mesh;
}

}  // namespace

extern const BodyCard superellipsoid_body;
const BodyCard superellipsoid_body{
    .meaning = "superellipsoid: box, ellipsoid or double cone with rounded edges", .keys = kKeys, .make = make};

}  // namespace palpate
