// Springs of four regions at a time, as they add up to the tool's tangent stiffness.
#pragma once

#include "rt_core/contact/problem.h"
#include "rt_core/contact/region_load.h"
#include "rt_core/tool/pose_lanes.h"

namespace palpate {

// Numbers of ContactStiffness, as many for each of four regions.
struct Springs {
  Double4 force[6] = {}, coupling[9] = {}, torque[6] = {};

  // add_spring().
  void add(const Double4& k_N_per_m, const Vec3x4& direction, const Vec3x4& turn) PALPATE_RT {
    const Double4 u[3] = {direction.x, direction.y, direction.z}, m[3] = {turn.x, turn.y, turn.z};
    int packed = 0;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {  // bound: 3 x 3
      const Double4 ku = k_N_per_m * u[i], km = k_N_per_m * m[i];
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) {
        coupling[3 * i + j] += ku * m[j];
        if (j < i) continue;
        force[packed] += ku * u[j];
        torque[packed] += km * m[j];
        packed += 1;
      }
    }
  }
  // stiffness_along_N_per_m().
  Double4 along(const Vec3x4& n) const PALPATE_RT {
    const Double4 diagonal = force[0] * n.x * n.x + force[3] * n.y * n.y + force[5] * n.z * n.z;
    return diagonal + splat4(2.0) * (force[1] * n.x * n.y + force[2] * n.x * n.z + force[4] * n.y * n.z);
  }
  // Each by its share.
  void add(const Springs& more, const Double4& share) PALPATE_RT {
    for (int i = 0; i < 6; ++i) force[i] += share * more.force[i];        // bound: 6
    for (int i = 0; i < 9; ++i) coupling[i] += share * more.coupling[i];  // bound: 9
    for (int i = 0; i < 6; ++i) torque[i] += share * more.torque[i];      // bound: 6
  }
  // The sum of all four.
  void add_to(ContactStiffness& all) const PALPATE_RT {
    for (int i = 0; i < 6; ++i) all.force[i] += sum(force[i]);        // bound: 6
    for (int i = 0; i < 9; ++i) all.coupling[i] += sum(coupling[i]);  // bound: 9
    for (int i = 0; i < 6; ++i) all.torque[i] += sum(torque[i]);      // bound: 6
  }
};

// Springs of all regions by tool: of the second hand's, where there is one.
struct ToolSprings {
  Springs first, second;
  bool are_two = false;

  // `hand`: of each region, 0 or 1.
  void add(const Springs& four, const Double4& hand) PALPATE_RT {
    first.add(four, splat4(1.0) - hand);
    if (bits_of(hand > 0) == 0) return;
    second.add(four, hand);
    are_two = true;
  }
  void add_to(Scratch& scratch) const PALPATE_RT {
    first.add_to(scratch.stiffness);
    if (are_two) second.add_to(scratch.other.stiffness);
  }
};

}  // namespace palpate
