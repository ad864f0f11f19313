// What a hard object does at a touch beside pushing back: it rings. A decaying sinusoid is added to the force along the
// normal of the touch, as high as the touch was fast,
//   y(t) = A v exp(-decay t) sin(2 pi frequency t),
// after Okamura, Cutkosky & Dennerlein 2001 (IEEE/ASME Trans. Mechatronics 6, 245-252). Beginning with what pushes
// back. Sampled it is a resonator with two coefficients of the baker's: y' = turn y - kept y_before, exactly the
// sinusoid at every tick (2 r cos w and r^2 with r = exp(-decay T), w = 2 pi frequency T).
//
// It is of the object as felt: the virtual tool, which has no mass, knows nothing of it. The account of energy counts
// its work at the motors as any other's (hand_energy.h), so what it would give the hand is braked away.
#pragma once

#include "rt_core/state.h"

namespace palpate {

// Adds this tick's value to `force_N`, the coupling's, while the tool touches; it never turns its normal part round. It
// begins when a tool that touched nothing in the last tick touches at 10 mm/s or more and nothing rings; no touch
// begins another until a hundredth is left. Nothing where the scene has none.
void ring(const Model& model, State& state, const Scratch& scratch, Vec3& force_N) PALPATE_RT;

}  // namespace palpate
