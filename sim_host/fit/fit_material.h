// Material and friction from measured forces: nonlinear least squares over a forward model, with what is left over.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rt_core/vec.h"

namespace palpate {

struct MaterialGuess {
  double youngs_modulus_Pa = 0, poisson_ratio = 0, friction = 0;
};
enum class Fitted { kModulus, kPoisson, kFriction };

// Forces of the model at the measured poses.
using ForwardModel = std::function<std::vector<Vec3>(const MaterialGuess& material)>;

struct FittedValue {
  Fitted what{};
  double value = 0, half_width = 0;  // of the 95 % confidence interval
  bool identified = true;            // false: these presses do not say; the value is the guess's
};

struct MaterialFit {
  MaterialGuess material;
  std::vector<FittedValue> value;
  double noise_N = 0;      // standard deviation of what is left over, per component
  double correlation = 0;  // of what is left over from one row to the next: near 1 the model errs, near 0 it is noise
  int evaluations = 0;     // of the forward model
  std::vector<Vec3> force_N;  // of the fitted model
};

// Half widths above which a parameter counts as not identified: of E its own share, of the others absolute.
inline constexpr double kModulusUnknown = 0.5, kPoissonUnknown = 0.1, kFrictionUnknown = 0.2;

// Levenberg-Marquardt from `guess` over the parameters asked for. Those that the measurement does not identify go back
// to the guess and the others are fitted again. Throws std::runtime_error when there are fewer values than parameters
// or no force.
MaterialFit fit_material(const ForwardModel& forward, const MaterialGuess& guess, const std::vector<Fitted>& wanted,
                         const std::vector<Vec3>& measured_N);

}  // namespace palpate
