// The box about the rest surface: what is far from the body its box says as well as its surface, and costs nothing.
#pragma once

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

inline Real distance_to(const Box& box, Vec3 p) PALPATE_RT {
  return norm({max_of(max_of(box.lower.x - p.x, p.x - box.upper.x), 0.0),
               max_of(max_of(box.lower.y - p.y, p.y - box.upper.y), 0.0),
               max_of(max_of(box.lower.z - p.z, p.z - box.upper.z), 0.0)});
}

}  // namespace palpate
