#include "config/bake/bvh_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "config/bake/plane_clearance.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/ring.h"
#include "rt_core/surface/triangle.h"

namespace palpate {

namespace {

// Slivers are this many times longer than wide: their ring is too narrow for a ball that covers their length.
constexpr double kSliver = 8;
// Triangles of a ring that is dearer to look at than what planes prove; in an even mesh it has 13.
constexpr std::size_t kLargeRing = 20;

enum class Coverage { kNoRing, kPart, kWhole };

class Clearance {
 public:
  Clearance(std::span<const Vec3> vertex, BvhBuild& bvh) : vertex_(vertex), bvh_(bvh), disc_(bvh.node.size()) {
    Vec3 lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
    for (const Vec3& v : vertex) {
      lower = {std::min(lower.x, v.x), std::min(lower.y, v.y), std::min(lower.z, v.z)};
      upper = {std::max(upper.x, v.x), std::max(upper.y, v.y), std::max(upper.z, v.z)};
    }
    size_ = std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z});
    farthest_ = std::max(norm(lower), norm(upper));
    ring_.reserve(1 + 3 * kMaxFan);  // for_each_in_ring is real-time code: what it calls must not allocate
    // Children come after their parent, so going backwards every child is bounded before its parent.
    for (std::size_t n = bvh.node.size(); n-- > 0;)
      for (int k = 0; k < 4; ++k) bound_child(n, k);
  }

  // What of the triangle its ring certifies.
  Coverage measure(std::int32_t index) {
    Triangle& t = bvh_.triangle[static_cast<std::size_t>(index)];
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const Vec3 normal = cross(b - a, c - a);
    const double length = norm(normal);
    ring_.clear();
    ring_.push_back(index);
    const auto add = [this](std::int32_t i, std::int32_t) { ring_.push_back(i); };
    if (!(length > 0)) return Coverage::kWhole;  // none to certify
    if (!for_each_in_ring(bvh_.triangle.data(), index, add)) return Coverage::kNoRing;
    const Vec3 centroid = (1.0 / 3.0) * (a + b + c);
    const double reach2 =
        std::max({squared_norm(a - centroid), squared_norm(b - centroid), squared_norm(c - centroid)});
    double most_room2 = 0;
    double height = size_;
    for (int i = 0; i < kHeightsTried && most_room2 < reach2; ++i, height *= 0.5) {
      const float scale = static_cast<float>(height / length);
      const double clear = distance_off_ring(centroid + static_cast<double>(scale) * normal, kUsefulFactor * height);
      // A point at height h above the triangle and r off its centroid passes when r^2 / (height - h) is below twice
      // clear - height, so this is the r^2 that passes at half the height.
      const double room2 = (clear - height) * height;
      if (!(room2 > most_room2)) continue;
      most_room2 = room2;
      t.clear_scale_per_m = scale;
      t.clear_radius_m = static_cast<float>(kShrink * clear);
    }
    if (most_room2 > 0) t.ring_convex = ring_convexity(t);
    return most_room2 < reach2 ? Coverage::kPart : Coverage::kWhole;
  }

  // Of the triangle just measured.
  bool has_large_ring() const { return ring_.size() > kLargeRing; }
  bool has_convex_ring(std::int32_t index) const {
    return bvh_.triangle[static_cast<std::size_t>(index)].ring_convex > 0;
  }
  bool is_sliver(std::int32_t index) const {
    const Triangle& t = bvh_.triangle[static_cast<std::size_t>(index)];
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const double longest2 = std::max({squared_norm(b - a), squared_norm(c - b), squared_norm(a - c)});
    return longest2 > kSliver * norm(cross(b - a, c - a));
  }

 private:
  // A disc of half thickness `half_m` and radius `radius_m` about the box centre that holds the child.
  struct Disc {
    Vec3 centre, axis;
    double radius_m = 0, half_m = 0;
  };

  Vec3 corner(const Triangle& t, int k) const { return vertex_[static_cast<std::size_t>(t.vertex[k])]; }

  // Whether all vertices of the ring (ring_) lie in or below the plane of one of its triangles, up to the rounding of
  // coordinates, and that triangle is large enough for kSafeInset to keep features apart: the distance it keeps,
  // squared, against what rounding does to a squared distance.
  bool is_below(std::int32_t plane, double reach) const {
    const Triangle& f = bvh_.triangle[static_cast<std::size_t>(plane)];
    const Vec3 a = corner(f, 0), b = corner(f, 1), c = corner(f, 2), normal = cross(b - a, c - a);
    const double length = norm(normal), longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
    const double kept = kSafeInset * length / longest;  // length / longest: the least altitude
    if (!(kept * kept > 4e-14 * reach * (farthest_ + reach) + 1e-16 * kSafeInset)) return false;
    for (const std::int32_t i : ring_) {
      for (int k = 0; k < 3; ++k) {
        const double height = dot(corner(bvh_.triangle[static_cast<std::size_t>(i)], k) - a, normal) / length;
        if (!(height <= 1e-15 * farthest_)) return false;
      }
    }
    return true;
  }

  // Triangle::ring_convex of the triangle whose ring is listed.
  std::int32_t ring_convexity(const Triangle& t) const {
    const double reach = static_cast<double>(t.clear_radius_m);
    const auto below = [&](std::int32_t plane) { return is_below(plane, reach); };
    if (!below(ring_[0]) || !std::all_of(std::begin(t.adjacent), std::end(t.adjacent), below)) return 0;
    return std::all_of(ring_.begin(), ring_.end(), below) ? 2 : 1;
  }

  // First and last triangle under a child; leaves under a node are contiguous.
  std::array<std::int32_t, 2> extent(std::size_t n, int k) const {
    const auto end_child = [this](std::size_t node, bool last) {
      int found = -1;
      for (int i = 0; i < 4; ++i)
        if (bvh_.node[node].child[i] >= 0 || bvh_.node[node].count[i] > 0)
          if (last || found < 0) found = i;
      return found;
    };
    const auto descend = [&](bool last) {
      std::size_t node = n;
      int child = k;
      while (bvh_.node[node].child[child] >= 0) {
        node = static_cast<std::size_t>(bvh_.node[node].child[child]);
        child = end_child(node, last);
      }
      return ~bvh_.node[node].child[child] + (last ? bvh_.node[node].count[child] - 1 : 0);
    };
    return {descend(false), descend(true)};
  }

  void bound_child(std::size_t n, int k) {
    const BvhNode& node = bvh_.node[n];
    if (node.child[k] < 0 && node.count[k] == 0) return;
    const auto at = [k](const float(&lane)[3][4], int axis) { return static_cast<double>(lane[axis][k]); };
    Disc& disc = disc_[n][static_cast<std::size_t>(k)];
    disc.axis = unit_or({at(node.cone_axis, 0), at(node.cone_axis, 1), at(node.cone_axis, 2)}, {});
    if (disc.axis == Vec3{}) return;
    disc.centre = 0.5 * Vec3{at(node.lower_m, 0) + at(node.upper_m, 0), at(node.lower_m, 1) + at(node.upper_m, 1),
                             at(node.lower_m, 2) + at(node.upper_m, 2)};
    const auto [first, last] = extent(n, k);
    for (std::int32_t i = first; i <= last; ++i) {
      for (int c = 0; c < 3; ++c) {
        const Vec3 v = corner(bvh_.triangle[static_cast<std::size_t>(i)], c) - disc.centre;
        disc.half_m = std::max(disc.half_m, abs_of(dot(v, disc.axis)));
        disc.radius_m = std::max(disc.radius_m, norm(tangential_part(v, disc.axis)));
      }
    }
  }

  double child_distance2(std::size_t n, int k, Vec3 q) const {
    const BvhNode& node = bvh_.node[n];
    const double p[3] = {q.x, q.y, q.z};
    double box2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double gap = std::max({static_cast<double>(node.lower_m[axis][k]) - p[axis],
                                   p[axis] - static_cast<double>(node.upper_m[axis][k]), 0.0});
      box2 += gap * gap;
    }
    const Disc& disc = disc_[n][static_cast<std::size_t>(k)];
    if (disc.axis == Vec3{}) return box2;
    const Vec3 v = q - disc.centre;
    const double along = std::max(abs_of(dot(v, disc.axis)) - disc.half_m, 0.0);
    const double across = std::max(norm(tangential_part(v, disc.axis)) - disc.radius_m, 0.0);
    return std::max(box2, along * along + across * across);
  }

  // Distance of q from the surface outside the ring, or `limit` where it is farther.
  double distance_off_ring(Vec3 q, double limit) {
    best2_ = limit * limit;
    stack_.assign(1, {0.0, 0});
    while (!stack_.empty()) {
      const auto [distance2, n] = stack_.back();
      stack_.pop_back();
      if (distance2 < best2_) open(n, q);
    }
    return std::sqrt(best2_);
  }

  void open(std::size_t n, Vec3 q) {
    const BvhNode& node = bvh_.node[n];
    const std::size_t top = stack_.size();
    for (int k = 0; k < 4; ++k) {
      if (node.child[k] < 0 && node.count[k] == 0) continue;
      const double distance2 = child_distance2(n, k, q);
      if (!(distance2 < best2_)) continue;
      if (node.child[k] >= 0) {
        stack_.push_back({distance2, static_cast<std::size_t>(node.child[k])});
      } else {
        for (std::int32_t i = 0; i < node.count[k]; ++i) measure_from(q, ~node.child[k] + i);
      }
    }
    std::sort(stack_.begin() + static_cast<std::ptrdiff_t>(top), stack_.end(),
              [](const Pending& a, const Pending& b) { return a.distance2 > b.distance2; });
  }

  void measure_from(Vec3 q, std::int32_t index) {
    if (std::find(ring_.begin(), ring_.end(), index) != ring_.end()) return;
    const Triangle& t = bvh_.triangle[static_cast<std::size_t>(index)];
    const Vec3 closest = closest_on_triangle(q, corner(t, 0), corner(t, 1), corner(t, 2)).point;
    best2_ = std::min(best2_, squared_norm(q - closest));
  }

  struct Pending {
    double distance2;
    std::size_t node;
  };
  std::span<const Vec3> vertex_;
  BvhBuild& bvh_;
  std::vector<std::array<Disc, 4>> disc_;
  std::vector<std::int32_t> ring_;
  std::vector<Pending> stack_;
  double size_ = 0, farthest_ = 0, best2_ = 0;
};

}  // namespace

void measure_clearance(std::span<const Vec3> vertex_m, BvhBuild& bvh) {
  Clearance clearance(vertex_m, bvh);
  PlaneClearance planes(vertex_m, bvh);
  const auto triangles = static_cast<std::int32_t>(bvh.triangle.size());
  for (std::int32_t i = 0; i < triangles; ++i) {
    const Coverage by_ring = clearance.measure(i);
    // Near the corners of what bends one way the next triangles but one are too near for a ball, and below the planes:
    // a point 8 mm off a corner of the cylinder held by five fingers went through the hierarchy, 3,000 instructions for
    // 600 (2026-11-26). Where it bends both ways planes would leave what is nearest to a corner to the hierarchy.
    const bool is_part = by_ring == Coverage::kPart;
    const bool helps = clearance.has_large_ring() || (is_part && clearance.is_sliver(i)) ||
                       (is_part && clearance.has_convex_ring(i) && planes.bends_one_way(i));
    if (by_ring == Coverage::kNoRing || helps) planes.measure(i, by_ring != Coverage::kNoRing);
  }
}

}  // namespace palpate
