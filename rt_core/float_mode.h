// The processor's floating point while a tick runs.
#pragma once

#include "rt_core/base.h"

namespace palpate {

// Rounding to nearest, no traps, numbers below the normal range taken for zero (FTZ, DAZ), whatever the calling thread
// has set; that comes back at the end. Part of the determinism contract: a caller that rounds otherwise changes no bit.
// Subnormals cost a microcode assist of about 150 cycles each: a tick of pinch_block that met them took 68 us instead
// of 11 us for the same instructions (2026-11-22).
class TickFloatMode {
 public:
  TickFloatMode() PALPATE_RT : before_(__builtin_ia32_stmxcsr()) { __builtin_ia32_ldmxcsr(kMode); }
  ~TickFloatMode() PALPATE_RT { __builtin_ia32_ldmxcsr(before_); }
  TickFloatMode(const TickFloatMode&) = delete;
  TickFloatMode& operator=(const TickFloatMode&) = delete;

  // All exceptions masked, round to nearest, flush to zero, denormals are zero.
  static constexpr unsigned kMode = 0x9fc0;

 private:
  unsigned before_;
};

}  // namespace palpate
