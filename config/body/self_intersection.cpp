#include "config/body/self_intersection.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "config/index.h"

namespace palpate {

namespace {

struct Box {
  Vec3 lower{kHuge, kHuge, kHuge}, upper{-kHuge, -kHuge, -kHuge};
  void add(Vec3 p) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  bool overlaps(const Box& b) const {
    return lower.x <= b.upper.x && b.lower.x <= upper.x && lower.y <= b.upper.y && b.lower.y <= upper.y &&
           lower.z <= b.upper.z && b.lower.z <= upper.z;
  }
};

// Six times the volume of the tetrahedron, or zero within rounding: the sign says on which side of abc the point is.
double side_of(Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
  const Vec3 u = b - a, v = c - a, w = p - a;
  const double volume = dot(cross(u, v), w);
  // Rounding is 1e-16 of the product; points closer than 1e-9 of the triangle's size to its plane touch it.
  return volume * volume <= 1e-18 * squared_norm(u) * squared_norm(v) * squared_norm(w) ? 0.0 : volume;
}

// Whether the open segment pq goes through triangle abc, its border included: sheets of mirror-symmetric bodies meet
// edge through edge, everywhere (a dent pushed through the opposite side of a sphere went unseen until 2026-11-22).
bool crosses(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
  if (!(side_of(a, b, c, p) * side_of(a, b, c, q) < 0)) return false;
  const double s = side_of(p, a, b, q), t = side_of(p, b, c, q), u = side_of(p, c, a, q);
  return (s >= 0 && t >= 0 && u >= 0) || (s <= 0 && t <= 0 && u <= 0);
}

// A tree of boxes over the triangles, halved at the median of its longest side: node k has children 2k+1 and 2k+2.
class Pairs {
 public:
  Pairs(const SurfaceMesh& mesh, std::int64_t budget) : mesh_(mesh), budget_(budget), order_(mesh.triangle.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    box_.resize(order_.size());
    for (std::size_t t = 0; t < order_.size(); ++t)
      for (const std::int32_t v : mesh.triangle[t]) box_[t].add(mesh.vertex_m[at(v)]);
    root_ = build(0, order_.size());
  }
  SelfIntersections find() {
    within(root_);
    result_.complete = budget_ > 0;
    return result_;
  }

 private:
  static constexpr std::size_t kLeaf = 4;
  struct Node {
    Box box;
    std::size_t first, end;
    std::int32_t child[2];
  };

  std::int32_t build(std::size_t first, std::size_t end) {
    Node node{{}, first, end, {-1, -1}};
    for (std::size_t i = first; i < end; ++i) {
      node.box.add(box_[at(order_[i])].lower);
      node.box.add(box_[at(order_[i])].upper);
    }
    const auto index = static_cast<std::int32_t>(node_.size());
    node_.push_back(node);
    if (end - first > kLeaf) {
      const Vec3 size = node.box.upper - node.box.lower;
      const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
      const auto middle_of = [&](std::int32_t t) {
        const Vec3 sum = box_[at(t)].lower + box_[at(t)].upper;
        return axis == 0 ? sum.x : axis == 1 ? sum.y : sum.z;
      };
      const auto half = order_.begin() + static_cast<std::ptrdiff_t>((first + end) / 2);
      std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first), half,
                       order_.begin() + static_cast<std::ptrdiff_t>(end),
                       [&](std::int32_t a, std::int32_t b) { return middle_of(a) < middle_of(b); });
      const std::int32_t low = build(first, (first + end) / 2), high = build((first + end) / 2, end);
      node_[at(index)].child[0] = low;
      node_[at(index)].child[1] = high;
    }
    return index;
  }

  bool is_leaf(std::int32_t n) const { return node_[at(n)].child[0] < 0; }
  bool spent() const { return budget_ <= 0 || result_.pairs >= kMostCounted; }

  // All pairs inside one node; depth log2 of the triangles.
  void within(std::int32_t n) {
    if (spent()) return;
    const Node& node = node_[at(n)];
    if (!is_leaf(n)) {
      within(node.child[0]);
      within(node.child[1]);
      between(node.child[0], node.child[1]);
      return;
    }
    for (std::size_t i = node.first; i < node.end; ++i)
      for (std::size_t j = i + 1; j < node.end; ++j) look_at(order_[i], order_[j]);
  }

  void between(std::int32_t a, std::int32_t b) {
    budget_ -= 1;
    if (spent() || !node_[at(a)].box.overlaps(node_[at(b)].box)) return;
    if (is_leaf(a) && is_leaf(b)) {
      for (std::size_t i = node_[at(a)].first; i < node_[at(a)].end; ++i)
        for (std::size_t j = node_[at(b)].first; j < node_[at(b)].end; ++j) look_at(order_[i], order_[j]);
      return;
    }
    const bool split_a =
        !is_leaf(a) && (is_leaf(b) || node_[at(a)].end - node_[at(a)].first >= node_[at(b)].end - node_[at(b)].first);
    const Node& split = node_[at(split_a ? a : b)];
    for (const std::int32_t child : split.child) between(child, split_a ? b : a);
  }

  void look_at(std::int32_t s, std::int32_t t) {
    budget_ -= 1;
    if (!box_[at(s)].overlaps(box_[at(t)])) return;
    if (!cross_each_other(mesh_.triangle[at(s)], mesh_.triangle[at(t)])) return;
    if (result_.pairs++ > 0) return;
    result_.first = std::min(s, t);
    result_.where_m = mesh_.vertex_m[at(mesh_.triangle[at(result_.first)][0])];
  }

  // Neighbours share corners, and touch there: only edges that have no corner in common with the other can cross it.
  bool cross_each_other(const Corners& s, const Corners& t) const {
    int shared = 0;
    for (const std::int32_t v : s) shared += std::count(t.begin(), t.end(), v) > 0 ? 1 : 0;
    return shared < 2 && (edge_crosses(s, t) || edge_crosses(t, s));
  }
  bool edge_crosses(const Corners& edges, const Corners& face) const {
    const auto is_corner = [&](std::int32_t v) { return std::count(face.begin(), face.end(), v) > 0; };
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t p = edges[k], q = edges[(k + 1) % 3];
      if (is_corner(p) || is_corner(q)) continue;
      if (crosses(mesh_.vertex_m[at(p)], mesh_.vertex_m[at(q)], mesh_.vertex_m[at(face[0])],
                  mesh_.vertex_m[at(face[1])], mesh_.vertex_m[at(face[2])]))
        return true;
    }
    return false;
  }

  const SurfaceMesh& mesh_;
  std::int64_t budget_;
  std::vector<std::int32_t> order_;
  std::vector<Box> box_;
  std::vector<Node> node_;
  std::int32_t root_ = 0;
  SelfIntersections result_;
};

}  // namespace

SelfIntersections find_self_intersections(const SurfaceMesh& mesh, std::int64_t pair_budget) {
  return mesh.triangle.empty() ? SelfIntersections{} : Pairs(mesh, pair_budget).find();
}

}  // namespace palpate
