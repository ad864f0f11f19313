// 6x6 tangent stiffness of the contact: how force and torque about the tool's origin answer a small motion of the tool.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

// Sum of springs k j j^T with j = [u; r x u]: stiffness k along unit vector u at the point r from the tool's origin.
// Symmetric and positive semi-definite by construction; only its three distinct blocks are kept.
struct ContactStiffness {
  Real force[6] = {};     // xx xy xz yy yz zz of k u u^T
  Real coupling[9] = {};  // row-major k u m^T, m = r x u
  Real torque[6] = {};    // xx xy xz yy yz zz of k m m^T
};

// direction = u, turn = r x u. Written out: gcc 12 at -O2 keeps the loops, at 2.5 times the instructions.
inline void add_spring(ContactStiffness& s, Real k_N_per_m, Vec3 direction, Vec3 turn) PALPATE_RT {
  const Vec3 u = direction, m = turn, ku = k_N_per_m * u, km = k_N_per_m * m;
  s.force[0] += ku.x * u.x;
  s.force[1] += ku.x * u.y;
  s.force[2] += ku.x * u.z;
  s.force[3] += ku.y * u.y;
  s.force[4] += ku.y * u.z;
  s.force[5] += ku.z * u.z;
  s.coupling[0] += ku.x * m.x;
  s.coupling[1] += ku.x * m.y;
  s.coupling[2] += ku.x * m.z;
  s.coupling[3] += ku.y * m.x;
  s.coupling[4] += ku.y * m.y;
  s.coupling[5] += ku.y * m.z;
  s.coupling[6] += ku.z * m.x;
  s.coupling[7] += ku.z * m.y;
  s.coupling[8] += ku.z * m.z;
  s.torque[0] += km.x * m.x;
  s.torque[1] += km.x * m.y;
  s.torque[2] += km.x * m.z;
  s.torque[3] += km.y * m.y;
  s.torque[4] += km.y * m.z;
  s.torque[5] += km.z * m.z;
}

inline void add_to(ContactStiffness& sum, const ContactStiffness& s, Real times = 1) PALPATE_RT {
  for (int i = 0; i < 6; ++i) sum.force[i] += times * s.force[i];        // bound: 6
  for (int i = 0; i < 9; ++i) sum.coupling[i] += times * s.coupling[i];  // bound: 9
  for (int i = 0; i < 6; ++i) sum.torque[i] += times * s.torque[i];      // bound: 6
}

// Stiffness against a translation along unit vector n.
inline Real stiffness_along_N_per_m(const ContactStiffness& s, Vec3 n) PALPATE_RT {
  const Real diagonal = s.force[0] * n.x * n.x + s.force[3] * n.y * n.y + s.force[5] * n.z * n.z;
  return diagonal + 2.0 * (s.force[1] * n.x * n.y + s.force[2] * n.x * n.z + s.force[4] * n.y * n.z);
}

// Row-major 6x6, force before torque.
inline void store(const ContactStiffness& s, Real (&matrix)[36]) PALPATE_RT {
  constexpr int kPacked[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (int i = 0; i < 3; ++i) {  // bound: 3 x 3
    for (int j = 0; j < 3; ++j) {
      matrix[6 * i + j] = s.force[kPacked[i][j]];
      matrix[6 * i + 3 + j] = s.coupling[3 * i + j];
      matrix[6 * (i + 3) + j] = s.coupling[3 * j + i];
      matrix[6 * (i + 3) + 3 + j] = s.torque[kPacked[i][j]];
    }
  }
}

}  // namespace palpate
