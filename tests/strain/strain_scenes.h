// The bodies of the reference scenes, in SI units.
#pragma once

#include "config/fem/axisymmetric_press.h"

namespace palpate::fem {

inline std::vector<double> in_metres(std::vector<double> mm) {
  for (double& x : mm) x *= 1e-3;
  return mm;
}

// A: sphere on a thick rubber block.
inline PressBody rubber_block() {
  PressBody b;
  b.outer_radius_m = 0.06;
  b.height_m = 0.06;
  b.youngs_modulus_Pa = 3.45e6 * (1 - 0.49 * 0.49);
  b.poisson_ratio = 0.49;
  return b;
}
// B: layer of the given height under a flat punch.
inline PressBody layer(double height_m) {
  PressBody b;
  b.outer_radius_m = 0.03;
  b.height_m = height_m;
  b.youngs_modulus_Pa = 1e6;
  b.poisson_ratio = 0.45;
  return b;
}
// C1: ellipsoid of revolution.
inline PressBody ellipsoid() {
  PressBody b;
  b.kind = PressBody::Kind::kEllipsoid;
  b.outer_radius_m = 0.04;
  b.height_m = 0.03;
  b.fixed_below_m = -0.024;
  b.youngs_modulus_Pa = 3e6;
  b.poisson_ratio = 0.45;
  return b;
}
inline RigidTool ball(double radius_m) {
  RigidTool t;
  t.radius_m = radius_m;
  return t;
}
inline RigidTool punch(double radius_m, double fillet_m) {
  RigidTool t;
  t.shape = RigidShape::kPunch;
  t.radius_m = radius_m;
  t.fillet_m = fillet_m;
  return t;
}

}  // namespace palpate::fem
