// Foundations every rt_core file shares: the scalar type, the real-time function marker and platform checks.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

// Marks a function that may run inside tick(). clang 22 then proves, as an error, that nothing it reaches can
// allocate, lock, throw or make a system call (-Wfunction-effects). gcc sees plain noexcept.
#if defined(__clang__) && __clang_major__ >= 20
#define PALPATE_RT noexcept [[clang::nonblocking]]
#define PALPATE_RT_IF(condition) noexcept(condition) [[clang::nonblocking(condition)]]
#else
#define PALPATE_RT noexcept
#define PALPATE_RT_IF(condition) noexcept(condition)
#endif
// _IF: of a template that serves both a tick and the host.

namespace palpate {

using Real = double;

static_assert(sizeof(Real) == 8, "images, recordings and hashes store 64-bit floats");
static_assert(std::numeric_limits<Real>::is_iec559, "bit determinism needs IEEE 754 arithmetic");
static_assert(std::endian::native == std::endian::little, "images and wire frames are little-endian");
#ifdef __FAST_MATH__
#error "Palpate must be built without -ffast-math: it breaks bit determinism and the finite checks"
#endif

// Largest finite-looking magnitude accepted anywhere: beyond it a value is treated as garbage, not as physics.
inline constexpr Real kHuge = 1e12;

inline constexpr Real kPi = 3.14159265358979323846;

// Comparisons are written so that NaN takes the `false` branch.
inline bool is_finite(Real x) PALPATE_RT { return x >= -kHuge && x <= kHuge; }
inline Real min_of(Real a, Real b) PALPATE_RT { return a < b ? a : b; }
inline Real max_of(Real a, Real b) PALPATE_RT { return a > b ? a : b; }
inline Real clamp_to(Real x, Real lo, Real hi) PALPATE_RT { return min_of(max_of(x, lo), hi); }
inline Real abs_of(Real x) PALPATE_RT { return x < 0 ? -x : x; }

}  // namespace palpate
