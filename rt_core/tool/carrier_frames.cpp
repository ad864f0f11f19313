#include "rt_core/tool/carrier_frames.h"

namespace palpate {

namespace {

struct Quat4 {
  Double4 w;
  Vec3x4 u;
};

// As of vec.h.
Vec3x4 rotate(const Quat4& q, const Vec3x4& v) PALPATE_RT {
  const Vec3x4 t = splat4(2.0) * cross(q.u, v);
  return v + q.w * t + cross(q.u, t);
}
Quat4 operator*(const Quat4& a, const Quat4& b) PALPATE_RT {
  const Vec3x4 &p = a.u, &q = b.u;
  return {a.w * b.w - p.x * q.x - p.y * q.y - p.z * q.z,
          {a.w * q.x + p.x * b.w + p.y * q.z - p.z * q.y, a.w * q.y - p.x * q.z + p.y * b.w + p.z * q.x,
           a.w * q.z + p.x * q.y - p.y * q.x + p.z * b.w}};
}

}  // namespace

void CarrierFrames::place(const Pose& tool_w, const Pose* motion_tool, std::int32_t pieces) PALPATE_RT {
  const Quat& q = tool_w.orientation;
  const Quat4 tool{splat4(q.w), splat4(Vec3{q.x, q.y, q.z})};
  for (std::int32_t i = 0; 4 * i < pieces; ++i) {  // bound: kMaxPieces / 4
    const auto motion = [&](std::int32_t k)
                            PALPATE_RT -> const Pose& { return motion_tool[4 * i + k < pieces ? 4 * i + k : 4 * i]; };
    const Pose &a = motion(0), &b = motion(1), &c = motion(2), &d = motion(3);
    const Quat qa = a.orientation, qb = b.orientation, qc = c.orientation, qd = d.orientation;
    const Vec3x4 position = side_by_side(a.position_m, b.position_m, c.position_m, d.position_m);
    const Quat4 turn{
        Double4{qa.w, qb.w, qc.w, qd.w},
        {Double4{qa.x, qb.x, qc.x, qd.x}, Double4{qa.y, qb.y, qc.y, qd.y}, Double4{qa.z, qb.z, qc.z, qd.z}}};
    origin_[i] = splat4(tool_w.position_m) + rotate(tool, position);
    const Quat4 turned = tool * turn;
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
