// Coefficients of the contact and friction laws from what a scene states, and how they were obtained.
#pragma once

#include <string>

#include "config/scene/scene.h"

namespace palpate {

struct ContactCoefficients {
  double k1_N_per_m = 0;
  double k3_N_per_m3 = 0;
  std::string derivation;
};
// Of a scene: f(D) = k1 D + k3 D^3.
ContactCoefficients contact_coefficients(const SceneDesc& scene);

// Duffing's oscillator x'' + omega0^2 x + eps beta0^2 x^3 per unit mass, as Luo & Xiao 2006 tabulate it. Their numbers
// (m = 1, omega0 = 0.2, eps beta0^2 = 0.4) reproduce their forces only if depths are in mm and forces in N; no
// consistent system of units does that, so mass and frequency are bare coefficients: k1 = 1e3 m omega0^2 N/m and k3 =
// 1e9 c m beta0^2 eps N/m^3. DuffingCoefficient::kPaper, c = 3/4: the mean of cos^4 over that of cos^2, right for an
// oscillation of amplitude D (harmonic balance). kStatic, c = 1: where a constant force settles.
ContactCoefficients duffing_paper_coefficients(const DuffingDesc& duffing);

// Cubic that matches value and slope of Hertz's law F = (4/3) E* sqrt(R) D^1.5 (rigid sphere of radius R on a half
// space) at the reference depth: k1 = 3/4 c sqrt(D_r), k3 = 1/4 c D_r^-1.5. Within 6.8 % of F(reference) on
// [0, 1.25 reference]. All arguments > 0, |nu| < 1.
ContactCoefficients hertz_coefficients(double youngs_modulus_Pa, double poisson_ratio, double radius_m,
                                       double reference_depth_m);

// nu used for beams: the scene's, or 0.47 under legacy_paper_material for the impossible 1.0.
double effective_poisson_ratio(const MaterialDesc& material);

struct FrictionCoefficients {
  double k_N = 0;  // N^(1 - beta)
  double beta = 1;
  double mu_static_ref = 0;
  double mu_dynamic = 0;
};
FrictionCoefficients friction_coefficients(const FrictionDesc& friction);

}  // namespace palpate
