#include "rt_core/tool/carrier_frames.h"

#include "rt_core/tool/pose_lanes.h"

namespace palpate {

void CarrierFrames::place(const Pose& tool_w, const Pose* motion_tool, std::int32_t pieces) PALPATE_RT {
  const Pose4 tool = splat4(tool_w);
  for (std::int32_t i = 0; 4 * i < pieces; ++i) {  // bound: kMaxPieces / 4
    const auto motion = [&](std::int32_t k)
                            PALPATE_RT -> const Pose& { return motion_tool[4 * i + k < pieces ? 4 * i + k : 4 * i]; };
    const Pose4 moved = side_by_side(motion(0), motion(1), motion(2), motion(3));
    origin_[i] = transform(tool, moved.position_m);
    const Quat4 turned = tool.orientation * moved.orientation;
    x_[i] = rotate(turned, splat4(Vec3{1, 0, 0}));
    y_[i] = rotate(turned, splat4(Vec3{0, 1, 0}));
    z_[i] = rotate(turned, splat4(Vec3{0, 0, 1}));
  }
}

RigidFrame CarrierFrames::of(std::int32_t piece) const PALPATE_RT {
  const std::int32_t i = piece / 4;
  const auto k = static_cast<std::uint32_t>(piece % 4);
  RigidFrame frame{Pose{}};
  frame.x = x_[i][k];
  frame.y = y_[i][k];
  frame.z = z_[i][k];
  frame.origin = origin_[i][k];
  return frame;
}

}  // namespace palpate
