#include "rt_core/nodal/factor.h"

#include "rt_core/vec.h"

namespace palpate {

namespace {

// Rows [row, row + 4 B) of column j minus what the columns before it explain.
template <int B>
void reduce_rows(ContactFactor& factor, std::int32_t j, std::int32_t row) PALPATE_RT {
  Double4 rest[B];
  double* column = factor.column[j];
  for (int b = 0; b < B; ++b) rest[b] = load4(column + row + 4 * b);  // bound: B
  for (std::int32_t k = 0; k < j; ++k) {                              // bound: kMaxContacts
    const double* before = factor.column[k];
    const Double4 s = splat4(before[j]);
    for (int b = 0; b < B; ++b) rest[b] -= load4(before + row + 4 * b) * s;
  }
  for (int b = 0; b < B; ++b) store(column + row + 4 * b, rest[b]);
}

}  // namespace

bool factorise(ContactFactor& factor) PALPATE_RT {
  const std::int32_t rows = whole_lanes(factor.n, 4);
  for (std::int32_t j = 0; j < factor.n; ++j) {  // bound: kMaxContacts
    double* column = factor.column[j];
    const double scale = column[j];
    std::int32_t row = j / 4 * 4;
    for (; row + 16 <= rows; row += 16) reduce_rows<4>(factor, j, row);  // bound: kMaxContacts / 16
    for (; row + 8 <= rows; row += 8) reduce_rows<2>(factor, j, row);    // bound: 1
    for (; row < rows; row += 4) reduce_rows<1>(factor, j, row);         // bound: 1
    if (!(column[j] > 1e-13 * scale && column[j] < kHuge * kHuge)) return false;
    const double pivot = square_root(column[j]), inverse = 1.0 / pivot;
    factor.inverse_pivot[j] = inverse;
    for (row = j / 4 * 4; row < rows; row += 4)  // bound: kMaxContacts / 4
      store(column + row, load4(column + row) * splat4(inverse));
    column[j] = pivot;
  }
  return true;
}

void solve_lower(const ContactFactor& factor, double* x) PALPATE_RT {
  const std::int32_t rows = whole_lanes(factor.n, 4);
  for (std::int32_t k = 0; k < factor.n; ++k) {  // bound: kMaxContacts
    const double value = x[k] * factor.inverse_pivot[k];
    const std::int32_t first = k / 4 * 4;
    double kept[4];
    for (std::int32_t i = first; i <= k; ++i) kept[i - first] = x[i];  // bound: 4; rows above the diagonal stay
    const Double4 s = splat4(value);
    for (std::int32_t row = first; row < rows; row += 4)  // bound: kMaxContacts / 4
      store(x + row, load4(x + row) - load4(factor.column[k] + row) * s);
    for (std::int32_t i = first; i < k; ++i) x[i] = kept[i - first];
    x[k] = value;
  }
}

void solve_upper(const ContactFactor& factor, double* x) PALPATE_RT {
  const std::int32_t rows = whole_lanes(factor.n, 4);
  for (std::int32_t k = factor.n - 1; k >= 0; --k) {  // bound: kMaxContacts
    const std::int32_t whole = whole_lanes(k + 1, 4);
    double rest = x[k];
    for (std::int32_t i = k + 1; i < whole && i < factor.n; ++i) rest -= factor.column[k][i] * x[i];  // bound: 3
    Double4 along{};
    for (std::int32_t row = whole; row < rows; row += 4)  // bound: kMaxContacts / 4; rows from n on are zero
      along += load4(factor.column[k] + row) * load4(x + row);
    x[k] = (rest - sum(along)) * factor.inverse_pivot[k];
  }
}

}  // namespace palpate
