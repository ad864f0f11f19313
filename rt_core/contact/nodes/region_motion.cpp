#include "rt_core/contact/nodes/region_motion.h"

#include "rt_core/cholesky.h"

namespace palpate {

// Minimises sum |u - t - r x (x - c)|^2: with d = x - c, (sum d.d 1 - d d^T) r = sum d x u.
RegionMotion MotionFit::result(double blur_m, double share) const PALPATE_RT {
  RegionMotion motion;
  if (!(count_ > 0)) return motion;
  const Vec3 mean = (1 / count_) * position_;
  motion.centre_w = origin_ + mean;
  motion.translation_m = (share / count_) * displacement_;
  const Vec3 moment = moment_ - cross(mean, displacement_);
  const double xx = square_[0] - count_ * mean.x * mean.x, xy = square_[1] - count_ * mean.x * mean.y,
               xz = square_[2] - count_ * mean.x * mean.z, yy = square_[3] - count_ * mean.y * mean.y,
               yz = square_[4] - count_ * mean.y * mean.z, zz = square_[5] - count_ * mean.z * mean.z;
  const double blur = count_ * blur_m * blur_m;
  Real matrix[9] = {yy + zz + blur, -xy, -xz, -xy, xx + zz + blur, -yz, -xz, -yz, xx + yy + blur};
  Real x[3] = {moment.x, moment.y, moment.z};
  if (!cholesky_factor(matrix, 3)) return motion;
  cholesky_solve(matrix, x, 3);
  const Vec3 rotation{share * x[0], share * x[1], share * x[2]};
  constexpr Real kMost_rad = 0.5;  // beyond it no linear body is meant
  const Real size = norm(rotation);
  motion.rotation_rad = size > kMost_rad ? (kMost_rad / size) * rotation : rotation;
  return motion;
}

}  // namespace palpate
