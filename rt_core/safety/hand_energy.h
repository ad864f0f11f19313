// What sampling and delay make of a spring, and what is done about it: damping of the virtual coupling, a controller of
// the energy that contact returns, and a detector of what neither of them holds.
#pragma once

#include "rt_core/state.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

// A force held for a tick T and late by tau follows the spring's motion by T / 2 + tau: to the hand that is a damper of
// -K (T / 2 + tau), which the coupling's damping coupling_Ns_per_m balances (Colgate & Schenkel 1997 for the first
// half; Diolaiti et al. 2006 with delay). Adds it to `force_N`, the coupling's, which it never turns round: no tool
// sticks to the surface it leaves. The rate of the stretch comes from its own smoothed past; below kDampingDead_m_per_s
// there is none, for there the device's Coulomb friction takes more, f_c v against K (T / 2 + tau) v^2, and the
// staircase of an encoder would be heard.
void add_coupling_damping(const Model& model, SafetyState& safety, Vec3& force_N) PALPATE_RT;

// Counts the energy of this contact at the motors: their work on the handle since the last sample, with the outputs
// that acted then (the delay is known), and what coupling and object hold. Above zero, sampling and delay have made
// energy; it is braked away by a force against the handle's motion, at most as much as a damper of twice K (T / 2 +
// tau) would, and never by turning the force round (time-domain passivity: Hannaford & Ryu 2002; reference storage: Ryu
// et al. 2005). What friction took is no credit. Joints that are driven may give their work to the hand, and no more:
// the account begins at the tool. Status: kEnergyDrained. Settings that move of themselves, samples that jumped and a
// force that ramps are left out of the account.
// So may the other one of two tools, which did `given_J` on the body since the last tick.
void drain_energy(const Model& model, State& state, Scratch& scratch, const Input& input, double given_J,
                  Vec3& force_N) PALPATE_RT;

// True when the coupling's force has changed its sense of change in most of the last ticks, or when the surplus is more
// than the coupling holds at the largest force, and than 0.3 of all that is stored: Fault::kUnstable. A device that
// evaluates the local model lets go of the largest force by its slope, which gives a hand that leaves at
// `hand_m_per_s` so much more.
bool is_unstable(const Model& model, SafetyState& safety, Vec3 force_N, double hand_m_per_s) PALPATE_RT;

// The output of this tick into the history of those that may still be under way, with what a device that evaluates the
// local model is `told` besides.
void remember_output(const Model& model, SafetyState& safety, const LocalFelt& told) PALPATE_RT;

}  // namespace palpate
