// Small vectors, rotations and poses. Vec3 and Quat are plain structs: State, records and images must be
// trivially copyable. There is no Eigen in rt_core (docs/decisions/0006-libraries-of-the-tick.md).
// Sums run in the written order, so every compiler gives the same bits.
#pragma once

#include <type_traits>

#include "rt_core/base.h"

namespace palpate {

struct Vec3 {
  Real x = 0, y = 0, z = 0;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

inline Vec3 operator+(Vec3 a, Vec3 b) PALPATE_RT { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) PALPATE_RT { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) PALPATE_RT { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(Real s, Vec3 a) PALPATE_RT { return {s * a.x, s * a.y, s * a.z}; }
inline Vec3 operator*(Vec3 a, Real s) PALPATE_RT { return s * a; }
inline Vec3& operator+=(Vec3& a, Vec3 b) PALPATE_RT { return a = a + b; }
inline Vec3& operator-=(Vec3& a, Vec3 b) PALPATE_RT { return a = a - b; }
inline Real dot(Vec3 a, Vec3 b) PALPATE_RT { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) PALPATE_RT {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Real squared_norm(Vec3 a) PALPATE_RT { return dot(a, a); }
// sqrt is correctly rounded by IEEE 754, hence the same everywhere; it compiles to one instruction.
inline Real square_root(Real x) PALPATE_RT { return __builtin_sqrt(x > 0 ? x : 0.0); }
inline Real norm(Vec3 a) PALPATE_RT { return square_root(squared_norm(a)); }
inline bool is_finite(Vec3 a) PALPATE_RT { return is_finite(a.x) && is_finite(a.y) && is_finite(a.z); }

// Unit vector along a, or `fallback` where a is too short (or not finite) to have a direction.
inline Vec3 unit_or(Vec3 a, Vec3 fallback) PALPATE_RT {
  const Real length = norm(a);
  return length > 1e-300 && length < kHuge ? (1.0 / length) * a : fallback;
}
// The same direction, no longer than `most`.
inline Vec3 shortened(Vec3 v, Real most) PALPATE_RT {
  const Real length = norm(v);
  return length > most ? (most / length) * v : v;
}
// Part of a that lies in the plane with unit normal n.
inline Vec3 tangential_part(Vec3 a, Vec3 n) PALPATE_RT { return a - dot(a, n) * n; }
// A coordinate axis well off unit vector n: where any tangent will do, the first step to one.
inline Vec3 axis_off(Vec3 n) PALPATE_RT { return abs_of(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}; }

// Unit quaternion (w, x, y, z), rotating tool or device coordinates into the world.
struct Quat {
  Real w = 1, x = 0, y = 0, z = 0;
  friend bool operator==(const Quat&, const Quat&) = default;
};

inline Quat operator*(Quat a, Quat b) PALPATE_RT {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
inline Quat conjugate(Quat q) PALPATE_RT { return {q.w, -q.x, -q.y, -q.z}; }
inline Vec3 rotate(Quat q, Vec3 v) PALPATE_RT {
  const Vec3 u{q.x, q.y, q.z};
  const Vec3 t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}
// Normalised q, or the identity where q has no usable length.
inline Quat normalised(Quat q) PALPATE_RT {
  const Real length = square_root(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(length > 1e-9 && length < kHuge)) return {};
  const Real s = 1.0 / length;
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}
// Rotation by a small vector r (radians): exact to third order, normalised; needs no sine.
inline Quat small_rotation(Vec3 r) PALPATE_RT {
  return normalised({1.0 - squared_norm(r) / 8.0, 0.5 * r.x, 0.5 * r.y, 0.5 * r.z});
}
// Rotation vector (radians) of a small relative rotation q: inverse of small_rotation to third order.
inline Vec3 small_rotation_vector(Quat q) PALPATE_RT {
  const Real s = q.w < 0 ? -2.0 : 2.0;
  return {s * q.x, s * q.y, s * q.z};
}
// Smallest rotation that carries unit vector a onto unit vector b; the identity when they are opposite.
inline Quat rotation_between(Vec3 a, Vec3 b) PALPATE_RT {
  const Vec3 c = cross(a, b);
  return normalised({1.0 + dot(a, b), c.x, c.y, c.z});
}

struct Pose {
  Vec3 position_m;
  Quat orientation;
  friend bool operator==(const Pose&, const Pose&) = default;
};

inline Vec3 transform(const Pose& pose, Vec3 point) PALPATE_RT {
  return pose.position_m + rotate(pose.orientation, point);
}
inline Vec3 inverse_transform(const Pose& pose, Vec3 point) PALPATE_RT {
  return rotate(conjugate(pose.orientation), point - pose.position_m);
}
inline Pose operator*(const Pose& a, const Pose& b) PALPATE_RT {
  return {transform(a, b.position_m), a.orientation * b.orientation};
}
// A pose as a matrix: half the work of a quaternion per point.
struct RigidFrame {
  Vec3 x, y, z, origin;  // columns of the rotation, and the origin
  explicit RigidFrame(const Pose& pose) PALPATE_RT : x(rotate(pose.orientation, {1, 0, 0})),
                                                     y(rotate(pose.orientation, {0, 1, 0})),
                                                     z(rotate(pose.orientation, {0, 0, 1})),
                                                     origin(pose.position_m) {}
};
inline Vec3 direction_out(const RigidFrame& frame, Vec3 d) PALPATE_RT {
  return d.x * frame.x + d.y * frame.y + d.z * frame.z;
}
inline Vec3 out_of(const RigidFrame& frame, Vec3 point) PALPATE_RT {
  return frame.origin + direction_out(frame, point);
}
inline Vec3 into(const RigidFrame& frame, Vec3 point_w) PALPATE_RT {
  const Vec3 d = point_w - frame.origin;
  return {dot(frame.x, d), dot(frame.y, d), dot(frame.z, d)};
}
inline bool is_finite(const Pose& p) PALPATE_RT {
  const Quat& q = p.orientation;
  return is_finite(p.position_m) && is_finite(q.w) && is_finite(q.x) && is_finite(q.y) && is_finite(q.z);
}

// Force and torque; the torque is about the point named where the wrench is declared.
struct Wrench {
  Vec3 force_N;
  Vec3 torque_Nm;
  friend bool operator==(const Wrench&, const Wrench&) = default;
};

static_assert(std::is_trivially_copyable_v<Pose> && std::is_trivially_copyable_v<Wrench>);

}  // namespace palpate
