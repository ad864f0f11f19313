#include "config/bake/plane_clearance.h"

#include <algorithm>
#include <cmath>

#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/ring.h"
#include "rt_core/surface/ring_proof.h"
#include "rt_core/surface/triangle.h"

namespace palpate {

namespace {

// Normals of neighbours that turn farther, by 133 degrees, would let what is in one plane rise 2.5 times kInPlane above
// the edge's.
constexpr double kLeastCosine = -0.68;
// Of the longest spoke, what a fan leaves about its middle at least: a closest point that rounding may put on another
// of its triangles is within kSafeInset of it.
constexpr double kLeastFan = 10 * kSafeInset;
// In a plane, as a share of the farthest coordinate: what a needle's normal leaves of a flat face's other end, and so
// little that a point kSafeInset inside a triangle that passes kept_m() is not nearer to it.
constexpr double kInPlane = 4e-15;
// Length over width of a fan's triangles of which the lowest is noted.
constexpr double kMostSlender = 400;

double at(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
std::size_t slot(std::size_t node, int child) { return 4 * node + static_cast<std::size_t>(child); }

}  // namespace

PlaneClearance::PlaneClearance(std::span<const Vec3> vertex, BvhBuild& bvh)
    : vertex_(vertex),
      bvh_(bvh),
      bounds_(4 * bvh.node.size()),
      fan_(vertex.size()),
      visits_left_(8'000'000 + 32 * static_cast<std::int64_t>(bvh.triangle.size())) {
  const auto grow = [](Bounds& b, Vec3 low, Vec3 high) {
    b.lower = {std::min(b.lower.x, low.x), std::min(b.lower.y, low.y), std::min(b.lower.z, low.z)};
    b.upper = {std::max(b.upper.x, high.x), std::max(b.upper.y, high.y), std::max(b.upper.z, high.z)};
  };
  Bounds all;
  for (const Vec3& v : vertex) grow(all, v, v);
  const Vec3 size = all.upper - all.lower;
  size_ = std::max({size.x, size.y, size.z});
  farthest_ = std::max(norm(all.lower), norm(all.upper));
  in_plane_m_ = kInPlane * farthest_;
  // Children come after their parent, so going backwards every child is bounded before its parent.
  for (std::size_t n = bvh.node.size(); n-- > 0;) {
    for (int k = 0; k < 4; ++k) {
      Bounds& b = bounds_[slot(n, k)];
      const BvhNode& node = bvh.node[n];
      for (int i = 0; i < node.count[k]; ++i) {
        const Triangle& t = bvh.triangle[static_cast<std::size_t>(~node.child[k] + i)];
        for (int c = 0; c < 3; ++c) grow(b, corner(t, c), corner(t, c));
      }
      if (node.child[k] < 0) continue;
      for (int i = 0; i < 4; ++i) {
        const Bounds& under = bounds_[slot(static_cast<std::size_t>(node.child[k]), i)];
        if (under.lower.x <= under.upper.x) grow(b, under.lower, under.upper);
      }
    }
  }
}

PlaneClearance::Plane PlaneClearance::plane_of(std::int32_t index) const {
  const Triangle& t = bvh_.triangle[static_cast<std::size_t>(index)];
  const Vec3 a = corner(t, 0);
  return {a, unit_or(cross(corner(t, 1) - a, corner(t, 2) - a), {})};
}

// What a point kSafeInset inside the triangle keeps from its border, at least.
double PlaneClearance::kept_m(std::int32_t index) const {
  const Triangle& t = bvh_.triangle[static_cast<std::size_t>(index)];
  const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
  const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
  return longest > 0 ? kSafeInset * norm(cross(b - a, c - a)) / longest : 0.0;
}

// The planes of a triangle and of its neighbours, each once; false where they prove nothing.
bool PlaneClearance::list_planes(std::int32_t index) {
  const Triangle& t = bvh_.triangle[static_cast<std::size_t>(index)];
  plane_.assign(1, plane_of(index));
  for (const std::int32_t across : t.adjacent) {
    if (across < 0) return false;
    const Plane plane = plane_of(across);
    if (!(dot(plane.normal, plane_[0].normal) > kLeastCosine)) return false;
    plane_.push_back(plane);
  }
  return std::all_of(plane_.begin(), plane_.end(), [](const Plane& p) { return squared_norm(p.normal) > 0.5; });
}

bool PlaneClearance::is_below(Vec3 p) const {
  return std::all_of(plane_.begin(), plane_.end(),
                     [&](const Plane& plane) { return dot(p - plane.point, plane.normal) <= in_plane_m_; });
}

// Whether a child lies below the planes, and nothing in it faces a plane from below where it touches it.
bool PlaneClearance::is_all_below(std::size_t n, int k) const {
  const Bounds& b = bounds_[slot(n, k)];
  const BvhNode& node = bvh_.node[n];
  const Vec3 axis{static_cast<double>(node.cone_axis[0][k]), static_cast<double>(node.cone_axis[1][k]),
                  static_cast<double>(node.cone_axis[2][k])};
  const double tangent = static_cast<double>(node.cone_tangent[k]);
  for (const Plane& plane : plane_) {
    const Vec3 n_w = plane.normal;
    const Vec3 top{n_w.x > 0 ? b.upper.x : b.lower.x, n_w.y > 0 ? b.upper.y : b.lower.y,
                   n_w.z > 0 ? b.upper.z : b.lower.z};
    const double height = dot(top - plane.point, n_w);
    if (!(height <= in_plane_m_)) return false;
    // The opposite of the normal is in the cone where cos(angle) >= cos(half-angle).
    const double opposite = -dot(axis, n_w);
    const bool may_face = axis == Vec3{} || opposite * std::sqrt(1 + tangent * tangent) >= 1;
    if (may_face && height > -1e-9 * farthest_) return false;
  }
  return true;
}

// Distance of q from what rises above a plane, or `limit` where that is farther; 0 where the bake has no more time.
double PlaneClearance::distance_above(Vec3 q, double limit) {
  best2_ = limit * limit;
  stack_.assign(1, {0.0, 0});
  while (!stack_.empty()) {
    if (--visits_left_ < 0) return 0;
    const auto [distance2, n] = stack_.back();
    stack_.pop_back();
    if (distance2 < best2_) open(n, q);
  }
  return std::sqrt(best2_);
}

void PlaneClearance::open(std::size_t n, Vec3 q) {
  const BvhNode& node = bvh_.node[n];
  for (int k = 0; k < 4; ++k) {
    if (node.child[k] < 0 && node.count[k] == 0) continue;
    double distance2 = 0;
    const Bounds& b = bounds_[slot(n, k)];
    for (int axis = 0; axis < 3; ++axis) {
      const double gap = std::max({at(b.lower, axis) - at(q, axis), at(q, axis) - at(b.upper, axis), 0.0});
      distance2 += gap * gap;
    }
    if (!(distance2 < best2_) || is_all_below(n, k)) continue;
    if (node.child[k] >= 0) {
      stack_.emplace_back(distance2, static_cast<std::size_t>(node.child[k]));
      continue;
    }
    for (std::int32_t i = 0; i < node.count[k]; ++i) {
      const std::int32_t index = ~node.child[k] + i;
      const Triangle& t = bvh_.triangle[static_cast<std::size_t>(index)];
      const Vec3 v[3] = {corner(t, 0), corner(t, 1), corner(t, 2)};
      const Vec3 normal = plane_of(index).normal;
      const auto faces = [&](const Plane& plane) { return dot(normal, plane.normal) < -0.99; };
      const bool below = is_below(v[0]) && is_below(v[1]) && is_below(v[2]);
      if (below && std::none_of(plane_.begin(), plane_.end(), faces)) continue;
      const bool far_below = below && std::all_of(plane_.begin(), plane_.end(), [&](const Plane& plane) {
                               const double first = dot(v[0] - plane.point, plane.normal);
                               const double second = dot(v[1] - plane.point, plane.normal);
                               const double third = dot(v[2] - plane.point, plane.normal);
                               return std::min({first, second, third}) < -1e-9 * farthest_;
                             });
      if (far_below) continue;
      best2_ = std::min(best2_, squared_norm(q - closest_on_triangle(q, v[0], v[1], v[2]).point));
    }
  }
}

// Whether the triangles about a vertex, in turn, lie in one plane and close a disc about it.
bool PlaneClearance::is_flat(std::span<const std::int32_t> fan, std::int32_t middle) const {
  const Vec3 hub = vertex_[static_cast<std::size_t>(middle)];
  Plane plane{hub, {}};
  double longest = 0, nearest = 1e300, angle = 0;
  // The widest triangle's normal is the best.
  double widest = 0;
  for (const std::int32_t i : fan) {
    const double kept = kept_m(i);
    if (kept > widest) widest = kept, plane.normal = plane_of(i).normal;
  }
  if (!(widest > 0)) return false;
  for (const std::int32_t i : fan) {
    const Triangle& t = bvh_.triangle[static_cast<std::size_t>(i)];
    const int k = corner_at(t, middle);
    const Vec3 u = corner(t, (k + 1) % 3) - hub, v = corner(t, (k + 2) % 3) - hub, area = cross(u, v);
    const double along = dot(area, plane.normal);
    if (!(abs_of(dot(u, plane.normal)) <= in_plane_m_ && along > 0)) return false;
    longest = std::max(longest, norm(u));
    nearest = std::min(nearest, norm(area) / norm(u - v));
    angle += std::atan2(along, dot(u, v));
  }
  return abs_of(angle - 2 * kPi) < 1e-6 && nearest > kLeastFan * longest &&
         std::pow(0.5 * nearest, 2) > 4e-14 * kUsefulFactor * size_ * (farthest_ + kUsefulFactor * size_);
}

bool PlaneClearance::is_bent_one_way(std::span<const std::int32_t> fan) const {
  const Vec3 first = plane_of(fan[0]).normal;
  Vec3 axis;
  for (const std::int32_t i : fan) {
    const Vec3 turn = cross(first, plane_of(i).normal);
    if (squared_norm(turn) > squared_norm(axis)) axis = turn;
  }
  axis = norm(axis) > 1e-6 ? unit_or(axis, {}) : Vec3{};
  return squared_norm(axis) > 0 && std::all_of(fan.begin(), fan.end(), [&](std::int32_t i) {
           return abs_of(dot(plane_of(i).normal, axis)) < 1e-9;
         });
}

PlaneClearance::Fan PlaneClearance::look_about(std::int32_t index, int k) const {
  Fan out;
  out.known = true;
  const std::int32_t middle = bvh_.triangle[static_cast<std::size_t>(index)].vertex[k];
  std::vector<std::int32_t> fan;
  std::int32_t i = index;
  do {
    if (i < 0 || static_cast<std::int32_t>(fan.size()) > kMaxVertexTriangles) return out;
    fan.push_back(i);
    const Triangle& t = bvh_.triangle[static_cast<std::size_t>(i)];
    i = t.adjacent[corner_at(t, middle)];
  } while (i != index);
  out.triangles = static_cast<std::int32_t>(fan.size());
  out.flat = is_flat(fan, middle);
  out.bends_one_way = is_bent_one_way(fan);
  if (!out.flat) return out;
  const Vec3 hub = vertex_[static_cast<std::size_t>(middle)];
  for (int axis = 0; axis < 3; ++axis) {
    const bool across = std::all_of(fan.begin(), fan.end(), [&](std::int32_t f) {
      const Triangle& t = bvh_.triangle[static_cast<std::size_t>(f)];
      return at(corner(t, 0), axis) == at(hub, axis) && at(corner(t, 1), axis) == at(hub, axis) &&
             at(corner(t, 2), axis) == at(hub, axis);
    });
    // Rounding of a narrower needle's weights would show in the distance: see stands_over().
    const bool wide = std::all_of(fan.begin(), fan.end(), [&](std::int32_t f) {
      const Triangle& t = bvh_.triangle[static_cast<std::size_t>(f)];
      const double longest2 =
          std::max({squared_norm(corner(t, 1) - corner(t, 0)), squared_norm(corner(t, 2) - corner(t, 1)),
                    squared_norm(corner(t, 0) - corner(t, 2))});
      return kMostSlender * kept_m(f) > kSafeInset * std::sqrt(longest2);
    });
    const std::int32_t lowest = *std::min_element(fan.begin(), fan.end());
    if (across && wide && lowest <= ring_proof::kMostIndex) out.lowest = lowest;
  }
  return out;
}

const PlaneClearance::Fan& PlaneClearance::fan_about(std::int32_t index, int k) {
  Fan& fan = fan_[static_cast<std::size_t>(bvh_.triangle[static_cast<std::size_t>(index)].vertex[k])];
  if (!fan.known) fan = look_about(index, k);
  return fan;
}

bool PlaneClearance::bends_one_way(std::int32_t index) {
  return fan_about(index, 0).bends_one_way && fan_about(index, 1).bends_one_way && fan_about(index, 2).bends_one_way;
}

void PlaneClearance::measure(std::int32_t index, bool only_whole) {
  if (visits_left_ <= 0 || !list_planes(index)) return;
  Triangle& t = bvh_.triangle[static_cast<std::size_t>(index)];
  const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2), normal = cross(b - a, c - a);
  const Vec3 centroid = (1.0 / 3.0) * (a + b + c);
  const double reach2 = std::max({squared_norm(a - centroid), squared_norm(b - centroid), squared_norm(c - centroid)});
  double kept = kept_m(index);
  for (const std::int32_t across : t.adjacent) kept = std::min(kept, kept_m(across));
  double most_room2 = 0, height = size_;
  float scale = 0, radius = 0;
  for (int i = 0; i < kHeightsTried && most_room2 < reach2; ++i, height *= 0.5) {
    const double reach = kUsefulFactor * height;
    if (!(kept * kept > 4e-14 * reach * (farthest_ + reach) + 1e-16 * kSafeInset)) continue;
    const float tried = static_cast<float>(height / norm(normal));
    const double clear = distance_above(centroid + static_cast<double>(tried) * normal, reach);
    const double room2 = (clear - height) * height;  // as in bvh_clearance.cpp
    if (!(room2 > most_room2)) continue;
    most_room2 = room2;
    scale = tried;
    radius = static_cast<float>(kShrink * clear);
  }
  if (!(most_room2 > 0) || (only_whole && most_room2 < reach2)) return;
  t.clear_scale_per_m = scale;
  t.clear_radius_m = radius;
  t.ring_convex = ring_proof::kByPlanes;
  std::int32_t most = 0, hub = 0;
  for (int k = 0; k < 3; ++k) {
    const Fan& fan = fan_about(index, k);
    if (!fan.flat) continue;
    t.ring_convex |= 1 << (ring_proof::kFirstCorner + k);
    if (fan.lowest < 0 || fan.triangles <= most) continue;
    most = fan.triangles;
    hub = (k + 1) << ring_proof::kHub | fan.lowest << ring_proof::kFirstIndex;
  }
  t.ring_convex |= hub;
}

}  // namespace palpate
