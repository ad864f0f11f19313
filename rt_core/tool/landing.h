// What holds the tool at parts of an elastic body that it comes to. In a seat as stiff as a wall a tool that knew of it
// in the next tick alone was 0.1 mm deep at 0.5 m/s, and the model said 900 N (2026-11-26).
#pragma once

#include "rt_core/contact/contact_stiffness.h"
#include "rt_core/io.h"
#include "rt_core/state.h"

namespace palpate {

struct Twist;

// Ends of what the parts' lines have below them that a motion may come to, one after the other: as many as hold a body.
inline constexpr std::int32_t kLandings = 6;

// Turns a motion of the tool from `from` aside, so that it ends on the parts that it would go into: the least of
//   1/2 dm K dm   over   n . m + turn . m >= -gap   of every end,
// dm being the change, K = L L^T, L = `factor`. Forces only push: with springs that began at every part which the
// motion meets, pulling as well, a tube that left a seat between two arms was pulled to where three of their planes
// cross, 37 um down in the seat, and the model said 370 N (2026-11-26). Returns how many ends it took hold of; adds
// what holds the tool at them to `held`, if given.
std::int32_t land(const Model& model, const State& state, const Pose& from, const Real* factor, Twist& motion,
                  ContactStiffness* held) PALPATE_RT;

}  // namespace palpate
