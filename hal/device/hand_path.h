// Where the simulated hand wants to be: poses at given times, joined by minimum-jerk motion (Flash & Hogan 1985), the
// way people reach from point to point.
#pragma once

#include <string>
#include <vector>

#include "rt_core/vec.h"

namespace palpate {

struct HandPose {
  double time_s = 0;
  Pose pose;
  bool trigger = false;  // held from this pose on: the device's closing button
};
struct HandTarget {
  Pose pose;
  Vec3 velocity_m_per_s;
  Vec3 spin_rad_per_s;
  bool trigger = false;
};

class HandPath {
 public:
  HandPath() = default;  // rests at the origin
  // Times must rise strictly and everything be finite; otherwise `error()` says which entry is wrong and the path
  // rests.
  explicit HandPath(std::vector<HandPose> poses);
  // At rest at each pose, before the first and after the last.
  HandTarget at(double time_s) const noexcept;
  double end_s() const noexcept { return poses_.empty() ? 0 : poses_.back().time_s; }
  const std::string& error() const noexcept { return error_; }

 private:
  std::vector<HandPose> poses_;
  std::string error_;
};

// Rotation vector (radians, at most pi) of a unit quaternion, and back.
Vec3 rotation_vector(Quat q) noexcept;
Quat rotation_by(Vec3 vector_rad) noexcept;

}  // namespace palpate
