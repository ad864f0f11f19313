// In-place Cholesky factorisation of small symmetric positive definite systems; why not Eigen's:
// docs/decisions/0006-libraries-of-the-tick.md. Inner loops are unrolled: a tick solves two systems of six, and half of
// them was counting (700 to 1,100 instructions a tick, 2026-11-22). The order of the sums, and so the bits, stay as
// written.
#pragma once

#include <cstdint>

#include "rt_core/vec.h"

namespace palpate {

// Replaces the lower triangle of the row-major n x n matrix `a` by its Cholesky factor. Returns false, with `a`
// spoiled, when a pivot is not clearly positive (or is NaN). `count` may be known to the compiler, which then leaves no
// loop of up to six: a tick balances its tool twice with six unknowns, at 530 instructions a factor of which 300
// counted (2026-11-26). Bound: n^3/6 multiply-adds.
template <class Count>
inline bool cholesky_factor(Real* a, Count count) PALPATE_RT {
  const std::int32_t n = count;
#pragma GCC unroll 6
  for (std::int32_t j = 0; j < n; ++j) {
    Real diagonal = a[j * n + j];
    const Real scale = diagonal;
#pragma GCC unroll 6
    for (std::int32_t k = 0; k < j; ++k) diagonal -= a[j * n + k] * a[j * n + k];
    if (!(diagonal > 1e-14 * scale && diagonal < kHuge * kHuge)) return false;
    const Real pivot = square_root(diagonal);
    a[j * n + j] = pivot;
    const Real inverse = 1.0 / pivot;
#pragma GCC unroll 6
    for (std::int32_t i = j + 1; i < n; ++i) {
      Real sum = a[i * n + j];
#pragma GCC unroll 6
      for (std::int32_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      a[i * n + j] = sum * inverse;
    }
  }
  return true;
}

// Solves (L L^T) x = b in place, with L from cholesky_factor.
template <class Count>
inline void cholesky_solve(const Real* factor, Real* b, Count count) PALPATE_RT {
  const std::int32_t n = count;
#pragma GCC unroll 6
  for (std::int32_t i = 0; i < n; ++i) {
    Real sum = b[i];
#pragma GCC unroll 6
    for (std::int32_t k = 0; k < i; ++k) sum -= factor[i * n + k] * b[k];
    b[i] = sum / factor[i * n + i];
  }
#pragma GCC unroll 6
  for (std::int32_t i = n - 1; i >= 0; --i) {
    Real sum = b[i];
#pragma GCC unroll 6
    for (std::int32_t k = i + 1; k < n; ++k) sum -= factor[k * n + i] * b[k];
    b[i] = sum / factor[i * n + i];
  }
}

}  // namespace palpate
