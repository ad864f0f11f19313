#include "rt_core/math.h"

#include "rt_core/vec.h"

// Measured against the C library's long double functions (2026-11-21, a million random arguments each, swept again by
// tests/force/test_math.cpp): relative error of log 1.2e-16, exp, pow 1.5e-16, cbrt 1.9e-16, atan2 2.9e-16, asin, acos
// 4.4e-16; absolute error of sin, cos 1.2e-16 for |x| <= 1e4. Nothing here returns NaN or infinity: a NaN argument
// gives 0 (exp, pow, cbrt, sin, atan2, asin), 1 (cos), pi/2 (acos) or -kHuge (log); overflow gives the largest finite
// number.
namespace palpate::math {

namespace {

constexpr Real kLargest = std::numeric_limits<Real>::max();
constexpr Real kSmallestNormal = std::numeric_limits<Real>::min();
constexpr Real kTwo54 = 18014398509481984.0;
// ln 2 in two parts: the first has 42 bits, so its product with any exponent is exact.
constexpr Real kLn2High = 0x1.62e42fefa3800p-1, kLn2Low = 0x1.ef35793c76730p-45, kInverseLn2 = 0x1.71547652b82fep+0;
// pi/2 in three parts; the first two have 36 bits, so their products with up to 17-bit counts are exact.
constexpr Real kHalfPi1 = 0x1.921fb54440000p+0, kHalfPi2 = 0x1.68c234c4c0000p-39, kHalfPi3 = 0x1.98a2e03707345p-77;
constexpr Real kTwoOverPi = 0x1.45f306dc9c883p-1;
constexpr Real kPiLow = 0x1.1a62633145c07p-53;

std::uint64_t bits_of(Real x) PALPATE_RT { return std::bit_cast<std::uint64_t>(x); }

// 2^k for -1022 <= k <= 1023.
Real two_to(std::int32_t k) PALPATE_RT {
  return std::bit_cast<Real>(static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + 1023) << 52);
}

// x = mantissa * 2^exponent, mantissa in [1, 2). x > 0 and finite; subnormals included.
struct Split {
  Real mantissa;
  std::int32_t exponent;
};
Split split(Real x) PALPATE_RT {
  const bool tiny = x < kSmallestNormal;
  const std::uint64_t bits = bits_of(tiny ? x * kTwo54 : x);
  const std::uint64_t fraction = bits & 0x000fffffffffffffull;
  const std::int32_t exponent = static_cast<std::int32_t>(bits >> 52) - 1023 - (tiny ? 54 : 0);
  return {std::bit_cast<Real>(fraction | 0x3ff0000000000000ull), exponent};
}

// Nearest integer, halves away from zero. |x| < 2^62.
std::int64_t nearest(Real x) PALPATE_RT { return static_cast<std::int64_t>(x + (x < 0 ? -0.5 : 0.5)); }

// Unevaluated sum of two numbers, |low| below one unit in the last place of high.
struct Pair {
  Real high, low;
};
// Exact product (Veltkamp's split, Dekker 1971): no fused multiply-add, which not every target has. |a|, |b| < 1e150.
Pair exact_product(Real a, Real b) PALPATE_RT {
  constexpr Real kSplitter = 134217729.0;  // 2^27 + 1
  const Real a_scaled = kSplitter * a, b_scaled = kSplitter * b;
  const Real a_high = a_scaled - (a_scaled - a), b_high = b_scaled - (b_scaled - b);
  const Real a_low = a - a_high, b_low = b - b_high;
  const Real product = a * b;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

// sum_{n = 0}^{Terms - 1} z^n / (2 n + 3): tail of the atanh series; with alternating sign, of the atan series.
template <int Terms>
Real odd_reciprocal_series(Real z) PALPATE_RT {
  constexpr Real kCoefficient[12] = {1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11, 1.0 / 13,
                                     1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23, 1.0 / 25};
  static_assert(Terms <= 12);
  Real sum = 0;
  for (int n = Terms - 1; n >= 0; --n) sum = sum * z + kCoefficient[n];  // bound: Terms
  return sum;
}

// log x to about 60 bits. x = 2^k m with m in [sqrt(1/2), sqrt(2)], log m = 2 atanh s, s = (m - 1)/(m + 1), |s| <
// 0.172; the first omitted term is below 1e-17 of the sum. x > 0, finite.
Pair log_pair(Real x) PALPATE_RT {
  Split part = split(x);
  if (part.mantissa > 1.4142135623730951) part = {0.5 * part.mantissa, part.exponent + 1};
  const Real numerator = part.mantissa - 1.0;  // exact
  const Real denominator = part.mantissa + 1.0;
  const Real denominator_low = part.mantissa - (denominator - 1.0);  // exact: what the line above rounded off
  const Real s = numerator / denominator;
  const Pair back = exact_product(s, denominator);
  const Real s_low = (((numerator - back.high) - back.low) - s * denominator_low) / denominator;
  const Real z = s * s;
  const Real tail = 2.0 * (s_low + s * z * odd_reciprocal_series<11>(z));
  const Real k = static_cast<Real>(part.exponent);
  const Real scaled = k * kLn2High;  // exact; larger than 2 s unless it is zero
  const Real sum = scaled + 2.0 * s;
  const Real low = ((scaled - sum) + 2.0 * s) + (k * kLn2Low + tail);
  const Real high = sum + low;
  return {high, (sum - high) + low};
}

// exp(high + low) by k = round(x / ln 2) and the Taylor series on |r| <= 0.35 (first omitted term 4e-18).
Real exp_of(Real high, Real low) PALPATE_RT {
  if (high > 709.782712893384) return kLargest;
  if (!(high > -745.2)) return 0.0;
  constexpr Real kInverseFactorial[12] = {1.0 / 2,       1.0 / 6,        1.0 / 24,        1.0 / 120,
                                          1.0 / 720,     1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                                          1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
  const std::int32_t k = static_cast<std::int32_t>(nearest(high * kInverseLn2));
  const Real r = (high - k * kLn2High) + (low - k * kLn2Low);
  Real sum = 0;
  for (int n = 11; n >= 0; --n) sum = sum * r + kInverseFactorial[n];  // bound: 12
  const Real mantissa = 1.0 + (r + r * r * sum);
  const std::int32_t half = k / 2;  // two factors, so that neither 2^1024 nor a subnormal is formed too early
  const Real result = mantissa * two_to(half) * two_to(k - half);
  return result <= kLargest ? result : kLargest;
}

// x = quarter * pi/2 + r, |r| <= pi/4.
struct Reduced {
  Real r;
  std::int64_t quarter;
};
Reduced reduce(Real x) PALPATE_RT {
  const std::int64_t n = nearest(x * kTwoOverPi);
  const Real k = static_cast<Real>(n);
  return {((x - k * kHalfPi1) - k * kHalfPi2) - k * kHalfPi3, n};
}

// Taylor series on |r| <= pi/4; first omitted terms 8e-20 and 2e-18. Of one number or of four, with the same bits.
template <class Number>
Number sin_series(const Number& r) PALPATE_RT {
  constexpr Real kCoefficient[8] = {-1.0 / 6,        1.0 / 120,          -1.0 / 5040,          1.0 / 362880,
                                    -1.0 / 39916800, 1.0 / 6227020800.0, -1.0 / 1307674368000, 1.0 / 355687428096000};
  const Number z = r * r;
  Number sum{};
  for (int n = 7; n >= 0; --n) sum = sum * z + kCoefficient[n];  // bound: 8
  return r + r * z * sum;
}
template <class Number>
Number cos_series(const Number& r) PALPATE_RT {
  constexpr Real kCoefficient[7] = {1.0 / 24,        -1.0 / 720,           1.0 / 40320,         -1.0 / 3628800,
                                    1.0 / 479001600, -1.0 / 87178291200.0, 1.0 / 20922789888000};
  const Number z = r * r;
  Number sum{};
  for (int n = 6; n >= 0; --n) sum = sum * z + kCoefficient[n];  // bound: 7
  const Number half = 0.5 * z;
  const Number leading = 1.0 - half;
  return leading + (((1.0 - leading) - half) + z * z * sum);
}

// sin(x + shift * pi/2).
Real sin_shifted(Real x, std::int64_t shift) PALPATE_RT {
  const Reduced reduced = reduce(x);
  const std::int64_t quarter = reduced.quarter + shift;
  const Real value = (quarter & 1) != 0 ? cos_series(reduced.r) : sin_series(reduced.r);
  return clamp_to((quarter & 2) != 0 ? -value : value, -1.0, 1.0);
}

// atan t for 0 <= t <= 1: subtract the nearest of atan 0, atan 7/16, atan 1, so that |z| <= 0.21; then the series
// (first omitted term 2e-18).
Real atan_unit(Real t) PALPATE_RT {
  Real z = t, base = 0, base_low = 0;
  if (t > 0.68) {
    z = (t - 1.0) / (t + 1.0);
    base = 0.25 * kPi;
    base_low = 0.25 * kPiLow;
  } else if (t > 0.21) {
    z = (t - 0.4375) / (1.0 + 0.4375 * t);
    base = 0x1.a64eec3cc23fdp-2;
    base_low = -0x1.24dec1b50b7ffp-56;
  }
  const Real square = -(z * z);
  return base + (z + (z * square * odd_reciprocal_series<12>(square) + base_low));
}

bool is_number(Real x) PALPATE_RT { return x == x; }

}  // namespace

Real exp(Real x) PALPATE_RT { return exp_of(x, 0.0); }

Real log(Real x) PALPATE_RT {
  if (!(x > 0)) return -kHuge;
  return log_pair(min_of(x, kLargest)).high;
}

Real pow(Real x, Real y) PALPATE_RT {
  if (y == 0 || x == 1) return 1.0;
  if (!(x >= 0) || !is_number(y)) return 0.0;
  if (x == 0) return y > 0 ? 0.0 : kLargest;
  const Pair logarithm = log_pair(min_of(x, kLargest));
  const Real estimate = y * logarithm.high;
  if (estimate > 710.0) return kLargest;
  if (!(estimate > -746.0)) return 0.0;
  const Pair exponent = exact_product(y, logarithm.high);
  return exp_of(exponent.high, exponent.low + y * logarithm.low);
}

Real cbrt(Real x) PALPATE_RT {
  if (x == 0 || !is_number(x)) return 0.0;
  const Split part = split(min_of(abs_of(x), kLargest));
  const std::int32_t third = (part.exponent + 3000) / 3 - 1000;           // floor(exponent / 3)
  const Real scaled = part.mantissa * two_to(part.exponent - 3 * third);  // in [1, 8)
  // Halley's iteration triples the digits: error 6 % -> 2e-4 -> 4e-12 -> rounding.
  Real root = 0.94 + 0.136 * scaled;
  for (int n = 0; n < 3; ++n) {  // bound: 3
    const Real cube = root * root * root;
    root = root - root * (cube - scaled) / (2.0 * cube + scaled);
  }
  const Real result = root * two_to(third);
  return x < 0 ? -result : result;
}

Double4 cube_roots(const Double4& x) PALPATE_RT {
  using Int4 [[gnu::vector_size(16)]] = std::int32_t;
  const auto two_to = [](const Int4& k) PALPATE_RT {
    return __builtin_bit_cast(Double4, (__builtin_convertvector(k, Mask4) + 1023) << 52);
  };
  const Mask4 bits = __builtin_bit_cast(Mask4, x);
  const Double4 mantissa = __builtin_bit_cast(Double4, (bits & 0x000fffffffffffff) | 0x3ff0000000000000);
  const Int4 exponent = __builtin_convertvector(bits >> 52, Int4) - 1023, third = (exponent + 3000) / 3 - 1000;
  const Double4 scaled = mantissa * two_to(exponent - 3 * third);
  Double4 root = 0.94 + 0.136 * scaled;
  for (int n = 0; n < 3; ++n) {  // bound: 3
    const Double4 cube = root * root * root;
    root = root - root * (cube - scaled) / (2.0 * cube + scaled);
  }
  return root * two_to(third);
}

Real sin(Real x) PALPATE_RT { return is_finite(x) ? sin_shifted(x, 0) : 0.0; }
Real cos(Real x) PALPATE_RT { return is_finite(x) ? sin_shifted(x, 1) : 1.0; }

SinCos4 sin_cos(const Double4& x) PALPATE_RT {
  using Int4 [[gnu::vector_size(16)]] = std::int32_t;
  const Mask4 in_range = (x >= -1e4) & (x <= 1e4);
  const Double4 angle = in_range ? x : Double4{};
  const Double4 turned = angle * kTwoOverPi;
  const Int4 quarter = __builtin_convertvector(turned + (turned < 0 ? splat4(-0.5) : splat4(0.5)), Int4);  // nearest()
  const Double4 k = __builtin_convertvector(quarter, Double4);
  const Double4 r = ((angle - k * kHalfPi1) - k * kHalfPi2) - k * kHalfPi3;
  const Mask4 odd = __builtin_convertvector(-(quarter & 1), Mask4);
  const Mask4 sin_falls = __builtin_convertvector(-(quarter >> 1 & 1), Mask4);
  const Mask4 cos_falls = __builtin_convertvector(-((quarter + 1) >> 1 & 1), Mask4);
  const auto within = [](const Double4& v) PALPATE_RT {
    const Double4 low = v > -1.0 ? v : splat4(-1.0);
    return low < 1.0 ? low : splat4(1.0);
  };
  const Double4 s = sin_series(r), c = cos_series(r), sine = odd ? c : s, cosine = odd ? s : c;
  return {within(sin_falls ? -sine : sine), within(cos_falls ? -cosine : cosine)};
}

Real atan2(Real y, Real x) PALPATE_RT {
  if (!is_number(y) || !is_number(x)) return 0.0;
  const Real along = min_of(abs_of(x), kLargest), across = min_of(abs_of(y), kLargest);
  const bool steep = across > along;
  const Real larger = steep ? across : along, smaller = steep ? along : across;
  Real angle = larger > 0 ? atan_unit(smaller / larger) : 0.0;
  if (steep) angle = 0.5 * kPi - (angle - 0.5 * kPiLow);
  if (x < 0) angle = kPi - (angle - kPiLow);
  return y < 0 ? -angle : angle;
}

Real asin(Real x) PALPATE_RT {
  const Real s = is_number(x) ? clamp_to(x, -1.0, 1.0) : 0.0;
  return atan2(s, square_root((1.0 - s) * (1.0 + s)));
}

Real acos(Real x) PALPATE_RT {
  const Real c = is_number(x) ? clamp_to(x, -1.0, 1.0) : 0.0;
  return atan2(square_root((1.0 - c) * (1.0 + c)), c);
}

}  // namespace palpate::math
