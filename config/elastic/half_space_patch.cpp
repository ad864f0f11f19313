#include "config/elastic/half_space_patch.h"

#include <cmath>
#include <numbers>

namespace palpate::elastic {

namespace {

// exp(-z) I0(z), z >= 0, by its integral (1/pi) int_0^pi exp(z (cos t - 1)) dt: midpoints converge faster than any
// power where the integrand is smooth on the circle; far out by the series in 1/z, good to 1e-6 from 20 on.
double scaled_bessel_i0(double z) {
  if (z > 20) {
    const double x = 1 / (8 * z);
    return (1 + x * (1 + x * (4.5 + 37.5 * x))) / std::sqrt(2 * std::numbers::pi * z);
  }
  constexpr int kPoints = 24;
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) sum += std::exp(z * (std::cos((i + 0.5) * std::numbers::pi / kPoints) - 1));
  return sum / kPoints;
}

}  // namespace

PatchAnswer gaussian_patch_answer(double distance_m, double sigma_m, double modulus_Pa, double poisson_ratio) {
  const double pi = std::numbers::pi, share = distance_m * distance_m / (2 * sigma_m * sigma_m);
  PatchAnswer answer;
  answer.inward_mpN = std::sqrt(pi / 2) * scaled_bessel_i0(0.5 * share) / (pi * modulus_Pa * sigma_m);
  if (distance_m > 0)
    answer.outward_mpN =
        (1 - 2 * poisson_ratio) / (2 * pi * (1 - poisson_ratio) * modulus_Pa) * std::expm1(-share) / distance_m;
  return answer;
}

}  // namespace palpate::elastic
