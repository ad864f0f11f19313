// The mode machine of the output stage. Transitions (all tested):
//   Idle    -- arm edge, fresh, heard, not pressed, no fault ----> Force    gain rises over ramp_in_s
//   Force   -- late by 1..hold ticks ---------------------------> Hold     gain kept
//   Hold    -- late by hold+1..passive ticks -------------------> Passive  gain decays by kPassiveDecay a tick
//   Passive -- later still -------------------------------------> Ramp     gain falls to zero over ramp_out_s
//   Hold, Passive, Ramp (no fault, not stopping) -- fresh ------> Force    gain rises again from where it is
//   any but Idle -- stop ---------------------------------------> Ramp ---- gain 0 --> Idle
//   Force, Hold, Passive -- unheard or stalled -----------------> Ramp     until that is over, then as above
//   any -- fault bit, or late by the silence limit -------------> Ramp ---- gain 0 --> Fault (latched)
//   Fault   -- reset edge, cause gone --------------------------> Idle
// "Unheard": Command::kUnheard, the device does not show that commands reach it. "Stalled": Command::kStall, the
// machine stood still and the simulated device with it. "Late" counts ticks without a usable sample: no frame, a
// rejected sample, or deadlines missed.
#pragma once

#include "rt_core/io.h"
#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Gain kept per tick while passive: 0.8^5 = 0.33 after the five ticks this mode lasts by default.
inline constexpr double kPassiveDecay = 0.8;

// What this tick's own checks found.
struct Findings {
  std::uint32_t faults = 0;
  std::uint32_t late_ticks = 0;                     // see above
  std::uint32_t late_fault = Fault::kDeviceSilent;  // what being late for the silence limit is called
  bool pressed = false;                             // armed now, the tool would push with more than kArmForceMax_N
};

// Advances mode, fault and gain by one tick.
void advance_mode(const Model& model, const Input& input, const Findings& found, SafetyState& safety) PALPATE_RT;

}  // namespace palpate
