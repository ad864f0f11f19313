// How much sharper a ball is on a curved body.
#pragma once

#include "rt_core/base.h"

namespace palpate {

// 1 + k R of a ball of radius R on a body of mean curvature k, by which it is sharper against it than against a plane,
// as far as the law goes. The baker's targets (config/elastic) end there as well.
inline constexpr Real kLeastSharper = 0.25, kMostSharper = 16;
inline Real sharper(Real curvature_1_per_m, Real radius_m) PALPATE_RT {
  return clamp_to(1 + curvature_1_per_m * radius_m, kLeastSharper, kMostSharper);
}

}  // namespace palpate
