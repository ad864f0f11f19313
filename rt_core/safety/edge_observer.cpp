#include "rt_core/safety/edge_observer.h"

#include "rt_core/safety/local_device.h"

namespace palpate {

namespace {

// Searched on 2026-11-26 for little noise of tremors and delay with friction of 0.6 K Delta at most. With 10 ms, 0.4, 6
// ms and 0.65 the noise is a tenth more, with 20 ms, 0.6, 6 ms and 0.7 a tenth less and the delay twice as long.
constexpr Real kEase_s = 12e-3, kToTold_s = 5e-3;
constexpr Real kOverdueShare = 0.9;  // of a step in the time since the last: how far the speed is believed
constexpr Real kLeastStep = 0.25;    // an axis of a linkage moves by parts of a step; less is no edge

// One axis. Of a change by more than a step the last one counts: on its edge the handle was within the time that
// passed. What no handle does is no edge, and the next one has no speed from it: 0.4 ms after a jump of 4 mm a change
// by 98 um was taken for a handle of 0.24 m/s, which through 1.3 N/mm made 0.2 N of 8.5 in a millisecond (2026-11-26).
Real axis(Real step, Real elapsed_s, Real change, Real& ahead, Real& eased, Real& speed, Real& since_s,
          Real& last_change) PALPATE_RT {
  since_s = min_of(since_s + elapsed_s, 1);
  const Real size = abs_of(change);
  if (size > step + kLocalFastest_m_per_s * elapsed_s) {
    speed = last_change = 0;
  } else if (size < kLeastStep * step) {
    const Real most = kOverdueShare * step / since_s;
    speed = clamp_to(speed, -most, most);
    const Real on = ahead - change + elapsed_s * speed;
    ahead = clamp_to(on - min_of(elapsed_s / kToTold_s, 0.5) * on, -0.5 * step, 0.5 * step);
  } else {
    const Real passed = min_of(size, step), sense = change > 0 ? 1 : -1, was = ahead - change + elapsed_s * speed;
    speed = change * last_change > 0 ? change / since_s : 0;
    ahead = 0.5 * sense * (min_of(abs_of(speed) * elapsed_s, passed) - passed);
    const Real jump = clamp_to(was, -1.5 * step, 1.5 * step) - ahead;
    eased += jump;
    since_s = 0;
    last_change = change;
  }
  eased = clamp_to(eased, -kMostEased * step, kMostEased * step);
  eased -= min_of(elapsed_s / kEase_s, 0.5) * eased;
  return ahead + eased;
}

}  // namespace

Vec3 between_edges(Real step, Real elapsed_s, Vec3 change, EdgeMemory& m) PALPATE_RT {
  return {axis(step, elapsed_s, change.x, m.ahead.x, m.eased.x, m.speed.x, m.since_s.x, m.change.x),
          axis(step, elapsed_s, change.y, m.ahead.y, m.eased.y, m.speed.y, m.since_s.y, m.change.y),
          axis(step, elapsed_s, change.z, m.ahead.z, m.eased.z, m.speed.z, m.since_s.z, m.change.z)};
}

}  // namespace palpate
