#include "rt_core/collide/closest_point.h"

#include "rt_core/collide/node_test.h"
#include "rt_core/collide/ring.h"

namespace palpate {

namespace {

constexpr double kUnlimited_m = 1e9;
// Rings a walk may cross before the hierarchy is asked: a tool at 1 m/s crosses 1 mm per tick.
constexpr std::int32_t kMaxWalk = 4;

// Nearest triangle so far; starts as "nothing within the search radius".
struct Best {
  double distance2 = 0;
  std::int32_t triangle = INT32_MAX;
  TrianglePoint at;
  // Dismissal of triangles without measuring them: see raise_ceiling.
  Vec3 outward{};
  double ceiling = -1;
  std::int32_t shared[2] = {-1, -1};  // vertices of the edge or vertex the closest point lies on
  // Single-precision bound no admissible box may exceed: 2^-20 covers the rounding of box_distance2 and of this
  // conversion, the constant (0.1 nm squared) the rounding of the exact distances themselves for bodies up to 100 m.
  float bound() const PALPATE_RT { return static_cast<float>(distance2 * (1 + 0x1p-20) + 1e-20); }
};

// Squared distance of the point p of triangle abc from the triangle's edges, at least.
double edge_clearance2(Vec3 p, Vec3 a, Vec3 b, Vec3 c) PALPATE_RT {
  const Vec3 ab = b - a, bc = c - b, ca = a - c, n = cross(ab, ca);
  const double wa = abs_of(dot(cross(bc, p - b), n)), wb = abs_of(dot(cross(ca, p - c), n));
  const double wc = abs_of(dot(cross(ab, p - a), n));
  const double n2 = squared_norm(n);
  const double longest2 = max_of(max_of(squared_norm(ab), squared_norm(bc)), squared_norm(ca));
  const double least = min_of(min_of(wa, wb), wc);
  return n2 > 0 ? least * least / (n2 * longest2) : 0.0;
}

// With c the closest point and n = p - c, a triangle with no corner above the plane through c with normal n is no
// nearer than c: on a convex surface this dismisses all triangles but the nearest for a third of the price of measuring
// them. The plane is raised by the rounding of the heights, 1e-14 |n| (|c| + |n|), so that coplanar neighbours go too.
// A triangle can tie only by holding c: those that share its edge or vertex are always measured, and where c is so near
// the border of its feature that rounding could move it to the next one nothing is dismissed.
void raise_ceiling(Vec3 p, const Triangle& t, const Vec3* vertex, Best& best) PALPATE_RT {
  const double distance = square_root(best.distance2);
  const double rounding = 1e-14 * distance * (norm(best.at.point) + distance);
  const double least2 = max_of(4 * rounding + 1e-16, 1e-10 * best.distance2);
  const auto code = static_cast<std::int32_t>(best.at.feature);
  double clearance2 = kHuge;
  if (best.at.feature == Feature::kFace) {
    best.shared[0] = best.shared[1] = -1;
    clearance2 = edge_clearance2(best.at.point, vertex[t.vertex[0]], vertex[t.vertex[1]], vertex[t.vertex[2]]);
  } else if (best.at.feature >= Feature::kVertex0) {
    best.shared[0] = best.shared[1] = t.vertex[code - 4];
  } else {
    best.shared[0] = t.vertex[code - 1];
    best.shared[1] = t.vertex[code % 3];
    clearance2 = min_of(squared_norm(best.at.point - vertex[best.shared[0]]),
                        squared_norm(best.at.point - vertex[best.shared[1]]));
  }
  const bool usable = clearance2 > least2;
  best.outward = usable ? p - best.at.point : Vec3{};
  best.ceiling = usable ? dot(best.at.point, best.outward) + rounding : -1.0;
}

inline bool has_vertex(const Triangle& t, std::int32_t v) PALPATE_RT {
  return (t.vertex[0] == v) | (t.vertex[1] == v) | (t.vertex[2] == v);
}

// The surface a query runs over, as plain pointers: the compiler need not reload them.
struct Surface {
  const Triangle* triangle;
  const Vec3* vertex;
};

void measure(const Surface& surface, const Vec3& p, std::int32_t index, Best& best) PALPATE_RT {
  const Triangle& t = surface.triangle[index];
  const Vec3* vertex = surface.vertex;
  const TrianglePoint at = closest_on_triangle(p, vertex[t.vertex[0]], vertex[t.vertex[1]], vertex[t.vertex[2]]);
  const double distance2 = squared_norm(p - at.point);
  if (distance2 < best.distance2 || (distance2 == best.distance2 && index < best.triangle)) {
    best.distance2 = distance2;
    best.triangle = index;
    best.at = at;
    raise_ceiling(p, t, vertex, best);
  }
}

inline void consider(const Surface& surface, const Vec3& p, std::int32_t index, Best& best) PALPATE_RT {
  const Triangle& t = surface.triangle[index];
  const Vec3 n = best.outward;
  const double ceiling = best.ceiling;
  if (dot(surface.vertex[t.vertex[0]], n) <= ceiling && dot(surface.vertex[t.vertex[1]], n) <= ceiling &&
      dot(surface.vertex[t.vertex[2]], n) <= ceiling &&
      !(has_vertex(t, best.shared[0]) && has_vertex(t, best.shared[1]))) {
    return;
  }
  measure(surface, p, index, best);
}

struct Pending {
  float distance2;
  std::int32_t node;
};

// Depth-first descent, nearest child first, over a bounded stack.
class Descent {
 public:
  Descent(const Model& model, const Surface& surface, Vec3 p, Best& best) PALPATE_RT : model_(model),
                                                                                       surface_(surface),
                                                                                       p_(p),
                                                                                       query_(node_query(p)),
                                                                                       best_(best),
                                                                                       bound_(best.bound()) {}

  void run(SurfacePoint& result) PALPATE_RT {
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
  Best& best_;
  float bound_;  // best_.bound(), kept current
  Pending stack_[kMaxTraversalStack];
  std::int32_t top_ = 0, high_water_ = 0;
  double overflow_distance2_ = 1e300;  // nearest box given up because of a cap
};

Vec3 face_normal(const Model& model, std::int32_t triangle) PALPATE_RT {
  const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
  const Vec3 a = model.vertex_m[static_cast<std::size_t>(t.vertex[0])];
  const Vec3 b = model.vertex_m[static_cast<std::size_t>(t.vertex[1])];
  const Vec3 c = model.vertex_m[static_cast<std::size_t>(t.vertex[2])];
  return cross(b - a, c - a);
}

// Whether every surface point as near to p as `triangle` (at the given distance) lies in its ring: the ball about p is
// inside the ball about the triangle's clearance point, which holds no other surface.
bool is_certified(const Model& model, Vec3 p, std::int32_t triangle, double distance) PALPATE_RT {
  const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
  const double spare = static_cast<double>(t.clear_radius_m) - distance;
  if (!(spare > 0)) return false;
  const Vec3 a = model.vertex_m[static_cast<std::size_t>(t.vertex[0])];
  const Vec3 b = model.vertex_m[static_cast<std::size_t>(t.vertex[1])];
  const Vec3 c = model.vertex_m[static_cast<std::size_t>(t.vertex[2])];
  const Vec3 clear = (1.0 / 3.0) * (a + b + c) + static_cast<double>(t.clear_scale_per_m) * cross(b - a, c - a);
  // The shrinking covers the rounding of this test, so that a triangle outside the ring cannot even tie.
  return squared_norm(p - clear) < (1 - 1e-9) * (spare * spare);
}

// Walks from the warm triangle to nearer neighbours. True when the best triangle is proven to be the nearest of all,
// at a price that does not depend on the size of the mesh. Bound: kMaxWalk rings.
bool walk(const Model& model, const Surface& surface, Vec3 p, Best& best) PALPATE_RT {
  for (std::int32_t step = 0; step < kMaxWalk && best.triangle != INT32_MAX; ++step) {
    const std::int32_t centre = best.triangle;
    const bool certified = is_certified(model, p, centre, square_root(best.distance2));
    const auto visit = [&](std::int32_t index) PALPATE_RT { consider(surface, p, index, best); };
    if (!for_each_in_ring(surface.triangle, centre, visit)) return false;
    if (certified) return true;
    if (best.triangle == centre) return false;
  }
  return false;
}

}  // namespace

Vec3 pseudo_normal(const Model& model, std::int32_t triangle, Feature feature) PALPATE_RT {
  const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
  const Vec3 face = face_normal(model, triangle);
  if (feature == Feature::kFace) return face;
  const auto code = static_cast<std::size_t>(feature);
  if (feature >= Feature::kVertex0) return model.vertex_normal[static_cast<std::size_t>(t.vertex[code - 4])];
  const std::int32_t other = t.adjacent[code - 1];
  const Vec3 unit = unit_or(face, {});
  return other < 0 ? unit : unit + unit_or(face_normal(model, other), {});
}

SurfacePoint closest_surface_point(const Model& model, Vec3 p, double search_radius_m,
                                   std::int32_t warm_triangle) PALPATE_RT {
  SurfacePoint result;
  if (!is_finite(p)) return result;
  Best best;
  const double radius = search_radius_m < kUnlimited_m ? max_of(search_radius_m, 0.0) : 2 * kHuge;
  best.distance2 = radius * radius;
  const Surface surface{model.triangle.data(), model.vertex_m.data()};
  const auto triangles = static_cast<std::int32_t>(model.triangle.size());
  if (warm_triangle >= 0 && warm_triangle < triangles) measure(surface, p, warm_triangle, best);
  if (walk(model, surface, p, best)) {
    result.lower_bound_m = square_root(best.distance2);
  } else {
    Descent(model, surface, p, best).run(result);
  }
  if (best.triangle == INT32_MAX) return result;

  result.found = true;
  result.triangle = best.triangle;
  result.feature = best.at.feature;
  result.closest_w = best.at.point;
  const Vec3 offset = p - best.at.point;
  const double distance = square_root(best.distance2);
  const Vec3 pseudo = pseudo_normal(model, best.triangle, best.at.feature);
  const double side = dot(offset, pseudo) < 0 ? -1.0 : 1.0;
  result.signed_distance_m = side * distance;
  result.normal_w = distance > kDirectionFloor_m ? (side / distance) * offset : unit_or(pseudo, {0, 0, 1});
  return result;
}

}  // namespace palpate
