// The simplex of a GJK search: up to four support points and the combination of them nearest to the origin.
#pragma once

#include <cstdint>

#include "rt_core/vec.h"

namespace palpate::test {

struct SupportPoint {
  Vec3 difference;  // on_a - on_b
  Vec3 on_a, on_b;
};

struct Simplex {
  SupportPoint point[4];
  Real weight[4] = {};
  std::int32_t count = 0;

  Vec3 nearest() const PALPATE_RT;  // sum of weight * difference
  Vec3 on_a() const PALPATE_RT;
  Vec3 on_b() const PALPATE_RT;
  bool holds(Vec3 difference) const PALPATE_RT;
};

// Drops the points that do not carry the nearest point to the origin and sets the weights of the rest. Returns true
// when the origin lies inside a tetrahedron (all four points kept).
bool reduce(Simplex& simplex) PALPATE_RT;

}  // namespace palpate::test
