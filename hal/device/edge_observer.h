// Where a handle is between two steps of its encoder, for a device that closes a stiff loop on it.
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
// (2026-11-26, tests/hal/test_edge_observer.cpp). Once a millisecond it is no quieter than the controller's
// (rt_core/safety/encoder_observer.h), which is late by up to 1.1 steps and asks for more friction.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

// What is remembered of each axis.
struct EdgeMemory {
  Vec3 ahead;    // of what was told: where the handle is between two changes
  Vec3 eased;    // what is left of the jumps at changes
  Vec3 speed;    // of the last step
  Vec3 since_s;  // the last change
  Vec3 change;   // the last one
};

inline constexpr double kMostEased = 0.5;  // steps

// `elapsed_s` after the last time, when what is told has changed by `change`. Returns where the handle is, from what is
// told: never farther than half a step and kMostEased of one along an axis. A step of zero gives zero.
Vec3 between_edges(double step, double elapsed_s, Vec3 change, EdgeMemory& memory) noexcept;

}  // namespace palpate
