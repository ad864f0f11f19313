// What the scene compiler proved about a triangle's surroundings, packed into Triangle::ring_convex.
//   0, 1, 2  of its ring: see Triangle
//   bits 0-1 both set: by planes. No surface but what lies in or below the planes of the triangle and of its three
//            neighbours is nearer to the clearance point than the clearance: a point over the triangle, in the ball,
//            has its nearest place there, whatever its ring is like
//   bits 2-4 then: the triangles about this corner all lie in one plane, the triangle's
//   bits 5-6 then: 1 + the corner about which most triangles meet in a plane across an axis to the bit, or 0 ...
//   bits 7-  ... and the lowest index of those
#pragma once

#include "rt_core/model.h"

namespace palpate::ring_proof {

inline constexpr std::int32_t kByPlanes = 3, kFirstCorner = 2, kHub = 5, kFirstIndex = 7;
// Higher ones are not packed.
inline constexpr std::int32_t kMostIndex = (1 << 24) - 1;

inline bool is_by_planes(const Triangle& t) PALPATE_RT { return (t.ring_convex & kByPlanes) == kByPlanes; }
inline bool is_flat_about(const Triangle& t, int corner) PALPATE_RT {
  return ((t.ring_convex >> (kFirstCorner + corner)) & 1) != 0;
}
// -1: none.
inline int hub_corner(const Triangle& t) PALPATE_RT { return ((t.ring_convex >> kHub) & 3) - 1; }
inline std::int32_t lowest_about_hub(const Triangle& t) PALPATE_RT { return t.ring_convex >> kFirstIndex; }

}  // namespace palpate::ring_proof
