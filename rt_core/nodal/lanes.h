// Vectors of numbers that one instruction handles at once. Element-wise only: nothing here reorders a sum, so gcc and
// clang give the same bits with and without the hardware for it.
#pragma once

#include <cstdint>

#include "rt_core/base.h"

namespace palpate {

using Float8 [[gnu::vector_size(32)]] = float;
using Float4v [[gnu::vector_size(16)]] = float;
using Double4 [[gnu::vector_size(32)]] = double;

inline Double4 load4(const double* from) PALPATE_RT {
  Double4 v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
inline Double4 widen4(const float* from) PALPATE_RT {
  Float4v v;
  __builtin_memcpy(&v, from, sizeof v);
#if defined(__AVX__) && !defined(__clang__)
  return __builtin_ia32_cvtps2pd256(v);  // gcc 12 converts halves and joins them, at four instructions
#else
  return __builtin_convertvector(v, Double4);
#endif
}
inline Float8 load8(const float* from) PALPATE_RT {
  Float8 v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
inline void store(double* to, const Double4& v) PALPATE_RT { __builtin_memcpy(to, &v, sizeof v); }
inline void store(float* to, const Float8& v) PALPATE_RT { __builtin_memcpy(to, &v, sizeof v); }
inline Double4 splat4(double x) PALPATE_RT { return Double4{x, x, x, x}; }
inline Float8 splat8(float x) PALPATE_RT { return Float8{x, x, x, x, x, x, x, x}; }
// Swaps rows and columns of a 4 x 4 block.
inline void transpose(Double4 (&row)[4]) PALPATE_RT {
  const Double4 a = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6);
  const Double4 b = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
  const Double4 c = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6);
  const Double4 d = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
  row[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  row[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  row[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  row[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}
// In this order on every machine.
inline double sum(const Double4& v) PALPATE_RT { return (v[0] + v[1]) + (v[2] + v[3]); }

inline Double4 square_root(const Double4& v) PALPATE_RT {
  return Double4{__builtin_sqrt(v[0]), __builtin_sqrt(v[1]), __builtin_sqrt(v[2]), __builtin_sqrt(v[3])};
}
inline Double4 abs_of(const Double4& v) PALPATE_RT { return v < 0 ? -v : v; }
// n rounded up to whole lanes.
constexpr std::int32_t whole_lanes(std::int32_t n, std::int32_t lanes) { return (n + lanes - 1) / lanes * lanes; }

}  // namespace palpate
