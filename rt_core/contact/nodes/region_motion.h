// The far field at a contact region: the rigid motion of the surface around it. Gaps and normals are taken where it has
// carried the nodes, never on their own dents.
#pragma once

#include "rt_core/lanes.h"
#include "rt_core/state.h"

namespace palpate {

// Of four rest points, `arm` away from the centre.
inline Vec3x4 carry_at(const RegionMotion& motion, const Vec3x4& arm) PALPATE_RT {
  return splat4(motion.translation_m) + cross(splat4(motion.rotation_rad), arm);
}

// What finite rotation adds to the linear motion, to second order. A body that turns by r about a root at -d under a
// force f, held by a spring k: its end moves by t = r x d and, because it turns, by r x t / 2; and the force's lever
// changes with the turn, which makes k into k + f . d and all the motion grow by -f . d / k = f . (r x t) / (f . t).
// Both follow from the complementary energy f . t / 2 + f . (r x t) / 2. An arm that bends instead has 0.8 of the first
// for a load at its end, 2/3 when bent evenly.
inline Vec3x4 bend_of(const RegionMotion& motion, const Vec3x4& carry) PALPATE_RT {
  const Vec3x4 turned = cross(splat4(motion.rotation_rad), carry);
  return splat4(motion.finite) * (splat4(0.5) * turned + splat4(motion.growth) * carry);
}
// The growth under a force on the body. Beyond this no linear body is meant: a clip on its tube needs 0.2.
inline constexpr double kMostGrowth = 0.25;
inline double growth_under(const RegionMotion& motion, Vec3 force_N) PALPATE_RT {
  const double work = dot(force_N, motion.translation_m);
  const double turned = dot(force_N, cross(motion.rotation_rad, motion.translation_m));
  return work > 0 ? clamp_to(turned / work, -kMostGrowth, kMostGrowth) : 0;
}

// Least-squares rigid motion of displaced points, small rotations. Directions in which the points lie closer together
// than `blur_m` say nothing about rotation: it is left zero there.
class MotionFit {
 public:
  void add(Vec3 rest_w, Vec3 displacement_m) PALPATE_RT {
    if (count_ == 0) origin_ = rest_w;
    const Vec3 x = rest_w - origin_;
    count_ += 1;
    position_ += x;
    displacement_ += displacement_m;
    moment_ += cross(x, displacement_m);
    const double products[6] = {x.x * x.x, x.x * x.y, x.x * x.z, x.y * x.y, x.y * x.z, x.z * x.z};
    for (int k = 0; k < 6; ++k) square_[k] += products[k];  // bound: 6
  }
  // Scaled by `share`. Bound: constant.
  RegionMotion result(double blur_m, double share) const PALPATE_RT;
  double count() const PALPATE_RT { return count_; }

 private:
  // Sums about the first point, for accuracy.
  double count_ = 0;
  Vec3 origin_, position_, displacement_, moment_;
  double square_[6] = {};  // xx xy xz yy yz zz
};

}  // namespace palpate
