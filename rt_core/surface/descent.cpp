#include "rt_core/surface/descent.h"

#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/node_test.h"

namespace palpate {

namespace {

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

  DescentResult run() PALPATE_RT {
    DescentResult result;
    Pending next{0, 0};
    std::int32_t opened = 0;
    do {  // bound: kMaxQueryNodes
      if (opened == kMaxQueryNodes) {
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

DescentResult descend(const Model& model, const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT {
  return Descent(model, surface, p, best).run();
}

}  // namespace palpate
