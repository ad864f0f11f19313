// Vectors of numbers that one instruction handles at once. Element-wise only: nothing here reorders a sum, so gcc and
// clang give the same bits with and without the hardware for it.
#pragma once

#include <cstdint>

#include "rt_core/vec.h"

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
// from[at[0..7]]. One instruction fetches eight numbers where there is one; left to itself gcc 12 loads them one by
// one, at four times the instructions.
inline Float8 gather8(const float* from, const std::int32_t* at) PALPATE_RT {
#if defined(__AVX2__)
  using Int8 [[gnu::vector_size(32)]] = std::int32_t;
  const Float8 all = __builtin_bit_cast(Float8, Int8{-1, -1, -1, -1, -1, -1, -1, -1});
  Int8 index;
  __builtin_memcpy(&index, at, sizeof index);
#if defined(__clang__)
  return __builtin_ia32_gatherd_ps256(Float8{}, from, index, all, 4);
#else
  return __builtin_ia32_gathersiv8sf(Float8{}, from, index, all, 4);
#endif
#else
  return Float8{from[at[0]], from[at[1]], from[at[2]], from[at[3]], from[at[4]], from[at[5]], from[at[6]], from[at[7]]};
#endif
}
inline Float8 gather8(const double* from, const std::int32_t* at) PALPATE_RT {
  const auto f = [&](int k) PALPATE_RT { return static_cast<float>(from[at[k]]); };
  return Float8{f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7)};
}
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
// A vector in the first three lanes. The fourth holds a number of which nobody asks.
inline Double4 lanes_of(Vec3 v) PALPATE_RT { return Double4{v.x, v.y, v.z, 0}; }
inline Vec3 vector_of(const Double4& v) PALPATE_RT { return {v[0], v[1], v[2]}; }
// a x b of vectors in the first three lanes, by the products of vec.h.
inline Double4 cross(const Double4& a, const Double4& b) PALPATE_RT {
  return __builtin_shufflevector(a, a, 1, 2, 0, 3) * __builtin_shufflevector(b, b, 2, 0, 1, 3) -
         __builtin_shufflevector(a, a, 2, 0, 1, 3) * __builtin_shufflevector(b, b, 1, 2, 0, 3);
}
// In this order on every machine.
inline double sum(const Double4& v) PALPATE_RT { return (v[0] + v[1]) + (v[2] + v[3]); }

inline Double4 square_root(const Double4& v) PALPATE_RT {
#if defined(__clang__) && __clang_major__ >= 16  // older clang has gcc's builtin alone
  return __builtin_elementwise_sqrt(v);
#elif defined(__AVX__)
  return __builtin_ia32_sqrtpd256(v);
#else
  return Double4{__builtin_sqrt(v[0]), __builtin_sqrt(v[1]), __builtin_sqrt(v[2]), __builtin_sqrt(v[3])};
#endif
}
// Which of four comparisons hold, as bits.
using Mask4 [[gnu::vector_size(32)]] = std::int64_t;
inline std::uint32_t bits_of(const Mask4& mask) PALPATE_RT {
#if defined(__AVX__)
  return static_cast<std::uint32_t>(__builtin_ia32_movmskpd256(__builtin_bit_cast(Double4, mask)));
#else
  std::uint32_t bits = 0;
  for (std::uint32_t k = 0; k < 4; ++k) bits |= mask[k] != 0 ? 1u << k : 0u;  // bound: 4
  return bits;
#endif
}

inline Double4 abs_of(const Double4& v) PALPATE_RT {
  constexpr Mask4 kMagnitude{INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
  return __builtin_bit_cast(Double4, __builtin_bit_cast(Mask4, v) & kMagnitude);
}

// Four vectors at a time.
struct Vec3x4 {
  Double4 x, y, z;
  Vec3 operator[](std::uint32_t k) const PALPATE_RT { return {x[k], y[k], z[k]}; }
  void set(std::uint32_t k, Vec3 v) PALPATE_RT {
    x[k] = v.x;
    y[k] = v.y;
    z[k] = v.z;
  }
};
inline Vec3x4 side_by_side(Vec3 a, Vec3 b, Vec3 c, Vec3 d) PALPATE_RT {
  return {Double4{a.x, b.x, c.x, d.x}, Double4{a.y, b.y, c.y, d.y}, Double4{a.z, b.z, c.z, d.z}};
}
inline Vec3x4 splat4(Vec3 a) PALPATE_RT { return {splat4(a.x), splat4(a.y), splat4(a.z)}; }
inline Vec3x4 operator+(const Vec3x4& a, const Vec3x4& b) PALPATE_RT { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3x4 operator-(const Vec3x4& a, const Vec3x4& b) PALPATE_RT { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3x4 operator*(const Double4& s, const Vec3x4& a) PALPATE_RT { return {s * a.x, s * a.y, s * a.z}; }
inline Double4 dot(const Vec3x4& a, const Vec3x4& b) PALPATE_RT { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3x4 cross(const Vec3x4& a, const Vec3x4& b) PALPATE_RT {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Double4 where(const Mask4& mask, const Double4& a, const Double4& b) PALPATE_RT { return mask ? a : b; }
inline Vec3x4 where(const Mask4& mask, const Vec3x4& a, const Vec3x4& b) PALPATE_RT {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
// Four vectors that follow one another in memory.
inline Vec3x4 load4(const Vec3* from) PALPATE_RT {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const double* number = &from->x;
  const Double4 a = load4(number), b = load4(number + 4), c = load4(number + 8);  // xyzx yzxy zxyz
  const Double4 ab = __builtin_shufflevector(a, b, 0, 3, 6, 1);                   // x0 x1 x2 y0
  const Double4 bc = __builtin_shufflevector(b, c, 0, 3, 6, 1);                   // y1 y2 y3 z1
  const Double4 x = __builtin_shufflevector(ab, c, 0, 1, 2, 5);
  const Double4 y = __builtin_shufflevector(ab, bc, 3, 4, 5, 6);
  const Double4 az = __builtin_shufflevector(a, c, 2, 4, 4, 7);  // z0 z2 z2 z3
  return {x, y, __builtin_shufflevector(az, bc, 0, 7, 2, 3)};
}
// n rounded up to whole lanes.
constexpr std::int32_t whole_lanes(std::int32_t n, std::int32_t lanes) { return (n + lanes - 1) / lanes * lanes; }

// A RigidFrame, each column in the first three lanes.
struct RigidLanes {
  Double4 x, y, z, origin;
};
inline RigidLanes lanes_of(const RigidFrame& frame) PALPATE_RT {
  return {lanes_of(frame.x), lanes_of(frame.y), lanes_of(frame.z), lanes_of(frame.origin)};
}
inline Double4 out_of(const RigidLanes& frame, Vec3 point) PALPATE_RT {
  return frame.origin + (splat4(point.x) * frame.x + splat4(point.y) * frame.y + splat4(point.z) * frame.z);
}

// Of four points.
inline Vec3x4 into(const RigidFrame& frame, const Vec3x4& point_w) PALPATE_RT {
  const Vec3x4 d = point_w - splat4(frame.origin);
  return {dot(splat4(frame.x), d), dot(splat4(frame.y), d), dot(splat4(frame.z), d)};
}
inline Vec3x4 direction_out(const RigidFrame& frame, const Vec3x4& d) PALPATE_RT {
  return d.x * splat4(frame.x) + d.y * splat4(frame.y) + d.z * splat4(frame.z);
}

}  // namespace palpate
