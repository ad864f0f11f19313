// How far one force curve is from another, in what a hand can tell.
#pragma once

#include <string>
#include <vector>

#include "rt_core/vec.h"

namespace palpate {

// Forces over a rising abscissa: depth in metres, time in seconds or a row's number.
struct ForcePath {
  std::vector<double> x;
  std::vector<Vec3> force_N;
};

// Differences that people just notice: force 6 to 7 % (Pang, Tan & Durlach 1991), stiffness 8 to 22 % (Jones & Hunter
// 1990).
inline constexpr double kForceNoticed = 0.07, kStiffnessNoticed = 0.15;
// Errors are relative to the reference, but to no less than this share of its largest force or slope.
inline constexpr double kErrorFloor = 0.05;

struct CurveError {
  double force_rms = 0, force_largest = 0;  // relative; the largest keeps its sign
  double at_largest = 0;                    // where, abscissa
  double stiffness_rms = 0, stiffness_largest = 0;
  double direction_rad = 0;                             // largest angle, where the force is above the floor
  double energy = 0;                                    // relative error of the area under the curve
  double force_unnoticed = 0, stiffness_unnoticed = 0;  // share of the path below the thresholds
  double from = 0, to = 0;                              // of the abscissa, both curves have it
  std::vector<double> x, relative;                      // signed error of the force's size along the path
};

// `other` against `reference`, at the reference's points that both cover; between points `other` is a straight line.
// Throws std::runtime_error when fewer than three points are common.
CurveError curve_error(const ForcePath& reference, const ForcePath& other);

// Largest step of the size of the force from one tick to the next beyond a straight line through the `kTrendTicks` on
// either side: what a facet's edge or a wrong solution adds to a smooth motion.
inline constexpr int kTrendTicks = 8;
double largest_step_N(const std::vector<Vec3>& force_N);

}  // namespace palpate
