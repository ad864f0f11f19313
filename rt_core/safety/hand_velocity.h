// The handle's smoothed velocity, and how far a hand may leave it.
#pragma once

#include "rt_core/model.h"

namespace palpate {

// It is smoothed over so many samples, and over no less time: an encoder step of 30 um in one tick is 30 mm/s, here 5.
// Six samples of a tenth of a millisecond made 50 of it, and the step itself an acceleration that no hand has: one
// sample in 70 was refused (tools_on_layer at 10 kHz, 2026-11-23).
inline constexpr double kVelocityLag_ticks = 6, kVelocityLag_s = 6e-3;
inline double velocity_lag_ticks(const ModelParams& p) PALPATE_RT {
  return max_of(kVelocityLag_ticks, kVelocityLag_s / p.period_s);
}

// What the largest acceleration makes of the time, and of as long again for what the smoothed velocity is late by; 0
// where none is stated.
inline double bend_m(const ModelParams& p, double elapsed_s) PALPATE_RT {
  return p.acceleration_max_m_per_s2 * elapsed_s * (elapsed_s + velocity_lag_ticks(p) * p.period_s);
}

}  // namespace palpate
