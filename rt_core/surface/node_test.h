// Tests of the four children of a hierarchy node at once, in single precision rounded to the safe side.
#pragma once

#include "rt_core/model.h"

namespace palpate {

// Four lanes; gcc and clang map it to one SSE register, and to plain code where there is none.
using Float4 [[gnu::vector_size(16)]] = float;
using Mask4 [[gnu::vector_size(16)]] = int;

inline Float4 load4(const float (&lane)[4]) PALPATE_RT {
  Float4 v;
  __builtin_memcpy(&v, lane, sizeof v);
  return v;
}
inline Float4 splat4(float x) PALPATE_RT { return Float4{x, x, x, x}; }
inline Float4 max4(Float4 a, Float4 b) PALPATE_RT { return a > b ? a : b; }
inline Float4 abs4(Float4 a) PALPATE_RT { return max4(a, -a); }
// Bit k set where lane k of the mask is true.
inline unsigned lanes(Mask4 mask) PALPATE_RT {
#ifdef __SSE__
  Float4 bits;
  __builtin_memcpy(&bits, &mask, sizeof bits);
  return static_cast<unsigned>(__builtin_ia32_movmskps(bits));
#else
  unsigned bits = 0;
  for (int k = 0; k < 4; ++k) bits |= mask[k] != 0 ? 1u << k : 0u;  // bound: 4
  return bits;
#endif
}

// A query point in single precision: below and above the true coordinate, and an allowance for its rounding.
struct NodeQuery {
  Float4 below[3], above[3];
  Float4 rounding;
};

inline NodeQuery node_query(Vec3 p) PALPATE_RT {
  const Real coordinate[3] = {p.x, p.y, p.z};
  NodeQuery q;
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) {  // bound: 3
    const float rounded = static_cast<float>(coordinate[axis]);
    const float magnitude = rounded < 0 ? -rounded : rounded;
    const float ulp = magnitude * 0x1p-23f;  // at least one unit in the last place
    q.below[axis] = splat4(rounded - ulp);
    q.above[axis] = splat4(rounded + ulp);
    sum += magnitude;
  }
  q.rounding = splat4(1e-6f * sum);
  return q;
}

// Squared distance from the point to the four boxes; relative error of a lane below 2^-21, never more than that above
// the true value.
inline Float4 box_distance2(const BvhNode& node, const NodeQuery& q) PALPATE_RT {
  Float4 sum{};
  for (int axis = 0; axis < 3; ++axis) {  // bound: 3
    const Float4 under = load4(node.lower_m[axis]) - q.above[axis];
    const Float4 over = q.below[axis] - load4(node.upper_m[axis]);
    const Float4 gap = max4(max4(under, over), Float4{});
    sum += gap * gap;
  }
  return sum;
}

// Lanes whose normal cone proves that they hold no local minimum of the distance (Johnson & Cohen 2001). At a nearest
// point x the direction p - x is a positive combination of the normals around x, or of their opposites, so it lies in
// the double cone of any child that holds x. With m the box centre and r the child's radius about it, every x in the
// child has
//   |(p - x) x axis| >= |(p - m) x axis| - r   and   |(p - x) . axis| <= |(p - m) . axis| + r,
// so the child can go when the first exceeds tan(half-angle) times the second. Cost no longer grows as the mesh is
// refined: boxes alone admit a number of triangles proportional to distance / edge length.
// A zero axis makes the left side 0: never skipped.
inline Mask4 cone_excludes(const BvhNode& node, const NodeQuery& q) PALPATE_RT {
  Float4 v[3], a[3];
  for (int axis = 0; axis < 3; ++axis) {  // bound: 3
    v[axis] = q.above[axis] - 0.5f * (load4(node.upper_m[axis]) + load4(node.lower_m[axis]));
    a[axis] = load4(node.cone_axis[axis]);
  }
  const Float4 cx = v[1] * a[2] - v[2] * a[1];
  const Float4 cy = v[2] * a[0] - v[0] * a[2];
  const Float4 cz = v[0] * a[1] - v[1] * a[0];
  const Float4 along = abs4(v[0] * a[0] + v[1] * a[1] + v[2] * a[2]);
  const Float4 radius = load4(node.cone_radius_m) + q.rounding;
  const Float4 reach = radius + load4(node.cone_tangent) * (along + radius);
  return cx * cx + cy * cy + cz * cz > reach * reach;
}

}  // namespace palpate
