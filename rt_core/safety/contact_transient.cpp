#include "rt_core/safety/contact_transient.h"

#include "rt_core/decay.h"

namespace palpate {

namespace {

// A handle at rest seems to move by 5 mm/s while an encoder's step of 30 um is in its smoothed velocity
// (hand_velocity.h): below twice that no touch is one.
constexpr double kTouch_m_per_s = 0.01;

// A hand that comes in at `state`'s velocity meets `normal`.
void begin(const Model& model, State& state, Vec3 normal) PALPATE_RT {
  const ModelParams& p = model.params;
  SafetyState& safety = state.safety;
  const double speed = -dot(state.hand_velocity_m_per_s, normal);
  if (!(speed > kTouch_m_per_s)) return;
  safety.ring_before_N = {};
  safety.ring_N = min_of(p.transient_N_per_m_s * speed, p.transient_most * p.force_max_N) * normal;
  safety.ring_ticks = p.transient_ticks;
}

void go_on(const ModelParams& p, SafetyState& safety) PALPATE_RT {
  safety.ring_ticks -= 1;
  // Ended; or a state spoilt in memory.
  const bool rings = safety.ring_ticks > 0 && safety.ring_ticks <= p.transient_ticks && is_finite(safety.ring_N) &&
                     is_finite(safety.ring_before_N);
  if (!rings) {
    safety.ring_N = safety.ring_before_N = {};
    safety.ring_ticks = 0;
    return;
  }
  const Vec3 next = p.transient_turn * safety.ring_N - p.transient_kept * safety.ring_before_N;
  safety.ring_before_N = safety.ring_N;
  safety.ring_N = settled(next);
}

}  // namespace

void ring(const Model& model, State& state, const Scratch& scratch, Vec3& force_N) PALPATE_RT {
  SafetyState& safety = state.safety;
  if (!(model.params.transient_N_per_m_s > 0)) return;
  const bool touches = squared_norm(scratch.contact_wrench_w.force_N) > 0;
  if (safety.ring_ticks != 0) {
    go_on(model.params, safety);
  } else if (touches && squared_norm(safety.object_w.force_N) == 0) {
    begin(model, state, unit_or(scratch.contact_wrench_w.force_N, {}));
  }
  if (!touches) return;
  const Vec3 added = safety.ring_N;
  const double size = norm(added);
  if (!(size > 0)) return;
  const double pushes = dot(force_N, added) / size;  // along it: below 0 it is pushed back against
  force_N += pushes < 0 && size > -pushes ? (-pushes / size) * added : added;
}

}  // namespace palpate
