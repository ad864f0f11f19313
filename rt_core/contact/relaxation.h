// Material that does not give back all work: the force of a held body relaxes by up to three Prony terms, and what rubs
// inside the body takes a share of every press, however slow.
//
// With W the elastic energy of contact and friction springs and s = sqrt(2 W), the body stores
//   V = (1 - sum g_i) s^2 / 2 + sum g_i (s - r_i)^2 / 2,   r_i' = (s - r_i) / tau_i,
// so every force is the elastic one times m = 1 - sum g_i r_i / s. A step that is held relaxes exactly by 1 - sum g_i
// (1 - exp(-t / tau_i)), whatever the law, and on a linear law this is the Prony series (quasi-linear viscoelasticity:
// Fung 1993, section 7.6). Unlike that one it is passive by construction on a stiffening law, too: V is bounded below
// and loses g_i (s - r_i)^2 / tau_i. A body that is left faster than it recovers pulls nothing: its surface stays
// behind at s = sum g_i r_i. There is one memory for the body: what has yielded under one finger is softer under the
// next.
//
// Loss at any rate (lost_share): beside these a spring with a slider,
//   V_loss = loss ((s - q)^2 / k - s^2) / 4,   q = s kept within [(1 - k) s, (1 + k) s],   k = 0.2
// which adds nothing to the force while s grows and takes `loss` of it while s falls, q following (Jenkins' element: q
// moves towards s only, so V_loss falls by it). Turning round takes the way from s to (1 - k)/(1 + k) s. A press from
// zero and back loses loss (1 - k)/(1 + k) of its work: lost_share, which fixes loss. Rubber and liver show such loops
// at 1 mm/s (Mahvash & Hayward 2002, figures 5 to 7).
#pragma once

#include "rt_core/state.h"

namespace palpate {

// Scales scratch.contact_wrench_w and the regions', and replaces scratch.energy_J; advances state.relaxed_rootJ by a
// tick. Nothing without terms. Bound: kMaxRegions.
void relax(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

}  // namespace palpate
