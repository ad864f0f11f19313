// Cholesky factors of up to kMaxContacts unknowns, column by column, four rows at a time.
#pragma once

#include "rt_core/limits.h"
#include "rt_core/nodal/lanes.h"

namespace palpate {

// Rows and columns of every matrix of the contact problem: whole lanes, and the same stride for all sizes.
inline constexpr std::int32_t kContactStride = kMaxContacts;
static_assert(kContactStride % 8 == 0, "rows are handled four and eight at a time");

// Lower triangle, column-major with stride kContactStride; entries above the diagonal and below row n are finite.
struct ContactFactor {
  alignas(32) double column[kMaxContacts][kContactStride];
  double inverse_pivot[kMaxContacts];
  std::int32_t n = 0;
};

// Replaces the lower triangle of `factor` by its Cholesky factor. False, with `factor` spoiled, when a pivot is not
// clearly positive or not a number. Bound: n^3 / 6 multiplications.
bool factorise(ContactFactor& factor) PALPATE_RT;
// x becomes L^-1 x. `x` holds kContactStride numbers, those from n on finite.
void solve_lower(const ContactFactor& factor, double* x) PALPATE_RT;
// x becomes L^-T x.
void solve_upper(const ContactFactor& factor, double* x) PALPATE_RT;

}  // namespace palpate
