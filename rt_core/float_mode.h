// The processor's floating point while a tick runs.
#pragma once

#include "rt_core/base.h"

namespace palpate {

// The register that holds the settings: MXCSR on x86-64, FPCR on AArch64.
#if defined(__x86_64__)
using FloatMode = unsigned;
inline FloatMode float_mode() PALPATE_RT { return __builtin_ia32_stmxcsr(); }
inline void set_float_mode(FloatMode mode) PALPATE_RT { __builtin_ia32_ldmxcsr(mode); }
// All exceptions masked, round to nearest, flush to zero (bit 15), denormals are zero (bit 6).
inline constexpr FloatMode kTickFloatMode = 0x9fc0;
#elif defined(__aarch64__)
using FloatMode = std::uint64_t;
inline FloatMode float_mode() PALPATE_RT {
  FloatMode mode;
  __asm__ __volatile__("mrs %0, fpcr" : "=r"(mode));
  return mode;
}
inline void set_float_mode(FloatMode mode) PALPATE_RT { __asm__ __volatile__("msr fpcr, %0" : : "r"(mode) : "memory"); }
// No traps, round to nearest, FZ (bit 24): operands and results below the normal range are zero.
inline constexpr FloatMode kTickFloatMode = 1u << 24;
#else
#error "Palpate's tick knows the floating-point modes of x86-64 and AArch64 alone"
#endif

// Rounding to nearest, no traps, numbers below the normal range taken for zero (FTZ and DAZ; FZ on AArch64), whatever
// the calling thread has set; that comes back at the end. Part of the determinism contract: a caller that rounds
// otherwise changes no bit. Subnormals cost a microcode assist of about 150 cycles each: a tick of pinch_block that met
// them took 68 us instead of 11 us for the same instructions (x86-64, 2026-11-22). The two processors differ in one
// case: x86-64 asks after rounding whether a result is below the normal range, AArch64 before. A product that is
// 2^-1022 only by being rounded up stays on the one and is zero on the other (docs/determinism.md).
class TickFloatMode {
 public:
  TickFloatMode() PALPATE_RT : before_(float_mode()) { set_float_mode(kMode); }
  ~TickFloatMode() PALPATE_RT { set_float_mode(before_); }
  TickFloatMode(const TickFloatMode&) = delete;
  TickFloatMode& operator=(const TickFloatMode&) = delete;

  static constexpr FloatMode kMode = kTickFloatMode;

 private:
  FloatMode before_;
};

}  // namespace palpate
