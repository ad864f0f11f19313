// Descent of the surface hierarchy: finds the nearest triangle from any start. The four children of a node are tested
// at once, in single precision rounded to the safe side.
#include "rt_core/surface/candidate.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

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

struct Pending {
  float distance2;
  std::int32_t node;
};

// Depth-first descent, nearest child first, over a bounded stack.
class Descent {
 public:
  Descent(const Model& model, const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT : model_(model),
                                                                                            surface_(surface),
                                                                                            p_(p),
                                                                                            query_(node_query(p)),
                                                                                            best_(best),
                                                                                            bound_(best.bound()) {}

  DescentResult run(std::int32_t most) PALPATE_RT {
    DescentResult result;
    Pending next{0, 0};
    std::int32_t opened = 0;
    const std::int32_t most_looked = best_.looked + most;
    do {  // bound: most
      if (opened == most || best_.looked >= most_looked) {
        overflow_distance2_ = min_of(overflow_distance2_, static_cast<double>(next.distance2));
        break;
      }
      next = open(model_.bvh[static_cast<std::size_t>(next.node)]);
      opened += 1;
    } while (next.node >= 0 || pop(next));
    for (std::int32_t i = 0; i < top_; ++i) {  // bound: kMaxTraversalStack; empty unless capped
      overflow_distance2_ = min_of(overflow_distance2_, static_cast<double>(stack_[i].distance2));
    }
    result.nodes = opened;
    result.stack_high_water = high_water_;
    result.truncated = overflow_distance2_ < best_.distance2;
    result.lower_bound_m = square_root(min_of(overflow_distance2_ * (1 - 0x1p-20), best_.distance2));
    return result;
  }

 private:
  // Tests a node's children: leaves are measured at once, inner nodes pushed, the nearest of them returned.
  Pending open(const BvhNode& node) PALPATE_RT {
    const Float4 distance2 = box_distance2(node, query_);
    unsigned admitted = lanes(distance2 <= splat4(bound_));
    // One admitted child must be followed anyway; only then is the cone test, twice the price of the boxes', saved.
    if ((admitted & (admitted - 1)) != 0) admitted &= ~lanes(cone_excludes(node, query_));
    float lane[4];
    __builtin_memcpy(lane, &distance2, sizeof lane);
    Pending nearest{0, -1};
    for (; admitted != 0; admitted &= admitted - 1) {  // bound: 4
      const int k = __builtin_ctz(admitted);
      if (node.child[k] < 0) {
        measure_leaf(~node.child[k], node.count[k]);
        continue;
      }
      Pending entry{lane[k], node.child[k]};
      if (nearest.node < 0) {
        nearest = entry;
        continue;
      }
      if (entry.distance2 < nearest.distance2) {
        const Pending closer = entry;
        entry = nearest;
        nearest = closer;
      }
      push(entry);
    }
    return nearest;
  }

  void measure_leaf(std::int32_t first, std::int32_t count) PALPATE_RT {
    for (std::int32_t i = 0; i < count; ++i) consider(surface_, p_, first + i, best_);  // bound: 4
    bound_ = best_.bound();
  }

  void push(Pending entry) PALPATE_RT {
    if (top_ == kMaxTraversalStack) {
      overflow_distance2_ = min_of(overflow_distance2_, static_cast<double>(entry.distance2));
      return;
    }
    stack_[top_++] = entry;
    high_water_ = top_ > high_water_ ? top_ : high_water_;
  }

  bool pop(Pending& next) PALPATE_RT {
    while (top_ > 0) {  // bound: kMaxTraversalStack
      next = stack_[--top_];
      if (next.distance2 <= bound_) return true;
    }
    return false;
  }

  const Model& model_;
  const Surface& surface_;
  const Vec3 p_;
  const NodeQuery query_;
  Candidate& best_;
  float bound_;  // best_.bound(), kept current
  Pending stack_[kMaxTraversalStack];
  std::int32_t top_ = 0, high_water_ = 0;
  double overflow_distance2_ = 1e300;  // nearest box given up because of a cap
};

}  // namespace

bool land(const Model& model, const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT {
  const NodeQuery query = node_query(p);
  bool nearer = false;
  std::int32_t at = 0;
  for (std::int32_t level = 0; level < kMaxTraversalStack; ++level) {  // a level per step
    const BvhNode& node = model.bvh[static_cast<std::size_t>(at)];
    const Float4 distance2 = box_distance2(node, query);
    best.looked += 1;
    int nearest = 0;
    for (int k = 1; k < 4; ++k) nearest = distance2[k] < distance2[nearest] ? k : nearest;  // bound: 4
    at = node.child[nearest];
    if (at >= 0) continue;
    for (std::int32_t i = 0; i < node.count[nearest]; ++i) {  // bound: 4
      if (keep_nearer(surface, p, ~at + i, best)) nearer = true;
    }
    break;
  }
  return nearer;
}

DescentResult descend(const Model& model, const Surface& surface, Vec3 p, std::int32_t most,
                      Candidate& best) PALPATE_RT {
  return Descent(model, surface, p, best).run(most);
}

}  // namespace palpate
