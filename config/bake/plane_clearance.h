// Bakes the clearance certificates of triangles whose ring gives none: needles of a fan, slivers of a flat face.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/bake/bvh_build.h"

namespace palpate {

// How clearances are looked for, by a triangle's ring and by planes: so many heights, each half the last ...
inline constexpr int kHeightsTried = 8;
// ... a distance beyond this multiple of the height gains nothing ...
inline constexpr double kUsefulFactor = 1.5;
// ... and what was found is shrunk by this much, which covers its rounding to single precision.
inline constexpr double kShrink = 1 - 1.5e-7;

// A triangle is certified by planes (ring_proof.h) when whatever rises above its own plane or that of a neighbour
// across an edge is as far off as Triangle::clear_radius_m tells. What lies below all four is as near as the triangle
// to no point that stands over it.
class PlaneClearance {
 public:
  PlaneClearance(std::span<const Vec3> vertex, BvhBuild& bvh);
  // Triangle::clear_* and ring_convex of a triangle, left as they are where planes prove no more. `only_whole`: only
  // where all of the triangle is certified.
  void measure(std::int32_t index, bool only_whole);
  // Whether the surface about each of its corners bends, and one way alone, as a cylinder: over none of them is room
  // for a point that is nearest to the corner itself, which planes leave to the hierarchy.
  bool bends_one_way(std::int32_t index);

 private:
  struct Plane {
    Vec3 point, normal;
  };
  // Of a child of a node, not rounded.
  struct Bounds {
    Vec3 lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  };
  // What is known of the triangles about a vertex.
  struct Fan {
    bool known = false, flat = false, bends_one_way = false;
    std::int32_t triangles = 0;
    std::int32_t lowest = -1;  // of a fan in one plane across an axis, to the bit: its first triangle
  };

  Vec3 corner(const Triangle& t, int k) const { return vertex_[static_cast<std::size_t>(t.vertex[k])]; }
  Plane plane_of(std::int32_t index) const;
  double kept_m(std::int32_t index) const;
  bool list_planes(std::int32_t index);
  bool is_below(Vec3 p) const;
  bool is_all_below(std::size_t node, int child) const;
  double distance_above(Vec3 q, double limit);
  void open(std::size_t node, Vec3 q);
  const Fan& fan_about(std::int32_t index, int corner);
  Fan look_about(std::int32_t index, int corner) const;
  bool is_flat(std::span<const std::int32_t> fan, std::int32_t middle) const;
  bool is_bent_one_way(std::span<const std::int32_t> fan) const;

  std::span<const Vec3> vertex_;
  BvhBuild& bvh_;
  std::vector<Bounds> bounds_;  // four a node
  std::vector<Fan> fan_;        // about every vertex
  std::vector<Plane> plane_;
  std::vector<std::pair<double, std::size_t>> stack_;
  double size_ = 0, farthest_ = 0, in_plane_m_ = 0, best2_ = 0;
  std::int64_t visits_left_;  // of nodes, for all triangles together: a bake must end
};

}  // namespace palpate
