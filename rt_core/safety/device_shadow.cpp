#include "rt_core/safety/device_shadow.h"

#include "rt_core/decay.h"
#include "rt_core/safety/late_outputs.h"
#include "rt_core/safety/local_device.h"

namespace palpate {

namespace {

// A command as the device has it.
struct Told {
  Vec3 force_N, point_m;
  FeltStiffness felt;
};
Told told_in(const double* of) PALPATE_RT { return {vec_at(of), vec_at(of + 3), {vec_at(of + 6), vec_at(of + 9)}}; }

// F - K (x - p), cut to the limit.
Vec3 evaluated_N(const ModelParams& p, const Told& told, Vec3 at_m) PALPATE_RT {
  return shortened(not_turned_round(told.force_N - told.felt * (at_m - told.point_m), told.force_N), p.force_max_N);
}

Real slope_N_per_tick(const ModelParams& p, const FeltStiffness& felt) PALPATE_RT {
  const Real stiffness = stiffness_size(felt.along, felt.across);
  return 1e3 * p.period_s * p.force_max_N *
         local_slope_share_per_ms(kLocalSlopeShare_per_ms, stiffness, p.encoder_step_m, p.force_max_N);
}

struct Way {
  Vec3 from_m, to_m;
  Real ticks;
};

// One command in force along a way: what it makes of the way acts at once, half of the device's own period late; what
// is left between that and what it says now is approached with the slope. Returns the impulse, in newtons a tick.
Vec3 play(const ModelParams& p, const Told& told, const Way& way, Vec3& rendered_N) PALPATE_RT {
  if (!(way.ticks > 0)) return {};
  const Vec3 wanted_N = evaluated_N(p, told, way.to_m);
  const bool jumped = norm(way.to_m - way.from_m) > kLocalFastest_m_per_s * way.ticks * p.period_s;
  const Vec3 moved_N = jumped ? Vec3{} : wanted_N - evaluated_N(p, told, way.from_m);
  const Real late = min_of(0.5, 0.5 * p.local_period_s / (way.ticks * p.period_s));
  const Vec3 gap_N = wanted_N - rendered_N - moved_N;
  const Real size_N = max_of(norm(gap_N), kNothing), most_N = way.ticks * slope_N_per_tick(p, told.felt);
  const Real closed = min_of(1, most_N / size_N);
  const Real closed_mean = size_N > most_N ? 0.5 * closed : 1 - 0.5 * size_N / most_N;
  const Vec3 mean_N = rendered_N + (0.5 - late) * moved_N + closed_mean * gap_N;
  const Vec3 next_N = turned_no_farther(rendered_N + moved_N + closed * gap_N, rendered_N, told.force_N);
  rendered_N = shortened(next_N, p.force_max_N);
  return way.ticks * mean_N;
}

}  // namespace

Vec3 shadow_device(const Model& model, State& state) PALPATE_RT {
  const ModelParams& p = model.params;
  SafetyState& safety = state.safety;
  if (!is_finite(safety.rendered_N)) safety.rendered_N = {};  // spoilt in memory
  const Vec3 from_m = state.device_previous_w.position_m, to_m = state.device_w.position_m;
  const Late late = late_of(p, safety.told, kToldNumbers);
  const Vec3 middle_m = from_m + late.part * (to_m - from_m);
  const Vec3 first_N = play(p, told_in(late.before), {from_m, middle_m, late.part}, safety.rendered_N);
  const Vec3 mean_N = first_N + play(p, told_in(late.now), {middle_m, to_m, 1 - late.part}, safety.rendered_N);
  safety.rendered_N = settled(safety.rendered_N);
  return mean_N;
}

void remember_told(SafetyState& safety, const LocalFelt& told) PALPATE_RT {
  const Vec3 force_N = safety.last_device_w.force_N, p = told.point_w_m, d = told.felt.along, o = told.felt.across;
  const double now[kToldNumbers] = {force_N.x, force_N.y, force_N.z, p.x, p.y, p.z, d.x, d.y, d.z, o.x, o.y, o.z};
  remember(now, kToldNumbers, safety.told);
}

}  // namespace palpate
