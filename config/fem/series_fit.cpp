#include "config/fem/series_fit.h"

#include <algorithm>
#include <cmath>

#include "config/config_error.h"

namespace palpate::fem {

namespace {

constexpr int kSamples = 64;  // of the force range, where the slope is checked

// The smallest local slope plus c0 and 2 c1 F over (0, force_max], as a share of the local slope there.
double smallest_slope_share(const DepthOfForce& local, const SeriesCoefficients& c, double force_max_N) {
  double smallest = 1;
  for (int i = 1; i <= kSamples; ++i) {
    const double f = force_max_N * i / kSamples, h = 0.5 * force_max_N / kSamples;
    const double slope = (local(f + h) - local(f - h)) / (2 * h);
    smallest = std::min(smallest, (slope + c.c0_m_per_N + 2 * c.c1_m_per_N2 * f) / slope);
  }
  return smallest;
}

// A fifth of the local compliance is left: the law then never gets stiffer than five times its tool on a half space.
constexpr double kSmallestSlopeShare = 0.2;

}  // namespace

DepthOfForce inverse_of(const ForceOfDepth& law, double depth_hint_m) {
  return [law, depth_hint_m](double force_N) {
    if (!(force_N > 0)) return 0.0;
    double low = 0, high = depth_hint_m;
    for (int i = 0; i < 60 && law(high) < force_N; ++i) high *= 2;
    for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
      const double middle = 0.5 * (low + high);
      (law(middle) < force_N ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
}

SeriesCoefficients fit_series(const DepthOfForce& local, const LoadPoint& linear, const LoadPoint& large,
                              double force_max_N) {
  if (!(linear.force_N > 0 && large.force_N > 0 && linear.depth_m > 0 && large.depth_m > 0))
    throw ConfigError("series law: both solves must end in contact, with positive depth and force");
  SeriesCoefficients c;
  c.c0_m_per_N = (linear.depth_m - local(linear.force_N)) / linear.force_N;
  c.c1_m_per_N2 =
      (large.depth_m - local(large.force_N) - c.c0_m_per_N * large.force_N) / (large.force_N * large.force_N);
  for (double* coefficient : {&c.c1_m_per_N2, &c.c0_m_per_N}) {
    if (smallest_slope_share(local, c, force_max_N) >= kSmallestSlopeShare) break;
    c.clamped = true;
    if (*coefficient >= 0) continue;
    double keep = 0, cut = 1;
    for (const double whole = *coefficient; cut - keep > 1e-6;) {
      const double middle = 0.5 * (keep + cut);
      *coefficient = middle * whole;
      (smallest_slope_share(local, c, force_max_N) >= kSmallestSlopeShare ? keep : cut) = middle;
    }
  }
  return c;
}

double series_depth_m(const DepthOfForce& local, const SeriesCoefficients& c, double force_N) {
  return local(force_N) + (c.c0_m_per_N + c.c1_m_per_N2 * force_N) * force_N;
}

double series_force_N(const DepthOfForce& local, const SeriesCoefficients& c, double depth_m) {
  double low = 0, high = 1e-6;
  for (int i = 0; i < 80 && series_depth_m(local, c, high) < depth_m; ++i) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (series_depth_m(local, c, middle) < depth_m ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

SeriesBake bake_series(const PressBody& body, const RigidTool& tool, const DepthOfForce& local, double depth_max_m,
                       int fine_count, double share) {
  const double depth = share * depth_max_m;
  const PressMeshing meshing = default_meshing(body, tool, depth, fine_count);
  const auto press = [&](StrainLaw law) {
    const PressPoint p = press_axisymmetric(body, tool, law, {depth}, meshing).points.back();
    return LoadPoint{p.depth_m, p.force_N};
  };
  SeriesBake bake;
  bake.linear = press(StrainLaw::kLinear);
  bake.large = press(StrainLaw::kNeoHookean);
  // Force grows faster than depth, at most like its square in every law offered.
  bake.coefficients = fit_series(local, bake.linear, bake.large, bake.large.force_N / (share * share));
  return bake;
}

}  // namespace palpate::fem
