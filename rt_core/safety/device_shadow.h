// What a device that evaluates the local contact model renders, as the controller can know it: the law of such a device
// (next_force_N of hal/device/local_model.h) played with what it was told, the delay ago, and with the way that the
// handle went since. The account of the energy (hand_energy.h) counts with this force: with one that followed from the
// newest command and its lag a contact of 0.33 m/s at 2.7 ms returned 0.25 mJ that the account did not see, 0.05 of
// them in the tick in which the device was told, 0.07 by an object stiffer where the hand is now than where it was
// when the command was made, and 0.05 by the slope of a brake (tools_on_cylinder, 2026-11-26).
#pragma once

#include "rt_core/state.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

// Force in the mean while the handle went on to where it is, and safety.rendered_N at the end of it. Bound: two pieces
// of a tick.
Vec3 shadow_device(const Model& model, State& state) PALPATE_RT;

// What this tick tells the device, before all that it was told before.
void remember_told(SafetyState& safety, const LocalFelt& told) PALPATE_RT;

}  // namespace palpate
