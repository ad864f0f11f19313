// The two unknown scales of the paper's force ratios.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

struct RatioScales {
  Real alpha = 0, beta = 0;
  bool minimum_norm = false;  // the columns are parallel: the smallest solution was taken
  bool solvable = false;      // false: both columns are zero, but there is a force to share
};

// Columns nearer to parallel than this (sine of the angle) are taken as parallel. Below it the two scales are the
// difference of nearly equal things: an anchor misplaced by 1 % of the body moves them by their own size.
inline constexpr Real kParallelSine = 1e-2;

// alpha u + beta v = f in the least-squares sense: three equations for two unknowns.
inline RatioScales solve_ratio_scales(Vec3 u, Vec3 v, Vec3 f) PALPATE_RT {
  RatioScales scales;
  scales.solvable = true;
  const Real uu = squared_norm(u);
  const Real vv = squared_norm(v);
  const Vec3 normal = cross(u, v);
  const Real area2 = squared_norm(normal);  // |u|^2 |v|^2 sin^2
  if (area2 > kParallelSine * kParallelSine * uu * vv) {
    // Least squares by the dual basis: cross products keep the digits that the normal equations would square away.
    scales.alpha = dot(cross(v, normal), f) / area2;
    scales.beta = dot(cross(normal, u), f) / area2;
  } else if (uu + vv > 0) {
    // Pseudo-inverse of a matrix of rank one: its transpose over its squared Frobenius norm.
    scales.minimum_norm = true;
    scales.alpha = dot(u, f) / (uu + vv);
    scales.beta = dot(v, f) / (uu + vv);
  } else {
    scales.solvable = !(squared_norm(f) > 0);  // no force, nothing to share
  }
  return scales;
}

}  // namespace palpate
