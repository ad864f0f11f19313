// Vectors and poses four at a time, by the operations of vec.h.
#pragma once

#include "rt_core/lanes.h"

namespace palpate {

inline Double4 length_of(const Vec3x4& v) PALPATE_RT { return square_root(dot(v, v)); }
inline Vec3x4 tangential_part(const Vec3x4& a, const Vec3x4& n) PALPATE_RT { return a - dot(a, n) * n; }

// As unit_or().
inline Vec3x4 unit_or(const Vec3x4& v, const Vec3x4& fallback) PALPATE_RT {
  const Double4 length = length_of(v);
  return where((length > splat4(1e-300)) & (length < splat4(kHuge)), (splat4(1.0) / length) * v, fallback);
}

struct Quat4 {
  Double4 w;
  Vec3x4 u;
};
struct Pose4 {
  Vec3x4 position_m;
  Quat4 orientation;
};

inline Vec3x4 rotate(const Quat4& q, const Vec3x4& v) PALPATE_RT {
  const Vec3x4 t = splat4(2.0) * cross(q.u, v);
  return v + q.w * t + cross(q.u, t);
}
inline Quat4 operator*(const Quat4& a, const Quat4& b) PALPATE_RT {
  const Vec3x4 &p = a.u, &q = b.u;
  return {a.w * b.w - p.x * q.x - p.y * q.y - p.z * q.z,
          {a.w * q.x + p.x * b.w + p.y * q.z - p.z * q.y, a.w * q.y - p.x * q.z + p.y * b.w + p.z * q.x,
           a.w * q.z + p.x * q.y - p.y * q.x + p.z * b.w}};
}
inline Quat4 conjugate(const Quat4& q) PALPATE_RT { return {q.w, {-q.u.x, -q.u.y, -q.u.z}}; }
inline Vec3x4 transform(const Pose4& pose, const Vec3x4& point) PALPATE_RT {
  return pose.position_m + rotate(pose.orientation, point);
}
inline Vec3x4 inverse_transform(const Pose4& pose, const Vec3x4& point) PALPATE_RT {
  return rotate(conjugate(pose.orientation), point - pose.position_m);
}

inline Pose4 splat4(const Pose& pose) PALPATE_RT {
  const Quat& q = pose.orientation;
  return {splat4(pose.position_m), {splat4(q.w), splat4(Vec3{q.x, q.y, q.z})}};
}
inline Pose4 side_by_side(const Pose& a, const Pose& b, const Pose& c, const Pose& d) PALPATE_RT {
  const Quat &qa = a.orientation, &qb = b.orientation, &qc = c.orientation, &qd = d.orientation;
  return {side_by_side(a.position_m, b.position_m, c.position_m, d.position_m),
          {Double4{qa.w, qb.w, qc.w, qd.w},
           {Double4{qa.x, qb.x, qc.x, qd.x}, Double4{qa.y, qb.y, qc.y, qd.y}, Double4{qa.z, qb.z, qc.z, qd.z}}}};
}

}  // namespace palpate
