// Cholesky factors of up to kMaxContacts unknowns, column by column, four rows at a time.
#pragma once

#include "rt_core/lanes.h"
#include "rt_core/limits.h"

namespace palpate {

// Rows and columns of every matrix of the contact problem: whole lanes, and the same stride for all sizes.
inline constexpr std::int32_t kContactStride = kMaxContacts;
static_assert(kContactStride % 16 == 0, "rows are handled four, eight and sixteen at a time");

// Lower triangle, column-major with stride kContactStride. Before factorise(): entries above the diagonal, and from row
// n to the end of its vector, are finite. After it those above the diagonal are zero as far as its vector reaches.
struct ContactFactor {
  alignas(32) double column[kMaxContacts][kContactStride];
  double inverse_pivot[kMaxContacts];
  std::int32_t n = 0;
};
// One unknown of several right-hand sides.
struct FactorRow {
  alignas(32) double entry[8];
};

// Replaces the lower triangle of `factor` by its Cholesky factor. False, with `factor` spoiled, when a pivot is not
// clearly positive or not a number. Rows from n on must be zero. Bound: n^3 / 6 multiplications.
bool factorise(ContactFactor& factor) PALPATE_RT;
// x becomes L^-1 x. `x` holds kContactStride numbers, those from n on zero.
void solve_lower(const ContactFactor& factor, double* x) PALPATE_RT;
// x becomes L^-T x.
void solve_upper(const ContactFactor& factor, double* x) PALPATE_RT;
// L^-1 of eight right-hand sides at once.
void solve_lower(const ContactFactor& factor, FactorRow* x) PALPATE_RT;
// Takes an unknown out of the matrix: afterwards its row and column are those of the identity, so that it stays zero
// where the right-hand side is. A rank-one update of the columns behind it. Bound: 3 n^2 multiplications.
void remove_unknown(ContactFactor& factor, std::int32_t gone) PALPATE_RT;

}  // namespace palpate
