#include "config/body/body_pose.h"

#include "config/bake/tool_points.h"

namespace palpate {

bool is_moved(const BodyDesc& body) { return !(body.position_m == Vec3{} && body.rotation_rad == Vec3{}); }

Pose body_pose(const BodyDesc& body) { return {body.position_m, rotation_of(body.rotation_rad)}; }

void place(const BodyDesc& body, std::vector<Vec3>& point_m) {
  if (!is_moved(body)) return;
  const Pose pose = body_pose(body);
  for (Vec3& p : point_m) p = transform(pose, p);
}

void take_back(const BodyDesc& body, std::vector<Vec3>& point_m) {
  if (!is_moved(body)) return;
  const Pose pose = body_pose(body);
  for (Vec3& p : point_m) p = inverse_transform(pose, p);
}

}  // namespace palpate
