// The far field at a contact region: the rigid motion of the surface around it. Gaps and normals are taken where it has
// carried the nodes, never on their own dents.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

struct RegionMotion {
  Vec3 centre_w;  // mean rest position of the nodes it was fitted to
  Vec3 translation_m;
  Vec3 rotation_rad;
  double reach_m = 0;  // rest points farther from the centre are not carried
};

inline Vec3 carry_at(const RegionMotion& motion, Vec3 rest_w) PALPATE_RT {
  return motion.translation_m + cross(motion.rotation_rad, rest_w - motion.centre_w);
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
