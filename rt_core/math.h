// Elementary functions with the same bits on every compiler and C library: libm's differ between versions. Written from
// argument reduction and polynomials in plain IEEE arithmetic; each states its range and measured error.
#pragma once

#include "rt_core/lanes.h"

namespace palpate::math {

Real exp(Real x) PALPATE_RT;
Real log(Real x) PALPATE_RT;          // x > 0; otherwise -kHuge
Real pow(Real x, Real y) PALPATE_RT;  // x >= 0
Real cbrt(Real x) PALPATE_RT;
Real sin(Real x) PALPATE_RT;  // |x| <= 1e4
Real cos(Real x) PALPATE_RT;  // |x| <= 1e4
// Both of four numbers, to the bit; beyond that range of 0.
struct SinCos4 {
  Double4 sin, cos;
};
SinCos4 sin_cos(const Double4& x) PALPATE_RT;
// cbrt() of four numbers from 1e-300 to 1e300.
Double4 cube_roots(const Double4& x) PALPATE_RT;
Real atan2(Real y, Real x) PALPATE_RT;
Real asin(Real x) PALPATE_RT;  // clamped to [-1, 1]
Real acos(Real x) PALPATE_RT;  // clamped to [-1, 1]

}  // namespace palpate::math
