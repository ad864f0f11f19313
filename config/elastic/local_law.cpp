#include "config/elastic/local_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::elastic {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLargeStrainShare = 0.02;

// A sphere of radius 1 on curvature k (its radius as the unit of length), unit modulus.
struct Dent {
  double travel, force, travel_slope, force_slope;  // slopes in a
};
Dent sphere_dent(double a, double k) {
  const double log = std::log1p(2 * a / (1 - a));
  const double travel = 0.5 * a * log + k * a * a, stretch = 1 + kLargeStrainShare * a;
  const double slope = 0.5 * log + a / (1 - a * a) + 2 * k * a;
  // dF = 2 E* a d(travel of the half space): the flat punch's stiffness.
  return {travel * stretch, 0.5 * (a * a + 1) * log - a + 4.0 / 3 * k * a * a * a,
          slope * stretch + travel * kLargeStrainShare, 2 * a * slope};
}
// A paraboloid of unit curvature: a flat face on a round body.
Dent paraboloid_dent(double a) { return {a * a, 4.0 / 3 * a * a * a, 2 * a, 4 * a * a}; }

template <class Law>
LocalLaw::State invert(const Law& law, double force, double highest) {
  double low = 0, high = highest, a = std::min(0.5 * highest, std::cbrt(0.75 * force));
  for (int i = 0; i < 100; ++i) {
    const Dent d = law(a);
    (d.force > force ? high : low) = a;
    const double next = a - (d.force - force) / d.force_slope;
    const double before = a;
    a = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(a - before) <= 1e-15 * a) break;
  }
  // int travel dF over a, five Gauss points: the integrand is a fourth power with small corrections.
  constexpr std::array<double, 5> kPlace = {-0.906179845938664, -0.538469310105683, 0, 0.538469310105683,
                                            0.906179845938664};
  constexpr std::array<double, 5> kWeight = {0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366,
                                             0.236926885056189};
  LocalLaw::State out;
  for (std::size_t i = 0; i < 5; ++i) {
    const Dent d = law(0.5 * a * (1 + kPlace[i]));
    out.work_J += 0.5 * a * kWeight[i] * d.travel * d.force_slope;
  }
  const Dent d = law(a);
  out.travel_m = d.travel;
  out.compliance_mpN = d.travel_slope / d.force_slope;
  out.radius_m = a;
  return out;
}

}  // namespace

LocalLaw::State LocalLaw::at(double force_N) const {
  if (!(force_N > 0)) return {0, std::numeric_limits<double>::infinity(), 0, 0};
  const double sum = tool_curvature_1pm + body_curvature_1pm;
  if (plane) {
    const double a = std::min(std::sqrt(4 * force_N / (kPi * modulus * sum)), length_m),
                 log = std::log(2 * length_m / a), share = force_N / (kPi * modulus);
    return {share * (2 * log + 1), 2 * log / (kPi * modulus), share * force_N * (log + 0.75), a};
  }
  // In units of the radius and of E*: force in E* R^2, work in E* R^3.
  const double unit = tool_curvature_1pm > 0 ? 1 / tool_curvature_1pm : 1 / sum;
  const double force = force_N / (modulus * unit * unit), k = body_curvature_1pm * unit;
  State s = tool_curvature_1pm > 0 ? invert([k](double a) { return sphere_dent(a, k); }, force, 1 - 1e-12)
                                   : invert([](double a) { return paraboloid_dent(a); }, force, 1e6);
  s.travel_m *= unit;
  s.compliance_mpN /= modulus * unit;
  s.work_J *= modulus * unit * unit * unit;
  s.radius_m *= unit;
  return s;
}

double gaussian_self_compliance_mpN(bool plane, double modulus, double sigma_m, double length_m) {
  // Two points drawn from the patch are a Gaussian of sqrt(2) sigma apart: mean of 1/r in the plane of the surface
  // sqrt(pi/2) / (sqrt(2) sigma), mean of ln r on the line ln(sigma) - gamma / 2.
  if (plane) return -2 / (kPi * modulus) * (std::log(sigma_m / length_m) - 0.5 * std::numbers::egamma);
  return std::sqrt(kPi / 2) / (std::sqrt(2.0) * sigma_m) / (kPi * modulus);
}

}  // namespace palpate::elastic
