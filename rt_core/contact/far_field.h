// How a normal force at one place of the body moves its surface at another.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

// Boussinesq's half-space: a normal force F moves the surface at distance r by (1 - nu^2) F / (pi E r). The core radius
// a takes the point load's singularity away, r -> sqrt(r^2 + a^2), and the cosine of the two normals makes opposed
// sides push apart. As a kernel over (position, normal) this is the product of an inverse multiquadric and a Gram
// matrix, both positive semi-definite, hence so is it (Schur): the coupled solve always has exactly one answer. Metres
// of inward motion at i per newton at j. E, a > 0, |nu| < 1.
inline Real far_field_scale_m2_per_N(Real youngs_modulus_Pa, Real poisson_ratio) PALPATE_RT {
  constexpr Real kPi = 3.14159265358979323846;
  return (1.0 - poisson_ratio * poisson_ratio) / (kPi * youngs_modulus_Pa);
}
inline Real far_field_compliance_m_per_N(Real scale_m2_per_N, Real core_radius_m, Vec3 position_i, Vec3 normal_i,
                                         Vec3 position_j, Vec3 normal_j) PALPATE_RT {
  const Real square = squared_norm(position_i - position_j) + core_radius_m * core_radius_m;
  return square > 0 ? scale_m2_per_N * dot(normal_i, normal_j) / square_root(square) : 0.0;
}

}  // namespace palpate
