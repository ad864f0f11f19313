// What a device that evaluates the local model does by itself (docs/wire_protocol.md), as far as the controller's
// account must know of it (device_shadow.h); hal/device/local_model.h is the device.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

// The stiffest that a symmetric stiffness (xx, yy, zz; yz, xz, xy) is along any line, at most: no eigenvalue is larger
// than the root of the squares of all nine entries, which one stiff direction comes to, nor than the largest row of
// sizes, which three of about the same do. The first alone took a device for 1.7 times as stiff as it was told where
// friction holds the tool, and cut that down (2026-11-26).
inline Real stiffness_size(Vec3 along, Vec3 across) PALPATE_RT {
  const Real x = abs_of(across.x), y = abs_of(across.y), z = abs_of(across.z);
  const Real row = max_of(abs_of(along.x) + z + y, max_of(abs_of(along.y) + z + x, abs_of(along.z) + y + x));
  return min_of(row, square_root(squared_norm(along) + 2 * squared_norm(across)));
}

// What it evaluates does not turn round against the force that it was told.
inline Vec3 not_turned_round(Vec3 force_N, Vec3 told_N) PALPATE_RT {
  const Vec3 sense = unit_or(told_N, {});
  return force_N - min_of(0, dot(force_N, sense)) * sense;
}
// Nor does what it renders next, farther than what it rendered was.
inline Vec3 turned_no_farther(Vec3 next_N, Vec3 rendered_N, Vec3 told_N) PALPATE_RT {
  const Vec3 sense = unit_or(told_N, {});
  const Real least_N = min_of(0, dot(rendered_N, sense)), along_N = dot(next_N, sense);
  return next_N + max_of(0, least_N - along_N) * sense;
}

// What commands change of its force in a millisecond, as a share of its limit. Below a tenth by what an encoder's step
// of 30 um, smoothed to half of it, makes of 4.3 N/mm on 8.5 N: 0.8 %, measured 0.6 (2026-11-25).
inline constexpr Real kLocalSlopeShare_per_ms = 0.09;
inline constexpr Real kFineEncoderShare = 0.008;

// Where steps of its encoder through the stiffness it is told make more than that, the slope is less by so much: what
// commands and they change together stays below a tenth. Smoothed within half a step of what was told, the handle's
// place is off by at most a step either way, so by two in a millisecond; 1.23 of them is the most that 180 jumps of the
// encoder made. With the slope of a fine encoder, ones of 50 to 100 um stepped by 10.1 to 11.2 % (2026-11-26). On its
// track (hal/device/local_handle.h) it is off by two, but only where a step makes no more than 0.85 of the friction.
// The share is never less than a half.
inline constexpr Real kEncoderSteps_per_ms = 1.3;
inline Real local_slope_share_per_ms(Real share, Real stiffness_N_per_m, Real encoder_step_m,
                                     Real force_max_N) PALPATE_RT {
  const Real steps = kEncoderSteps_per_ms * stiffness_N_per_m * encoder_step_m / force_max_N;
  return max_of(0.5 * share, min_of(share, share + kFineEncoderShare - steps));
}

// A hand that explores stays below 1 m/s; what goes twice as fast is an encoder that jumped, and makes no force but by
// the slope. In a period of 0.1 ms that is 0.2 mm: what a shorter jump makes is 10 % of 8.5 N on 4.3 N/mm.
inline constexpr Real kLocalFastest_m_per_s = 2;

}  // namespace palpate
