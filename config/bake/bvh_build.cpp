#include "config/bake/bvh_build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "config/bake/bvh_clearance.h"

namespace palpate {

namespace {

struct Box {
  Vec3 lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  void grow(Vec3 p) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  void grow(const Box& b) { grow(b.lower), grow(b.upper); }
  double half_area() const {
    const Vec3 e = upper - lower;
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
};

struct Range {
  std::int32_t first = 0, count = 0;
};

double component(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

float round_down(double x) {
  const float f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafter(f, -std::numeric_limits<float>::max()) : f;
}
float round_up(double x) { return -round_down(-x); }

// Half-angles beyond this get no cone: the skip rule needs every fan to be a graph over the cone's plane.
constexpr double kWidestCone_rad = 1.2;
// Added to every half-angle: covers single-precision rounding of the axis and of the query.
constexpr double kConeSlack_rad = 2e-3;
constexpr int kBins = 16;

class Builder {
 public:
  Builder(std::span<const Vec3> vertex, std::span<const Triangle> triangle) : vertex_(vertex), triangle_(triangle) {
    order_.resize(triangle.size());
    std::iota(order_.begin(), order_.end(), 0);
    box_.resize(triangle.size());
    centre_.resize(triangle.size());
    normal_.resize(triangle.size());
    for (std::size_t t = 0; t < triangle.size(); ++t) measure(t);
    list_fans();
  }

  BvhBuild build() {
    BvhBuild out;
    out.node.reserve(triangle_.size() / 2 + 1);
    out.node.emplace_back();
    build_node(out, 0, {0, static_cast<std::int32_t>(order_.size())}, 1);
    out.stack_high_water = 3 * out.depth;
    reorder(out);
    return out;
  }

 private:
  void measure(std::size_t t) {
    const Vec3 a = vertex_of(t, 0), b = vertex_of(t, 1), c = vertex_of(t, 2);
    box_[t].grow(a), box_[t].grow(b), box_[t].grow(c);
    centre_[t] = 0.5 * (box_[t].lower + box_[t].upper);
    normal_[t] = unit_or(cross(b - a, c - a), {});
  }
  Vec3 vertex_of(std::size_t t, int k) const { return vertex_[static_cast<std::size_t>(triangle_[t].vertex[k])]; }

  // fan_[fan_start_[v] .. fan_start_[v + 1]) are the triangles around vertex v.
  void list_fans() {
    fan_start_.assign(vertex_.size() + 1, 0);
    for (const Triangle& t : triangle_)
      for (const std::int32_t v : t.vertex) fan_start_[static_cast<std::size_t>(v) + 1] += 1;
    std::partial_sum(fan_start_.begin(), fan_start_.end(), fan_start_.begin());
    fan_.resize(3 * triangle_.size());
    std::vector<std::int32_t> next(fan_start_.begin(), fan_start_.end() - 1);
    for (std::size_t t = 0; t < triangle_.size(); ++t)
      for (const std::int32_t v : triangle_[t].vertex)
        fan_[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = static_cast<std::int32_t>(t);
  }

  std::span<const std::int32_t> members(Range r) const {
    return std::span(order_).subspan(static_cast<std::size_t>(r.first), static_cast<std::size_t>(r.count));
  }

  Box bounds(Range r) const {
    Box box;
    for (const std::int32_t t : members(r)) box.grow(box_[static_cast<std::size_t>(t)]);
    return box;
  }

  Range split_at(Range& r, std::int32_t left_count) const {
    const Range right{r.first + left_count, r.count - left_count};
    r.count = left_count;
    return right;
  }

  // Splits r in two, keeps the left part in r and returns the right part; both are non-empty (r.count >= 2).
  Range split(Range& r, bool median) {
    Box centres;
    for (const std::int32_t t : members(r)) centres.grow(centre_[static_cast<std::size_t>(t)]);
    if (!median) {
      const std::int32_t left = partition_by_area(r, centres);
      if (left > 0 && left < r.count) return split_at(r, left);
    }
    const Vec3 extent = centres.upper - centres.lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto begin = order_.begin() + r.first;
    std::nth_element(begin, begin + r.count / 2, begin + r.count, [&](std::int32_t a, std::int32_t b) {
      const double ca = component(centre_[static_cast<std::size_t>(a)], axis);
      const double cb = component(centre_[static_cast<std::size_t>(b)], axis);
      return ca != cb ? ca < cb : a < b;  // a total order: the same tree on every machine
    });
    return split_at(r, r.count / 2);
  }

  // Binned surface-area heuristic (Wald 2007); returns how many triangles went left, 0 when no plane separates them.
  std::int32_t partition_by_area(Range r, const Box& centres) {
    double best_cost = std::numeric_limits<double>::max(), best_plane = 0;
    int best_axis = -1;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = component(centres.lower, axis), extent = component(centres.upper, axis) - low;
      if (!(extent > 0)) continue;
      Box bin[kBins];
      std::int32_t count[kBins] = {};
      for (const std::int32_t t : members(r)) {
        const auto i = static_cast<std::size_t>(t);
        const int b = std::min(kBins - 1, static_cast<int>(kBins * ((component(centre_[i], axis) - low) / extent)));
        bin[b].grow(box_[i]);
        count[b] += 1;
      }
      for (int cut = 1; cut < kBins; ++cut) {
        const double cost = side_cost(bin, count, 0, cut) + side_cost(bin, count, cut, kBins);
        if (cost >= best_cost) continue;
        best_cost = cost, best_axis = axis, best_plane = low + extent * cut / kBins;
      }
    }
    if (best_axis < 0) return 0;
    const auto begin = order_.begin() + r.first;
    const auto middle = std::partition(begin, begin + r.count, [&](std::int32_t t) {
      return component(centre_[static_cast<std::size_t>(t)], best_axis) < best_plane;
    });
    return static_cast<std::int32_t>(middle - begin);
  }

  static double side_cost(const Box* bin, const std::int32_t* count, int from, int to) {
    Box box;
    std::int32_t n = 0;
    for (int b = from; b < to; ++b) {
      if (count[b] == 0) continue;
      box.grow(bin[b]);
      n += count[b];
    }
    return n == 0 ? 0.0 : box.half_area() * n;
  }

  // Recursion depth is the tree's own, bounded by kBvhSahLevels + log4(n) + 1.
  void build_node(BvhBuild& out, std::size_t index, Range range, std::int32_t level) {
    out.depth = std::max(out.depth, level);
    Range child[4] = {range};
    int children = 1;
    while (children < 4) {  // split the largest part that is not yet a leaf
      int largest = 0;
      for (int k = 1; k < children; ++k)
        if (child[k].count > child[largest].count) largest = k;
      if (child[largest].count <= kBvhLeafTriangles && children > 1) break;
      if (child[largest].count < 2) break;
      child[children++] = split(child[largest], level > kBvhSahLevels);
    }
    std::sort(child, child + children, [](Range a, Range b) { return a.first < b.first; });
    for (int k = 0; k < 4; ++k) write_child(out.node[index], k, k < children ? child[k] : Range{});
    for (int k = 0; k < children; ++k) {
      if (child[k].count <= kBvhLeafTriangles) continue;
      const std::size_t next = out.node.size();
      out.node.emplace_back();
      out.node[index].child[k] = static_cast<std::int32_t>(next);
      build_node(out, next, child[k], level + 1);
    }
  }

  void write_child(BvhNode& node, int k, Range r) const {
    // An empty slot is a point so far away that no query reaches it.
    Box box;
    r.count > 0 ? box.grow(bounds(r)) : box.grow(Vec3{kHuge, kHuge, kHuge});
    const Cone cone = r.count > 0 ? cone_of(r) : Cone{};
    for (int axis = 0; axis < 3; ++axis) {
      node.lower_m[axis][k] = round_down(component(box.lower, axis));
      node.upper_m[axis][k] = r.count > 0 ? round_up(component(box.upper, axis)) : node.lower_m[axis][k];
      node.cone_axis[axis][k] = static_cast<float>(component(cone.axis, axis));
    }
    node.cone_tangent[k] = round_up(cone.tangent);
    node.cone_radius_m[k] = r.count > 0 ? round_up(radius_about(0.5 * (box.lower + box.upper), r)) : 0.0f;
    node.child[k] = r.count > 0 ? ~r.first : -1;
    node.count[k] = r.count <= kBvhLeafTriangles ? r.count : 0;
  }

  double radius_about(Vec3 centre, Range r) const {
    double radius2 = 0;
    for (const std::int32_t t : members(r))
      for (const std::int32_t v : triangle_[static_cast<std::size_t>(t)].vertex)
        radius2 = std::max(radius2, squared_norm(vertex_[static_cast<std::size_t>(v)] - centre));
    return 1.001 * std::sqrt(radius2);  // more than covers the box centre's rounding to single precision
  }

  struct Cone {
    Vec3 axis{};
    double tangent = 0;
  };

  // Smallest cone about the mean normal that holds every normal of the triangles and of the fans around their vertices.
  Cone cone_of(Range r) const {
    Vec3 sum{};
    for (const std::int32_t t : members(r)) sum += normal_[static_cast<std::size_t>(t)];
    const Vec3 axis = unit_or(sum, {});
    const double lowest_cosine = std::cos(kWidestCone_rad);
    double cosine = 1;
    for (const std::int32_t t : members(r)) {
      for (const std::int32_t v : triangle_[static_cast<std::size_t>(t)].vertex) {
        const auto first = static_cast<std::size_t>(fan_start_[static_cast<std::size_t>(v)]);
        const auto last = static_cast<std::size_t>(fan_start_[static_cast<std::size_t>(v) + 1]);
        // A zero normal (degenerate triangle) gives cosine 0: no cone.
        for (std::size_t i = first; i < last; ++i)
          cosine = std::min(cosine, dot(axis, normal_[static_cast<std::size_t>(fan_[i])]));
      }
      if (!(cosine > lowest_cosine)) return {};
    }
    return {axis, std::tan(std::acos(std::min(cosine, 1.0)) + kConeSlack_rad)};
  }

  void reorder(BvhBuild& out) const {
    std::vector<std::int32_t> new_index(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i)
      new_index[static_cast<std::size_t>(order_[i])] = static_cast<std::int32_t>(i);
    out.old_index = order_;
    out.triangle.reserve(order_.size());
    for (const std::int32_t old : order_) {
      Triangle t = triangle_[static_cast<std::size_t>(old)];
      for (std::int32_t& adjacent : t.adjacent)
        if (adjacent >= 0) adjacent = new_index[static_cast<std::size_t>(adjacent)];
      out.triangle.push_back(t);
    }
  }

  std::span<const Vec3> vertex_;
  std::span<const Triangle> triangle_;
  std::vector<std::int32_t> order_, fan_, fan_start_;
  std::vector<Box> box_;
  std::vector<Vec3> centre_, normal_;
};

}  // namespace

BvhBuild build_bvh(std::span<const Vec3> vertex_m, std::span<const Triangle> triangle) {
  BvhBuild bvh = Builder(vertex_m, triangle).build();
  measure_clearance(vertex_m, bvh);
  return bvh;
}

}  // namespace palpate
