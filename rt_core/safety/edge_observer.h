// Where a handle is between two steps of its encoder, for a loop that is stiff for the friction that holds the handle:
// a device's own, and the controller's where its motion (encoder_observer.h) would ask for more.
//
// An encoder tells more than where the handle is within a step: when it changes, the handle is on the edge between two
// of them, and two edges and the time between them are a speed. So at a change the estimate is put on the edge that was
// passed, and goes on with the speed of the last step as long as the next change is not overdue; then it goes to what
// is told. A handle that turned round has no speed until it passed two edges. What the estimate jumps by at a change is
// taken over and let go of slowly.
//
// A handle at rest on an edge, which a tremor or the force itself pushes to and fro, changes the reading by a step but
// not the estimate, which is on that edge both times. What is closed on it comes to rest with friction of 0.55 to 0.6 K
// Delta, hardly more than on the reading itself (0.5; Abbott & Okamura 2005). The motion tracked through a dead zone
// that stood here took 0.9, and a still hand felt 20 mN swing at 37 Hz on 4.3 N/mm. Handles of 0.05 to 0.3 kg, hands of
// 100 to 2000 N/m, K of 1300 to 8000 N/m; noise of tremors of 8 to 120 um at 9 Hz between 50 and 500 Hz, in steps of 30
// um: 5.3 um RMS as told, 2.9 by the dead zone, 1.6 now; late by 0.3 of a step at most at 0.3 mm/s to 0.3 m/s
// (2026-11-26, tests/core/test_edge_observer.cpp). Once a millisecond it is no quieter than the controller's
// (rt_core/safety/encoder_observer.h), which is late by up to 1.1 steps and asks for more friction.
#pragma once

#include "rt_core/state_fields.h"
#include "rt_core/vec.h"

namespace palpate {

// X(type, name, initial, what): what is remembered of each axis.
#define PALPATE_EDGE_MEMORY(X)                                                    \
  X(Vec3, ahead, {}, "of what was told: where the handle is between two changes") \
  X(Vec3, eased, {}, "what is left of the jumps at changes")                      \
  X(Vec3, speed, {}, "of the last step")                                          \
  X(Vec3, since_s, {}, "the last change")                                         \
  X(Vec3, change, {}, "the last one")

struct EdgeMemory {
  PALPATE_STATE_FIELDS_OF(PALPATE_EDGE_MEMORY)
};

inline constexpr Real kMostEased = 0.5;  // steps

// `elapsed_s` after the last time, when what is told has changed by `change`. Returns where the handle is, from what is
// told: never farther than half a step and kMostEased of one along an axis. A step of zero gives zero.
Vec3 between_edges(Real step, Real elapsed_s, Vec3 change, EdgeMemory& memory) PALPATE_RT;

// For `elapsed_s` nothing was told; what counts as told is where the handle was taken to be.
inline void bridge_edges(Real elapsed_s, EdgeMemory& memory) PALPATE_RT {
  memory.ahead = memory.eased = {};
  memory.since_s += Vec3{elapsed_s, elapsed_s, elapsed_s};
}

}  // namespace palpate
