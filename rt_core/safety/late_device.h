// A device that is later than it was said to be: found by its own echo, met by a coupling as soft as the delay asks
// for. Stated truly, 3 ms cost stiffness; unstated they gave the hand 6 to 10 mJ a tap (2026-11-22), and neither
// damping nor the account of the energy mends that, for they are as late as the force is.
#pragma once

#include "rt_core/state.h"

namespace palpate {

// So many samples in a row must show a delay before it counts: a burst on the bus is no delay of the device.
inline constexpr std::int32_t kLateSamples = 64;
// And so many none, until it counts no more: a device with a clock of its own drifts through phases in which its
// samples are a period older, for seconds.
inline constexpr std::int32_t kFineSamples = 1024;

// Judges Input::command_lag. A sample that comes when n was the newest command sent, and that obeys n - L, shows that
// command n - L + 1 did not act L periods after the sample that it was made from: the delay is L T at least. When
// kLateSamples in a row show more than was stated (by a quarter of a period: it is measured to 0.15 ms), the device
// counts as late by one period more than they all show, the most that can show no more: the coupling goes down to
// (T + 2 tau) / (T + 2 tau') of itself, the share in which the bound 2b / (T + 2 tau) does, at once while it renders
// nothing, else by kLiveStep a tick. What was found holds for kFineSamples, or until the device is at rest. A device
// that echoes nothing, or delays what it echoes, is not found out; one that evaluates the local model closes its spring
// before the delay.
void watch_delay(const Model& model, const Input& input, State& state) PALPATE_RT;

// The parameters as they act on a late device.
void soften(const LateDevice& late, ModelParams& params) PALPATE_RT;

}  // namespace palpate
