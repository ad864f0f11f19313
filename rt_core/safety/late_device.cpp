#include "rt_core/safety/late_device.h"

#include "rt_core/live_model.h"

namespace palpate {

namespace {

// A link this far behind is deaf, which the loop judges (hal/loop/link_watch.h).
constexpr std::int32_t kMostLag = 63;
constexpr double kStatedSlack_ticks = 0.25;
// Rendered or about to be, below which no jump of the coupling is felt.
constexpr double kNothing_N = 1e-6, kNothing_Nm = 1e-8;

bool at_rest(const SafetyState& safety) PALPATE_RT { return safety.mode == Mode::kIdle || safety.mode == Mode::kFault; }

bool renders_nothing(const SafetyState& safety) PALPATE_RT {
  if (at_rest(safety)) return true;
  for (const Wrench* w : {&safety.last_good_w, &safety.last_device_w}) {  // bound: 2; no number renders something
    if (!(squared_norm(w->force_N) < kNothing_N * kNothing_N)) return false;
    if (!(squared_norm(w->torque_Nm) < kNothing_Nm * kNothing_Nm)) return false;
  }
  return true;
}

void count(const ModelParams& p, const Input& input, bool resting, LateDevice& late) PALPATE_RT {
  const bool told = input.stale_ticks == 0 && input.overrun_ticks == 0 && (input.commands & Command::kUnheard) == 0;
  if (!told) return;
  const auto lag = static_cast<std::int32_t>(min_of(input.command_lag, kMostLag));
  if (!(lag > p.delay_s / p.period_s + kStatedSlack_ticks)) {
    late.samples = late.ticks == 0 ? 0 : (late.samples < 0 ? late.samples : 0) - 1;  // negative: so many that show none
    if (late.samples > -kFineSamples && !resting) return;
    late.samples = 0;
    late.ticks = 0;
    return;
  }
  late.samples = late.samples < 0 ? 0 : late.samples;
  late.least = late.samples == 0 || lag < late.least ? lag : late.least;
  late.samples += 1;
  if (late.samples < kLateSamples) return;
  late.samples = 0;
  late.ticks = resting || late.least + 1 > late.ticks ? late.least + 1 : late.ticks;
}

}  // namespace

void watch_delay(const Model& model, const Input& input, State& state) PALPATE_RT {
  const ModelParams& p = model.params;
  LateDevice& late = state.late;
  if (input.drive != Drive::kDevice || p.local_period_s > 0) return;
  if (late.ticks < 0 || late.ticks > kMostLag + 1 || late.samples < -kFineSamples) late = {};  // spoilt in memory
  count(p, input, at_rest(state.safety), late);
  late.moves = 0;
  if (late.ticks == 0 && late.coupling == 1) return;
  const double wanted = late.ticks > 0 ? (p.period_s + 2 * p.delay_s) / (p.period_s * (1 + 2 * late.ticks)) : 1;
  const double before = is_finite(late.coupling) ? late.coupling : 1, step = kLiveStep * before;
  late.coupling = renders_nothing(state.safety) ? wanted : clamp_to(wanted, before - step, before + step);
  late.coupling = clamp_to(late.coupling, 1.0 / (3 + 2 * kMostLag), 1);
  late.moves = late.coupling != before ? 1 : 0;
}

void soften(const LateDevice& late, ModelParams& params) PALPATE_RT {
  params.coupling_N_per_m *= late.coupling;
  params.coupling_Nm_per_rad *= late.coupling;
  // K (T / 2 + tau), the coupling's damping, is the same for the softer coupling and the longer delay.
  if (late.ticks > 0) params.delay_s = late.ticks * params.period_s;
}

}  // namespace palpate
