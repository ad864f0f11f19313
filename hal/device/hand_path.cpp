#include "hal/device/hand_path.h"

#include <algorithm>
#include <cmath>

namespace palpate {

Vec3 rotation_vector(Quat q) noexcept {
  const double sign = q.w < 0 ? -1 : 1;  // the shorter way round
  const Vec3 axis{sign * q.x, sign * q.y, sign * q.z};
  const double sine = norm(axis);
  const double angle = 2 * std::atan2(sine, sign * q.w);
  return sine > 1e-12 ? (angle / sine) * axis : 2.0 * axis;
}

Quat rotation_by(Vec3 vector_rad) noexcept {
  const double angle = norm(vector_rad);
  const double scale = angle > 1e-12 ? std::sin(angle / 2) / angle : 0.5;
  return normalised({std::cos(angle / 2), scale * vector_rad.x, scale * vector_rad.y, scale * vector_rad.z});
}

HandPath::HandPath(std::vector<HandPose> poses) : poses_(std::move(poses)) {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const bool rises = i == 0 || poses_[i].time_s > poses_[i - 1].time_s;
    if (!is_finite(poses_[i].pose) || !is_finite(poses_[i].time_s) || !rises) {
      error_ =
          "hand path: pose " + std::to_string(i + 1) + (rises ? " is not finite" : " is not later than the one before");
      poses_.clear();
      return;
    }
    poses_[i].pose.orientation = normalised(poses_[i].pose.orientation);
  }
}

HandTarget HandPath::at(double time_s) const noexcept {
  if (poses_.empty()) return {};
  if (!(time_s > poses_.front().time_s)) return {poses_.front().pose, {}, {}, poses_.front().trigger};
  // Binary search: a motion repeated for hours has thousands of poses.
  const auto next = std::upper_bound(poses_.begin() + 1, poses_.end(), time_s,
                                     [](double time, const HandPose& pose) { return time < pose.time_s; });
  const HandPose& from = *(next - 1);
  if (next == poses_.end()) return {from.pose, {}, {}, from.trigger};
  const HandPose& to = *next;
  const double span_s = to.time_s - from.time_s;
  const double u = (time_s - from.time_s) / span_s;
  const double s = u * u * u * (10 + u * (-15 + 6 * u));
  const double rate = 30 * u * u * (1 - u) * (1 - u) / span_s;
  const Vec3 way = to.pose.position_m - from.pose.position_m;
  const Vec3 turn = rotation_vector(to.pose.orientation * conjugate(from.pose.orientation));
  return {{from.pose.position_m + s * way, rotation_by(s * turn) * from.pose.orientation},
          rate * way,
          rate * turn,
          from.trigger};
}

}  // namespace palpate
