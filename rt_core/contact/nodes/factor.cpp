#include "rt_core/contact/nodes/factor.h"

#include <utility>

#include "rt_core/vec.h"

namespace palpate {

namespace {

// Vectors of four rows that fit into the registers at once, with a factor and a product beside them.
constexpr int kMostRows = 12;

// Rows [row, row + 4 B) of column j minus what the columns before it explain. Written out by `b` = 0 .. B - 1, because
// a loop over them keeps the sums in memory.
template <int... b>
void reduce_rows(ContactFactor& factor, std::int32_t j, std::int32_t row, std::integer_sequence<int, b...>) PALPATE_RT {
  double* column = factor.column[j] + row;
  Double4 rest[] = {load4(column + 4 * b)...};
  const double* before = factor.column[0] + row;
  const double* scale = factor.column[0] + j;
  std::int32_t k = j % 2;
  if (k == 1) {
    const Double4 s = splat4(*scale);
    ((rest[b] -= load4(before + 4 * b) * s), ...);
    before += kContactStride;
    scale += kContactStride;
  }
  for (; k < j; k += 2) {  // bound: kMaxContacts / 2; two at a time, or a third of it would be counting
    const Double4 s = splat4(scale[0]), t = splat4(scale[kContactStride]);
    ((rest[b] -= load4(before + 4 * b) * s), ...);
    ((rest[b] -= load4(before + kContactStride + 4 * b) * t), ...);
    before += 2 * kContactStride;
    scale += 2 * kContactStride;
  }
  (store(column + 4 * b, rest[b]), ...);
}

// The same for `vectors` vectors of rows, 1 to kMostRows.
void reduce(ContactFactor& factor, std::int32_t j, std::int32_t row, std::int32_t vectors) PALPATE_RT {
  switch (vectors) {
    case 1:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 1>());
    case 2:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 2>());
    case 3:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 3>());
    case 4:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 4>());
    case 5:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 5>());
    case 6:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 6>());
    case 7:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 7>());
    case 8:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 8>());
    case 9:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 9>());
    case 10:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 10>());
    case 11:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, 11>());
    default:
      return reduce_rows(factor, j, row, std::make_integer_sequence<int, kMostRows>());
  }
}

// Divides column j by its pivot, and clears what lies above the diagonal in its first vector.
void finish_column(ContactFactor& factor, std::int32_t j, std::int32_t rows) PALPATE_RT {
  double* column = factor.column[j];
  const double pivot = square_root(column[j]), inverse = 1.0 / pivot;
  const Double4 s = splat4(inverse);
  factor.inverse_pivot[j] = inverse;
  std::int32_t row = j / 4 * 4;
  for (std::int32_t i = row; i < j; ++i) column[i] = 0;                       // bound: 3
  for (; row < rows; row += 4) store(column + row, load4(column + row) * s);  // bound: kMaxContacts / 4
  column[j] = pivot;
}

}  // namespace

bool factorise(ContactFactor& factor) PALPATE_RT {
  const std::int32_t rows = whole_lanes(factor.n, 4);
  for (std::int32_t j = 0; j < factor.n; ++j) {  // bound: kMaxContacts
    const double scale = factor.column[j][j];
    std::int32_t row = j / 4 * 4, left = (rows - row) / 4;
    if (left > kMostRows) {
      reduce(factor, j, row, left - kMostRows);
      row += 4 * (left - kMostRows);
      left = kMostRows;
    }
    reduce(factor, j, row, left);
    const double pivot2 = factor.column[j][j];
    if (!(pivot2 > 1e-13 * scale && pivot2 < kHuge * kHuge)) return false;
    finish_column(factor, j, rows);
  }
  return true;
}

// Four columns at a time: their own triangle one by one, and the rows below (before, for the transpose) by vectors.
void solve_lower(const ContactFactor& factor, double* x) PALPATE_RT {
  const std::int32_t rows = whole_lanes(factor.n, 4);
  for (std::int32_t k = 0; k < factor.n; k += 4) {  // bound: kMaxContacts / 4
    const std::int32_t columns = factor.n - k < 4 ? factor.n - k : 4;
    double v[4] = {};
    for (std::int32_t a = 0; a < columns; ++a) {  // bound: 4
      v[a] = x[k + a];
      for (std::int32_t b = 0; b < a; ++b) v[a] -= factor.column[k + b][k + a] * v[b];
      v[a] *= factor.inverse_pivot[k + a];
    }
    store(x + k, Double4{v[0], v[1], v[2], v[3]});
    const Double4 s0 = splat4(v[0]), s1 = splat4(v[1]), s2 = splat4(v[2]), s3 = splat4(v[3]);
    const double* column = factor.column[k];
    for (std::int32_t row = k + 4; row < rows; row += 4) {  // bound: kMaxContacts / 4
      store(x + row, load4(x + row) - load4(column + row) * s0 - load4(column + kContactStride + row) * s1 -
                         load4(column + 2 * kContactStride + row) * s2 - load4(column + 3 * kContactStride + row) * s3);
    }
  }
}

void solve_upper(const ContactFactor& factor, double* x) PALPATE_RT {
  const std::int32_t rows = whole_lanes(factor.n, 4);
  for (std::int32_t k = rows - 4; k >= 0; k -= 4) {  // bound: kMaxContacts / 4
    const double* column = factor.column[k];
    Double4 along[4] = {};
    for (std::int32_t row = k + 4; row < rows; row += 4) {  // bound: kMaxContacts / 4; rows from n on are zero
      const Double4 v = load4(x + row);
      along[0] += load4(column + row) * v;
      along[1] += load4(column + kContactStride + row) * v;
      along[2] += load4(column + 2 * kContactStride + row) * v;
      along[3] += load4(column + 3 * kContactStride + row) * v;
    }
    transpose(along);
    const Double4 below = (along[0] + along[1]) + (along[2] + along[3]);
    for (std::int32_t a = (factor.n - k < 4 ? factor.n - k : 4) - 1; a >= 0; --a) {  // bound: 4
      double rest = x[k + a] - below[a];
      for (std::int32_t b = a + 1; b < 4; ++b) rest -= factor.column[k + a][k + b] * x[k + b];
      x[k + a] = rest * factor.inverse_pivot[k + a];
    }
  }
}

void solve_lower(const ContactFactor& factor, FactorRow* x) PALPATE_RT {
  for (std::int32_t i = 0; i < factor.n; ++i) {  // bound: kMaxContacts
    Double4 low = load4(x[i].entry), high = load4(x[i].entry + 4);
    const auto reduce = [&](std::int32_t k) PALPATE_RT {
      const Double4 s = splat4(factor.column[k][i]);
      low -= load4(x[k].entry) * s;
      high -= load4(x[k].entry + 4) * s;
    };
    std::int32_t k = 0;
    for (; k + 4 <= i; k += 4) {  // bound: kMaxContacts / 4; unrolled, or half of it would be counting
      reduce(k);
      reduce(k + 1);
      reduce(k + 2);
      reduce(k + 3);
    }
    for (; k < i; ++k) reduce(k);  // bound: 3
    const Double4 inverse = splat4(factor.inverse_pivot[i]);
    store(x[i].entry, low * inverse);
    store(x[i].entry + 4, high * inverse);
  }
}

void remove_unknown(ContactFactor& factor, std::int32_t gone) PALPATE_RT {
  const std::int32_t rows = whole_lanes(factor.n, 4);
  alignas(32) double v[kContactStride];
  for (std::int32_t row = gone / 4 * 4; row < rows; row += 4) store(v + row, load4(factor.column[gone] + row));
  for (std::int32_t i = gone / 4 * 4; i <= gone; ++i) v[i] = 0;                           // bound: 4
  for (std::int32_t k = 0; k < gone; ++k) factor.column[k][gone] = 0;                     // bound: kMaxContacts
  for (std::int32_t i = gone; i < rows; ++i) factor.column[gone][i] = i == gone ? 1 : 0;  // bound: kMaxContacts
  factor.inverse_pivot[gone] = 1;
  for (std::int32_t k = gone + 1; k < factor.n; ++k) {  // bound: kMaxContacts
    double* column = factor.column[k];
    const double old = column[k], pivot = square_root(old * old + v[k] * v[k]);
    const double cosine = old / pivot, sine = v[k] / pivot;
    const Double4 c = splat4(cosine), s = splat4(sine);
    for (std::int32_t row = k / 4 * 4; row < rows; row += 4) {  // bound: kMaxContacts / 4; v is zero above row k
      const Double4 a = load4(column + row), b = load4(v + row);
      store(column + row, a * c + b * s);
      store(v + row, b * c - a * s);
    }
    column[k] = pivot;
    for (std::int32_t i = k / 4 * 4; i <= k; ++i) v[i] = 0;  // bound: 4
    factor.inverse_pivot[k] = 1.0 / pivot;
  }
}

}  // namespace palpate
