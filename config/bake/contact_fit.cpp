#include "config/bake/contact_fit.h"

#include <algorithm>
#include <cstdio>

#include "rt_core/math.h"

namespace palpate {

namespace {

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

}  // namespace

double effective_poisson_ratio(const MaterialDesc& material) {
  return material.legacy_paper_material && material.poisson_ratio > 0.5 ? 0.47 : material.poisson_ratio;
}

ContactCoefficients duffing_paper_coefficients(const DuffingDesc& d) {
  const double share = d.coefficient == DuffingCoefficient::kPaper ? 0.75 : 1.0;
  return {1e3 * d.mass_kg * d.omega0 * d.omega0, 1e9 * share * d.mass_kg * d.beta0sq_eps,
          format("Duffing in mm and N: k1 = 1e3 m omega0^2, k3 = 1e9 * %.2f m beta0^2 eps", share)};
}

ContactCoefficients hertz_coefficients(double youngs_modulus_Pa, double poisson_ratio, double radius_m,
                                       double reference_depth_m) {
  const double depth = reference_depth_m, root = square_root(depth);
  const double factor = 4.0 / 3.0 * youngs_modulus_Pa / (1 - poisson_ratio * poisson_ratio) * square_root(radius_m);
  return {0.75 * factor * root, 0.25 * factor / (depth * root),
          format("Hertz, sphere of %.4g mm, value and slope matched at %.4g mm (%.4g N)", 1e3 * radius_m, 1e3 * depth,
                 factor * depth * root)};
}

ContactCoefficients contact_coefficients(const SceneDesc& scene) {
  ContactCoefficients c;
  switch (scene.contact.law) {
    case ContactLaw::kDuffing:
      return duffing_paper_coefficients(scene.duffing);
    case ContactLaw::kCubic:
      c.k1_N_per_m = scene.cubic.k1_N_per_m;
      c.k3_N_per_m3 = scene.cubic.k3_N_per_m3;
      c.derivation = "given in the scene";
      break;
    case ContactLaw::kTool:
    case ContactLaw::kTable:
      c.derivation = "not used: the tips carry their own laws";
      break;
    case ContactLaw::kHertz:
      return hertz_coefficients(scene.material.youngs_modulus_Pa, effective_poisson_ratio(scene.material),
                                scene.hertz.tool_radius_m, scene.hertz.fit_depth_m);
  }
  return c;
}

FrictionCoefficients friction_coefficients(const FrictionDesc& friction) {
  FrictionCoefficients c;
  if (friction.law == FrictionLaw::kPresliding || friction.law == FrictionLaw::kPreslidingPaper) {
    const double mu = is_auto(friction.mu_ref) ? 0.5 : friction.mu_ref;
    return {mu, 1, mu, std::min(mu, 10.0)};
  }
  c.beta = friction.beta;
  const double reference = math::pow(friction.reference_force_N, 1 - friction.beta);
  if (is_auto(friction.k)) {
    c.mu_static_ref = is_auto(friction.mu_ref) ? 0.5 : friction.mu_ref;
    c.k_N = c.mu_static_ref * reference;
  } else {
    c.k_N = friction.k;
    c.mu_static_ref = friction.k / reference;
  }
  c.mu_dynamic = is_auto(friction.mu_dynamic) ? std::min(0.8 * c.mu_static_ref, 10.0) : friction.mu_dynamic;
  return c;
}

}  // namespace palpate
