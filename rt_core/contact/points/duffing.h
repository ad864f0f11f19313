// Where the contact law's two coefficients come from. Pure arithmetic for the baker and the tests; not used in a tick.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

struct CubicCoefficients {
  Real k1_N_per_m = 0;
  Real k3_N_per_m3 = 0;
};

// Duffing's oscillator x'' + omega0^2 x + epsilon beta0^2 x^3 per unit mass, as Luo & Xiao 2006 tabulate it. Their
// numbers (m = 1, omega0 = 0.2, epsilon beta0^2 = 0.4) reproduce their forces only if depths are in mm and forces in N;
// no consistent system of units does that, so mass and frequency are to be read as bare coefficients.
struct DuffingParameters {
  Real mass = 0;
  Real omega0 = 0;
  Real epsilon_beta0_squared = 0;
};

// Coefficient of the cubic term. kPaper, 3/4: the mean of cos^4 over that of cos^2, right for an oscillation of
// amplitude D (harmonic balance). kStatic, 1: where a constant force on the damped oscillator settles.
enum class DuffingCoefficient { kPaper, kStatic };

// f(D) = m (omega0^2 D + coefficient epsilon beta0^2 D^3), D in mm and f in N, converted to SI. Example: m = 1,
// omega0 = 0.2, epsilon beta0^2 = 0.4 with kPaper gives 40 N/m and 3e8 N/m^3.
constexpr CubicCoefficients duffing_coefficients(const DuffingParameters& p, DuffingCoefficient coefficient) {
  const Real cubic = coefficient == DuffingCoefficient::kPaper ? 0.75 : 1.0;
  return {1e3 * p.mass * p.omega0 * p.omega0, 1e9 * cubic * p.mass * p.epsilon_beta0_squared};
}

// Plane-strain modulus E / (1 - nu^2), Pa. |nu| < 1.
constexpr Real contact_modulus_Pa(Real youngs_modulus_Pa, Real poisson_ratio) {
  return youngs_modulus_Pa / (1.0 - poisson_ratio * poisson_ratio);
}

// Cubic that matches value and slope of Hertz's law F = (4/3) E* sqrt(R) D^1.5 (rigid sphere of radius R on a
// half-space) at the reference depth; within 6.8 % of F(reference) on [0, 1.25 reference]. All arguments > 0, |nu| < 1.
inline CubicCoefficients hertz_coefficients(Real youngs_modulus_Pa, Real poisson_ratio, Real radius_m,
                                            Real reference_depth_m) {
  const Real c = 4.0 / 3.0 * contact_modulus_Pa(youngs_modulus_Pa, poisson_ratio) * square_root(radius_m);
  const Real root = square_root(reference_depth_m);
  return {0.75 * c * root, 0.25 * c / (reference_depth_m * root)};
}

}  // namespace palpate
