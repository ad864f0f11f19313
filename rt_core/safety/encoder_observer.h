// Where a handle is between two steps of its encoder.
//
// An encoder of 30 um tells a moving hand as a staircase, and a coupling of 2 N/mm makes 60 mN of every stair: 96 to 99
// % of the force between 50 and 500 Hz (2026-11-22). What is told is an interval; inside it the smoothest motion is
// taken: a track goes on with its own velocity and is corrected only by what of the told position lies beyond a fifth
// of a step from it, and the handle is taken to go as fast as the track and to come to it in some hundredths of a
// second, so that no correction is felt at once. It is never farther than kObserverReach steps from what was told, so
// never more than that and half a step behind the handle: 60 um with a step of 30 um, 0.2 ms at 0.3 m/s. On tremors of
// 8 to 120 um at 9 Hz it leaves 0.49 um RMS between 50 and 500 Hz (as told 5; on the track itself, with times of 7, 15,
// 10 and 4 ms, 0.79), half a step late on the mean (2026-11-26).
#pragma once

#include "rt_core/state_fields.h"
#include "rt_core/vec.h"

namespace palpate {

inline constexpr Real kObserverReach = 1.5;  // encoder steps

// X(type, name, initial, what): what is remembered of each axis.
#define PALPATE_OBSERVED_MOTION(X)                                                         \
  X(Vec3, per_s, {}, "velocity with which the handle goes on between the encoder's steps") \
  X(Vec3, apart, {}, "from where it is taken to be to the track that it comes to")

struct ObservedMotion {
  PALPATE_STATE_FIELDS_OF(PALPATE_OBSERVED_MOTION)
};

// Stiffness and damping of the correction belong to 18 to 23 Hz, above a hand's motion and below what is felt as
// roughness. In the dead zone the velocity goes within `rest_s`, and within `turn_s` where it still leads away from
// what was told: what overshoots the step on whose edge a handle rests pushes it across and back.
struct ObserverTimes {
  Real dead, reach;  // steps
  Real rate_s, damping_s, rest_s, turn_s, eased_s;
};
// Searched on 2026-11-26 for the least noise of tremors among those with which a handle rests that has the friction of
// smoothing_friction.h.
inline constexpr ObserverTimes kObservedPosition{0.23, 1.32, 7.7e-3, 48.5e-3, 30.5e-3, 6.7e-3, 10e-3};
// An angle, which has less friction for its steps, is on its track.
inline constexpr ObserverTimes kObservedAngle{0.2, kObserverReach, 7e-3, 15e-3, 10e-3, 4e-3, 0};

// Weights of one tick; half of each at most keeps a slow tick's from overshooting.
struct ObserverGains {
  Real period_s, reach, most, dead, per_s, position, velocity, kept, kept_back, eased;
};
inline ObserverGains observer_gains(const ObserverTimes& times, Real step, Real period_s) PALPATE_RT {
  const Real ratio = period_s / times.rate_s;
  return {period_s,
          times.reach * step,
          kObserverReach * step,
          times.dead * step,
          1 / period_s,
          min_of(period_s / times.damping_s, 0.5),
          min_of(ratio * ratio, 0.25) / period_s,
          1 - min_of(period_s / times.rest_s, 0.5),
          1 - min_of(period_s / times.turn_s, 0.5),
          period_s / max_of(times.eased_s, period_s)};
}

// One axis: how far the told position lies from the track, `ahead`, and its velocity, which is brought up to date.
// Returns the correction of the track.
inline Real corrected(const ObserverGains& g, Real ahead, Real& velocity) PALPATE_RT {
  // A motion the track cannot follow drags it along, and its velocity in about 5 ms.
  constexpr Real kCatchUp_s = 5e-3;
  const Real inside = clamp_to(ahead, -g.reach, g.reach), over = ahead - inside;
  const Real outside = inside - clamp_to(inside, -g.dead, g.dead);
  if (outside == 0) velocity *= g.kept;
  if (outside * velocity < 0) velocity *= g.kept_back;
  velocity += min_of(g.per_s, 1 / kCatchUp_s) * over + g.velocity * outside;
  return over + g.position * outside;
}

// One axis: what is told now lies `ahead` of where the handle was taken to be a tick ago. Returns by how much it moved.
inline Real observe(const ObserverGains& g, Real ahead, Real& per_s, Real& apart) PALPATE_RT {
  // A state spoilt in memory: nothing goes a metre, or turns by a radian, in a tick.
  if (!(abs_of(apart) <= 2 * g.most)) apart = 0;
  if (!(abs_of(g.period_s * per_s) <= 1)) per_s = 0;
  const Real expected = apart + g.period_s * per_s;
  const Real track = expected + corrected(g, ahead - expected, per_s), on = g.period_s * per_s;
  const Real moved = clamp_to(on + g.eased * (track - on), ahead - g.most, ahead + g.most);
  apart = track - moved;
  return moved;
}
inline Vec3 observe(const ObserverGains& g, Vec3 ahead, ObservedMotion& m) PALPATE_RT {
  const Real x = observe(g, ahead.x, m.per_s.x, m.apart.x), y = observe(g, ahead.y, m.per_s.y, m.apart.y);
  return {x, y, observe(g, ahead.z, m.per_s.z, m.apart.z)};
}

}  // namespace palpate
