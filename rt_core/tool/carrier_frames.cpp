#include "rt_core/tool/carrier_frames.h"

#include "rt_core/tool/pose_lanes.h"

namespace palpate {

namespace {

// One column of four frames that follow one another.
void put(const Vec3x4& column, RigidLanes* frame, Double4 RigidLanes::*of) PALPATE_RT {
  Double4 row[4] = {column.x, column.y, column.z, Double4{}};
  transpose(row);
  for (int k = 0; k < 4; ++k) frame[k].*of = row[k];  // bound: 4
}

}  // namespace

void CarrierFrames::place(const Pose& tool_w, const Pose* motion_tool, std::int32_t pieces) PALPATE_RT {
  const Pose4 tool = splat4(tool_w);
  for (std::int32_t i = 0; 4 * i < pieces; ++i) {  // bound: kMaxPieces / 4
    const auto motion = [&](std::int32_t k)
                            PALPATE_RT -> const Pose& { return motion_tool[4 * i + k < pieces ? 4 * i + k : 4 * i]; };
    const Pose4 moved = side_by_side(motion(0), motion(1), motion(2), motion(3));
    const Quat4 turned = tool.orientation * moved.orientation;
    RigidLanes* const frame = frame_ + 4 * i;
    put(transform(tool, moved.position_m), frame, &RigidLanes::origin);
    put(rotate(turned, splat4(Vec3{1, 0, 0})), frame, &RigidLanes::x);
    put(rotate(turned, splat4(Vec3{0, 1, 0})), frame, &RigidLanes::y);
    put(rotate(turned, splat4(Vec3{0, 0, 1})), frame, &RigidLanes::z);
  }
}

}  // namespace palpate
