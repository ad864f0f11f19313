#include "config/fem/series_fit.h"

#include <algorithm>
#include <cmath>

#include "config/scene/config_error.h"

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

SeriesCoefficients kept_rising(const DepthOfForce& local, SeriesCoefficients c, double force_max_N) {
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

// Where the press is read, as shares of its range: from a quarter on, where half as many elements touch as at the end.
constexpr double kReadShares[] = {0.25, 0.5, 0.75, 1};

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
  return kept_rising(local, c, force_max_N);
}

SeriesCoefficients fit_series(const DepthOfForce& local, const std::vector<LoadPoint>& large, double force_max_N) {
  // Normal equations of rows (F, F^2) / d = (d - local(F)) / d, with force in units of the largest.
  double scale = 0;
  for (const LoadPoint& p : large) scale = std::max(scale, p.force_N);
  double m00 = 0, m01 = 0, m11 = 0, r0 = 0, r1 = 0;
  for (const LoadPoint& p : large) {
    if (!(p.force_N > 0 && p.depth_m > 0))
      throw ConfigError("series law: every state must be in contact, with positive depth and force");
    const double f = p.force_N / scale, w = 1 / (p.depth_m * p.depth_m), rest = p.depth_m - local(p.force_N);
    m00 += w * f * f;
    m01 += w * f * f * f;
    m11 += w * f * f * f * f;
    r0 += w * f * rest;
    r1 += w * f * f * rest;
  }
  const double determinant = m00 * m11 - m01 * m01;
  if (!(determinant > 1e-9 * m00 * m11)) throw ConfigError("series law: needs two or more states of different force");
  SeriesCoefficients c;
  c.c0_m_per_N = (r0 * m11 - r1 * m01) / (determinant * scale);
  c.c1_m_per_N2 = (m00 * r1 - m01 * r0) / (determinant * scale * scale);
  return kept_rising(local, c, force_max_N);
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
                       const PressMeshing& meshing) {
  std::vector<double> depths_m;
  for (const double share : kReadShares) depths_m.push_back(share * depth_max_m);
  SeriesBake bake;
  for (const PressPoint& p : press_as_far_as_possible(body, tool, StrainLaw::kNeoHookean, depths_m, meshing).points)
    bake.large.push_back({p.depth_m, p.force_N});
  if (bake.large.size() < 2)
    throw ConfigError("press: no equilibrium at depth " + std::to_string(1e3 * depths_m[bake.large.size()]) + " mm");
  // Force grows faster than depth, at most like its square in every law offered.
  const double beyond = depth_max_m / bake.large.back().depth_m;
  bake.coefficients = fit_series(local, bake.large, bake.large.back().force_N * beyond * beyond);
  return bake;
}

}  // namespace palpate::fem
