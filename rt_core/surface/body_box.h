// The box about the rest surface: what is far from the body its box says as well as its surface, and costs nothing.
#pragma once

#include "rt_core/lanes.h"
#include "rt_core/model.h"

namespace palpate {

struct Box {
  Vec3 lower, upper;
};

inline Box root_box(const Model& model) PALPATE_RT {
  Box box{{kHuge, kHuge, kHuge}, {-kHuge, -kHuge, -kHuge}};
  const BvhNode& root = model.bvh[0];
  for (int k = 0; k < 4; ++k) {  // bound: 4
    if (root.child[k] < 0 && root.count[k] == 0) continue;
    const auto low = [&](int axis) PALPATE_RT { return static_cast<Real>(root.lower_m[axis][k]); };
    const auto high = [&](int axis) PALPATE_RT { return static_cast<Real>(root.upper_m[axis][k]); };
    box.lower = {min_of(box.lower.x, low(0)), min_of(box.lower.y, low(1)), min_of(box.lower.z, low(2))};
    box.upper = {max_of(box.upper.x, high(0)), max_of(box.upper.y, high(1)), max_of(box.upper.z, high(2))};
  }
  return box;
}

static_assert(sizeof(Box) == 6 * sizeof(double));
// Of a point in the first three lanes.
inline Real distance_to(const Box& box, const Double4& p) PALPATE_RT {
  const Double4 last = load4(&box.lower.z), upper = __builtin_shufflevector(last, last, 1, 2, 3, 0);
  const Double4 under = load4(&box.lower.x) - p, over = p - upper, most = under > over ? under : over;
  const Double4 away = most > 0 ? most : Double4{}, away2 = away * away;
  return square_root(away2[0] + away2[1] + away2[2]);
}
inline Real distance_to(const Box& box, Vec3 p) PALPATE_RT { return distance_to(box, lanes_of(p)); }

}  // namespace palpate
