// Closed bodies of revolution whose ends are fans about the axis, with as many needles as there are steps around.
#pragma once

#include "tests/collide/meshes.h"

namespace palpate::test {

struct ProfileCorner {
  double radius, height;
};

// From the lower middle to the upper one, both on the axis, which is y. `turn`: of the whole body, not at all where it
// is zero.
inline Mesh revolved(const std::vector<ProfileCorner>& profile, int around, Vec3 turn = {}) {
  Mesh mesh;
  for (const ProfileCorner& c : profile) {
    for (int i = 0; i < (c.radius > 0 ? around : 1); ++i) {
      const double a = 6.283185307179586 * i / around;
      mesh.vertex.push_back({c.radius * std::sin(a), c.height, c.radius * std::cos(a)});
    }
  }
  const int rings = static_cast<int>(profile.size()) - 2, top = 1 + rings * around;
  const auto at = [&](int ring, int i) { return 1 + ring * around + i % around; };
  for (int i = 0; i < around; ++i) {
    mesh.triangle.push_back({{0, at(0, i + 1), at(0, i)}, {}});
    mesh.triangle.push_back({{top, at(rings - 1, i), at(rings - 1, i + 1)}, {}});
    for (int r = 0; r + 1 < rings; ++r) {
      mesh.triangle.push_back({{at(r, i), at(r, i + 1), at(r + 1, i + 1)}, {}});
      mesh.triangle.push_back({{at(r, i), at(r + 1, i + 1), at(r + 1, i)}, {}});
    }
  }
  if (!(turn == Vec3{}))
    for (Vec3& v : mesh.vertex) v = rotate(small_rotation(turn), v);
  return mesh;
}

// A standing cylinder.
inline Mesh standing_cylinder(double radius, double height, int around, Vec3 turn = {}) {
  return revolved({{0, 0}, {radius, 0}, {radius, height}, {0, height}}, around, turn);
}

}  // namespace palpate::test
