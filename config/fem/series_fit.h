// The series law: tool travel = local indentation + c0 F + c1 F^2. The local part is the analytic law of the tool's
// shape, c0 the far field's compliance, c1 its change at large strain. It derives from the complementary energy
// integral of travel dF, so a closed loop returns no energy.
#pragma once

#include <functional>

#include "config/fem/axisymmetric_press.h"

namespace palpate::fem {

using DepthOfForce = std::function<double(double force_N)>;  // rises from 0 at 0
using ForceOfDepth = std::function<double(double depth_m)>;  // rises from 0 at 0

// Inverts a rising law of the depth (its force, or the travel it makes) by bisection, to rounding; `depth_hint_m` is
// any positive length of its range.
DepthOfForce inverse_of(const ForceOfDepth& law, double depth_hint_m);

struct LoadPoint {
  double depth_m = 0;
  double force_N = 0;
};
struct SeriesCoefficients {
  double c0_m_per_N = 0;
  double c1_m_per_N2 = 0;
  bool clamped = false;  // the fit had no positive stiffness somewhere on [0, force_max] and was cut back
};
// From one linear and one large-strain solve of the same press, at about 0.6 of the range: for bodies whose walls bend,
// where the local indentation is a small part of the travel. Both coefficients may be negative (a bonded block is
// stiffer than the half space of its local law) as long as travel rises with force up to `force_max_N`: c1 is cut back
// first, then c0.
SeriesCoefficients fit_series(const DepthOfForce& local, const LoadPoint& linear, const LoadPoint& large,
                              double force_max_N);
// Both from two or more large-strain states of one press, least squares of the travel's relative error. For thick
// bodies: the strain under a ball grows like sqrt(d), so large strain changes its travel by a share of d^1.5, which is
// a share of F. That belongs to c0, where no linear solve sees it.
SeriesCoefficients fit_series(const DepthOfForce& local, const std::vector<LoadPoint>& large, double force_max_N);

double series_depth_m(const DepthOfForce& local, const SeriesCoefficients& c, double force_N);
double series_force_N(const DepthOfForce& local, const SeriesCoefficients& c, double depth_m);

// Large-strain press of a body of revolution to `depth_max_m`, read at quarters of it, and the fit to its states. A
// press that finds no equilibrium further on is taken as far as it came, if that is half way or more: beyond, the law
// is then its continuation. Throws ConfigError otherwise.
struct SeriesBake {
  SeriesCoefficients coefficients;
  std::vector<LoadPoint> large;
};
SeriesBake bake_series(const PressBody& body, const RigidTool& tool, const DepthOfForce& local, double depth_max_m,
                       const PressMeshing& meshing);

}  // namespace palpate::fem
