// Where a handle is between two steps of its encoder.
//
// An encoder of 30 um tells a moving hand as a staircase, and a coupling of 2 N/mm makes 60 mN of every stair: 96 to 99
// % of the force between 50 and 500 Hz (2026-11-22). What is told is an interval; inside it the smoothest motion is
// taken: the estimate goes on with its own velocity and is corrected only by what of the told position lies beyond a
// fifth of a step from it. It is never farther than kObserverReach steps from what was told, so never more than that
// and half a step behind the handle: 60 um with a step of 30 um, 0.2 ms at 0.3 m/s. On a tremor of 0.02 to 0.12 mm at 9
// Hz it was at most 1.3 steps off and left 0.9 um RMS of 4.7 to 8.3 between 50 and 500 Hz (2026-11-25).
#pragma once

#include "rt_core/vec.h"

namespace palpate {

inline constexpr Real kObserverReach = 1.5;  // encoder steps

// Weights of one tick. Stiffness and damping of the correction belong to 23 Hz, above a hand's motion and below what is
// felt as roughness; half of each at most keeps a slow tick's from overshooting. In the dead zone the velocity goes
// within `rest_s`, and within `turn_s` where it still leads away from what was told: what overshoots the step on whose
// edge a handle rests pushes it across and back.
struct ObserverGains {
  Real step, reach, dead, per_s, position, velocity, kept, kept_back;
};
struct ObserverTimes {
  Real rate_s, damping_s, rest_s, turn_s;
};
inline ObserverGains gains_for(Real step, Real reach, Real dead, const ObserverTimes& times, Real period_s) PALPATE_RT {
  const Real ratio = period_s / times.rate_s;
  return {step,
          reach * step,
          dead * step,
          1 / period_s,
          min_of(period_s / times.damping_s, 0.5),
          min_of(ratio * ratio, 0.25) / period_s,
          1 - min_of(period_s / times.rest_s, 0.5),
          1 - min_of(period_s / times.turn_s, 0.5)};
}
// Searched on 2026-11-25 for the least friction that holds a handle at rest (smoothing_friction.h) with no more noise
// of a tremor: with times of 5.8, 10 and 25 ms, a dead zone of 0.25 and no turning it took 1.1 K Delta where it takes
// 0.9.
inline ObserverGains observer_gains(Real step, Real period_s) PALPATE_RT {
  return gains_for(step, kObserverReach, 0.2, {7e-3, 15e-3, 10e-3, 4e-3}, period_s);
}

// One axis: how far the told position lies from the estimate, `ahead`, and its velocity, which is brought up to date.
// Returns the correction of the estimate. Numbers that are none give none.
inline Real observe(const ObserverGains& g, Real ahead, Real& velocity) PALPATE_RT {
  // A motion the estimate cannot follow drags it along, and its velocity in about 5 ms.
  constexpr Real kCatchUp_s = 5e-3;
  const Real inside = clamp_to(ahead, -g.reach, g.reach), over = ahead - inside;
  const Real outside = inside - clamp_to(inside, -g.dead, g.dead);
  if (outside == 0) velocity *= g.kept;
  if (outside * velocity < 0) velocity *= g.kept_back;
  velocity += min_of(g.per_s, 1 / kCatchUp_s) * over + g.velocity * outside;
  if (!(abs_of(velocity) < kHuge)) velocity = 0;
  return over + g.position * outside;
}
inline Vec3 observe(const ObserverGains& g, Vec3 ahead, Vec3& velocity) PALPATE_RT {
  const Real x = observe(g, ahead.x, velocity.x), y = observe(g, ahead.y, velocity.y);
  return {x, y, observe(g, ahead.z, velocity.z)};
}

}  // namespace palpate
