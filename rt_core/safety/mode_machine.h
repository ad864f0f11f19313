// The mode machine of the output stage. Transitions (all tested):
//   Idle    -- arm edge, fresh sample, no fault ----------------> Force    gain rises over ramp_in_s
//   Force   -- late by 1..hold ticks ---------------------------> Hold     gain kept
//   Hold    -- late by hold+1..passive ticks -------------------> Passive  gain decays by kPassiveDecay a tick
//   Passive -- later still -------------------------------------> Ramp     gain falls to zero over ramp_out_s
//   Hold, Passive, Ramp (no fault, not stopping) -- fresh ------> Force    gain rises again from where it is
//   any but Idle -- stop ---------------------------------------> Ramp ---- gain 0 --> Idle
//   any -- fault bit, or late by the silence limit -------------> Ramp ---- gain 0 --> Fault (latched)
//   Fault   -- reset edge, cause gone --------------------------> Idle
// "Late" counts ticks without a usable sample: no frame, a rejected sample, or deadlines missed.
#pragma once

#include "rt_core/io.h"
#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Gain kept per tick while passive: 0.8^5 = 0.33 after the five ticks this mode lasts by default.
inline constexpr double kPassiveDecay = 0.8;

// Advances mode, fault and gain by one tick. `new_faults`: found by this tick's own checks.
void advance_mode(const Model& model, const Input& input, std::uint32_t new_faults, std::uint32_t late_ticks,
                  SafetyState& safety) PALPATE_RT;

}  // namespace palpate
