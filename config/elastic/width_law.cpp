#include "config/elastic/width_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::elastic {

namespace {

constexpr double kHertzShare = 0.2;  // variance of Hertz' pressure, of a^2
// Travel under large strain, of that times a / R: bulk bodies in the prototype, 0.4 to 2.1 % without it.
constexpr double kLargeStrainShare = 0.02;
constexpr int kFitPoints = 24;
constexpr double kWidest = 0.98;  // of a ball's radius
// The series' tangent at the deepest depth keeps this share of the half space's.
constexpr double kLeastTangent = 0.3;

}  // namespace

WidthLaw::WidthLaw(const double (&give_mpN)[2], const double (&sigma_m)[2], double modulus_Pa) {
  const double narrow = sigma_m[0] * sigma_m[0], apart = sigma_m[1] * sigma_m[1] - narrow;
  is_layer_ = give_mpN[0] < give_mpN[1] && give_mpN[1] < 0;
  if (!is_layer_) {
    change_ = (give_mpN[0] - give_mpN[1]) / apart;
    narrow_mpN_ = give_mpN[0] + change_ * narrow;
    return;
  }
  const double inverse[2] = {1 / (give_mpN[0] * give_mpN[0]), 1 / (give_mpN[1] * give_mpN[1])};
  const double rise = (inverse[1] - inverse[0]) / apart, least = 4 * std::numbers::pi * modulus_Pa * modulus_Pa;
  // With the least b, 1/R0^2 = 1/R^2 - least sigma^2; where that leaves nothing the patches were wider than the layer
  // can tell, and the measured one stands as it is.
  const double at_none = inverse[0] - std::max(rise, least) * narrow;
  narrow_mpN_ = at_none > 0 ? -1 / std::sqrt(at_none) : give_mpN[0];
  change_ = std::max(rise, least) * narrow_mpN_ * narrow_mpN_;
}

double WidthLaw::give_mpN(double sigma_m) const {
  const double variance = sigma_m * sigma_m;
  return is_layer_ ? narrow_mpN_ / std::sqrt(1 + change_ * variance) : narrow_mpN_ - change_ * variance;
}

BallLaw::Point BallLaw::at(double a_m) const {
  const double r = radius_m, a = a_m;
  if (paraboloid) return {a * a / r, 4.0 / 3 * modulus_Pa * a * a * a / r, 4 * modulus_Pa * a * a / r};
  const double log = std::log((r + a) / (r - a));
  return {0.5 * a * log, modulus_Pa * (0.5 * (a * a + r * r) * log - a * r),
          2 * modulus_Pa * a * (0.5 * log + a * r / (r * r - a * a))};
}

double fit_beta(const BallLaw& ball, const WidthLaw& width, double c_mpN, double depth_max_m) {
  const double rho = std::max(-c_mpN, 0.0), narrow = width.give_mpN(0);
  const double m = 4.0 / 3 * ball.modulus_Pa * std::sqrt(ball.radius_m);
  const double by_beta = ball.radius_m * m * m;
  const auto more = [&](double a) { return width.give_mpN(std::sqrt(kHertzShare) * a) - narrow - rho; };
  const auto unplaced_N = [&](double depth) {  // by the half space's law
    double low = 0, high = kWidest * ball.radius_m;
    for (int i = 0; i < 50; ++i) (ball.at(0.5 * (low + high)).dent_m < depth ? low : high) = 0.5 * (low + high);
    return ball.at(low).force_N;
  };
  double above = 0, below = 0;
  for (int i = 1; i <= kFitPoints; ++i) {
    const double a = kWidest * ball.radius_m * i / kFitPoints, step = 1e-4 * a;
    const BallLaw::Point p = ball.at(a);
    const double slope = (more(a + step) - more(a - step)) / (2 * step);
    const double depth = p.dent_m * (1 + kLargeStrainShare * a / ball.radius_m) + p.force_N * more(a) +
                         0.5 * p.force_N * p.force_N * slope / p.force_slope_Npm;
    if (!(depth > 0)) continue;
    if (depth > depth_max_m) break;
    const double root = std::sqrt(depth), z = rho * m * root;
    const double series = unplaced_N(depth) + m * depth * root * z * (1.5 + 2.625 * z);
    const double gain = by_beta * depth * depth * depth / p.force_N;
    above += gain * (p.force_N - series) / p.force_N;
    below += gain * gain;
  }
  if (!(below > 0)) return 0;
  const double root = std::sqrt(depth_max_m), z = rho * m * root;
  // d/dD of f (1.5 + 3 z + 6.5625 z^2) / D + 3 beta R m^2 D^2.
  const double tangent = m * root * ((1 - kLeastTangent) * 1.5 + 3 * z + 6.5625 * z * z);
  return std::max(above / below, -tangent / (3 * by_beta * depth_max_m * depth_max_m));
}

}  // namespace palpate::elastic
