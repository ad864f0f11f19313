// What a device that evaluates the local model does by itself (docs/wire_protocol.md), as far as the controller's
// account must know of it; hal/device/local_model.h is the device.
#pragma once

#include "rt_core/base.h"

namespace palpate {

// What commands change of its force in a millisecond, as a share of its limit. Below a tenth by what an encoder's step
// of 30 um, smoothed to half of it, makes of 4.3 N/mm on 8.5 N: 0.8 %, measured 0.6 (2026-11-25).
inline constexpr Real kLocalSlopeShare_per_ms = 0.09;

// A hand that explores stays below 1 m/s; what goes twice as fast is an encoder that jumped, and makes no force but by
// the slope. In a period of 0.1 ms that is 0.2 mm: what a shorter jump makes is 10 % of 8.5 N on 4.3 N/mm.
inline constexpr Real kLocalFastest_m_per_s = 2;

}  // namespace palpate
