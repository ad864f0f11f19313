// Which handles may be smoothed within their encoder's step (encoder_observer.h): those that their friction holds.
//
// A smoothed handle is late, and what it is late by works for the motion; without friction it goes to and fro at rest.
// It is never farther off than two steps, so friction of 2 K Delta takes all of it from whatever hand and mass: the
// most that is asked. A slow motion is followed closer: of an amplitude A it gains pi K A^2 sin(w tau) a cycle, of
// which friction takes 4 f A. And where a handle rests on the edge between two steps, each of them pushes it across: as
// told, by K Delta, so that f must be half of that (Abbott & Okamura 2005); smoothed, by that and what the estimate
// overshoots. Kicks of 0.06 to 1.5 mm, in the middle of a step and at its edges, hands of 100 to 2000 N/m and 0.05 to
// 0.2 kg, handles of 0.05 to 0.5 kg, damping of 0.5 to 12 N s/m, delay of 0 to 3 ms, ticks of 0.25 to 2 ms
// (tests/core/test_encoder_observer.cpp plays it; 2026-11-26): all 1,296 come to rest with f of 0.98 K Delta, or of
// sqrt(K / m) / (153 rad/s) where that is more, m of 0.1 kg at most: a heavier handle is slower, but what damps it
// weighs less. With 4 % less two do not.
//
// Followed by its edges (edge_observer.h) a handle that rests on one is where it is taken to be, and what pushes it
// across is hardly more than as told. The same play, in eighths of a step, 2026-11-26: 0.5 to 0.62, the most for 0.05
// kg at 8000 N/m. Heavier handles in the lightest hand, with 0.5 N s/m of damping, take 0.6 at 0.4 kg, 0.76 at 0.5
// and 1.2 at 0.8. It leaves more of a tremor's staircase, so it is for those whose friction does not hold them by the
// rule above.
#pragma once

#include "rt_core/laws.h"

namespace palpate {

struct SmoothedHandle {
  Real usual_inertia, least_share, held_below_rad_per_s;
};
inline constexpr SmoothedHandle kSmoothedPosition{0.1, 0.98, 153};
// The same mass 32 mm from the axis, on its track (kObservedAngle). A coupling's own bound leaves 0.625 of K Delta
// where friction makes it (2 f_c / Delta, of which 0.8 is taken), and what turns the handle is coupling and object in
// series: 0.6 is enough where the object is turned by no more than three times the coupling's stiffness, as by tips
// of 1.7 N/mm 70 mm apart.
inline constexpr SmoothedHandle kSmoothedAngle{1e-4, 0.6, 158};
// Held by the local model's coupling, several times as stiff, an object may turn the tool ten times as stiffly as the
// coupling of the angle does, and the handle feels all of that: on its track the angle of a compass on heart_compass
// went to and fro by a step, 9 mN at the tip (2026-11-27). From 0.9 of the coupling on it takes what a position does;
// with less it is followed by its edges.
inline constexpr SmoothedHandle kSmoothedFirmAngle{1e-4, 0.98, 158};

inline Real friction_to_smooth(EncoderLaw law, const SmoothedHandle& handle, Real stiffness, Real step, Real inertia) {
  constexpr Real kEdgeShare = 0.62, kHeavy = 4;  // times the usual
  if (law == EncoderLaw::kEdges)
    return kEdgeShare * max_of(1, inertia / (kHeavy * handle.usual_inertia)) * stiffness * step;
  constexpr Real kMostShare = 2;  // kObserverReach and half a step
  const Real own_rad_per_s = square_root(stiffness / min_of(inertia, handle.usual_inertia));
  return clamp_to(own_rad_per_s / handle.held_below_rad_per_s, handle.least_share, kMostShare) * stiffness * step;
}

// How a handle with so much friction is observed if it is smoothed at all, and what that asks for.
struct SmoothingNeed {
  EncoderLaw law;
  Real friction;
};
inline SmoothingNeed smoothing_need(const SmoothedHandle& handle, Real stiffness, Real step, Real inertia,
                                    Real friction) {
  const Real motion = friction_to_smooth(EncoderLaw::kMotion, handle, stiffness, step, inertia);
  const Real edges = friction_to_smooth(EncoderLaw::kEdges, handle, stiffness, step, inertia);
  if (friction >= motion || edges >= motion) return {EncoderLaw::kMotion, motion};
  return {EncoderLaw::kEdges, edges};
}

}  // namespace palpate
