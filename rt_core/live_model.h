// What live settings (rt_core/live.h) make of a scene in one tick.
//
// A body s times as stiff needs no other solver: where the contact is found, the unit of force is s newtons. The body
// is then as it was baked, and whatever else has a unit of force is divided by s: coupling, the device's limits, what
// stops a joint. The tool comes to the place where s F(x) balances the coupling, exactly, for every method. Only what
// leaves the contact is multiplied by s; State keeps regions in those units, fill_record() tells newtons.
#pragma once

#include "rt_core/state.h"

namespace palpate {

// In no tick does a setting change by more: what is rendered lies below the device's largest force, so a factor of it
// that changes by this share moves it by less than 1 % of that force. Half of it is left to what the tool's new place
// does to a contact that stiffens with depth. From one end of a range to the other in 0.8 s at 1 kHz.
inline constexpr double kLiveStep = 0.004;

// Moves what acts towards what is wanted, and within its range, whatever the memory held. A wish that is no number or
// out of range is none. Stiffness and coupling, which force follows in proportion, move by a share of themselves.
void follow_settings(const LiveSettings& wanted, SettingsState& live) PALPATE_RT;

// The parameters as they act now: for the output stage.
void apply(const SettingsState& live, ModelParams& params) PALPATE_RT;
// The same where the unit of force is live.stiffness newtons: for everything before it.
void apply_in_units_of_stiffness(const SettingsState& live, ModelParams& params) PALPATE_RT;
// The totals of contact, from those units.
void to_newtons(const SettingsState& live, Scratch& scratch) PALPATE_RT;

}  // namespace palpate
