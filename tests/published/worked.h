// Worked numbers of the published laws. Expected values are independent of the product: the published equations in
// 40-digit arithmetic (mpmath 1.x, sympy), or fractions.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "rt_core/vec.h"

namespace palpate::test {

// To 1e-9 of itself.
inline void expect_worked(double value, double exact, const char* what = "") {
  EXPECT_NEAR(value, exact, 1e-9 * std::abs(exact)) << what;
}
// To 1e-9 of its length: components may be zero.
inline void expect_worked(Vec3 value, Vec3 exact, const char* what = "") {
  EXPECT_LE(norm(value - exact), 1e-9 * norm(exact)) << what << ": " << value.x << ' ' << value.y << ' ' << value.z;
}

}  // namespace palpate::test
