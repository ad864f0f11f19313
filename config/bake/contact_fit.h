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
// f(D) = k1 D + k3 D^3. Duffing: the triple of Luo & Xiao 2006 only reproduces their forces with depths in mm and
// forces in N, hence k1 = 1e3 m omega0^2 N/m and k3 = 1e9 c m beta0^2 eps N/m^3, c = 3/4 (paper) or 1 (static).
// Hertz: F = c D^1.5, c = 4/3 E/(1-nu^2) sqrt(R), matched in value and slope at the fit depth:
// k1 = 3/4 c sqrt(D_r), k3 = 1/4 c D_r^-1.5.
ContactCoefficients contact_coefficients(const SceneDesc& scene);

// nu used for beams: the scene's, or 0.47 under legacy_paper_material for the impossible 1.0.
double effective_poisson_ratio(const MaterialDesc& material);

struct FrictionCoefficients {
  double k_N = 0;  // N^(1 - beta)
  double beta = 1;
  double mu_static_ref = 0;
  double mu_dynamic = 0;
};
FrictionCoefficients friction_coefficients(const FrictionDesc& friction);

// Stiffest spring a sampled device keeps passive: min(2b / (T + 2 tau), 2 f_c / Delta): viscous damping against
// sampling and delay (Colgate & Brown 1994), Coulomb friction against the encoder's step (Abbott & Okamura 2005).
struct StiffnessBound {
  double value = 0;
  bool by_damping = true;  // which of the two is smaller
};
StiffnessBound admissible_stiffness(double damping, double friction, double encoder_step, double period_s,
                                    double delay_s);

// Share of the bound used when a scene says "auto": the bound assumes exact device data.
inline constexpr double kCouplingShare = 0.8;

}  // namespace palpate
