#include "sim_host/view/displacement_angle.h"

#include "rt_core/math.h"

namespace palpate {

Vec3 displacement_by_angle(const PatchCorner (&corner)[3], Vec3 normal) {
  Real magnitude = 0;
  Real angle = 0;
  Real angle_weight = 0;
  Vec3 linear;
  for (const PatchCorner& c : corner) {
    linear += c.weight * c.displacement;
    const Real length = norm(c.displacement);
    if (!(length > 0)) continue;
    magnitude += c.weight * length;
    // atan2 keeps the digits that acos loses near 0 and 180 degrees, where pressed anchors are.
    angle += c.weight * math::atan2(norm(cross(c.displacement, c.normal)), dot(c.displacement, c.normal));
    angle_weight += c.weight;
  }
  const Vec3 tangent = tangential_part(linear, normal);
  const Real tangent_length = norm(tangent);
  if (!(angle_weight > 0 && tangent_length > 1e-12 * magnitude)) return linear;
  const Real theta = angle / angle_weight;
  return (magnitude * math::cos(theta)) * normal + (magnitude * math::sin(theta) / tangent_length) * tangent;
}

}  // namespace palpate
