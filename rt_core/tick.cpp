#include "rt_core/tick.h"

#include "rt_core/float_mode.h"
#include "rt_core/live_model.h"
#include "rt_core/safety/late_device.h"
#include "rt_core/stage_cost.h"
#include "rt_core/tool/held_body.h"

namespace palpate {

void publish(State& state, const Scratch& scratch, Output& output) PALPATE_RT {
  output.contact_w = scratch.contact_wrench_w;
  output.palm_w = scratch.palm_w;
  output.tool_w = state.tool_w;
  output.energy_J = scratch.energy_J;
  output.residual_m = scratch.residual_m;
  output.strain = scratch.strain;
  output.status = scratch.status;
  output.contacts = scratch.contact_count;
  output.regions = 0;
  output.penetration_m = 0;
  for (const Region& region : state.region) {  // bound: kMaxRegions
    if (region.id == 0 || region.lost_ticks > 0) continue;
    output.regions += 1;
    // A state spoilt in memory may hold amplitudes that carry a surface anywhere: told as far, and still a number
    // (2e16 m in one of five million ticks from random states, without a force; 2026-11-22).
    output.penetration_m = clamp_to(region.depth_max_m, output.penetration_m, kHuge);
  }
  state.tick += 1;
}

namespace {

void find_forces(const Model& model, State& state, Scratch& scratch, const Input& input,
                 const StageProbe& probe) PALPATE_RT {
  sense(model, state, scratch, input);
  probe.passed(Stage::kSense);
  articulate(model, state, scratch, input);
  probe.passed(Stage::kArticulate);
  contact(model, state, scratch, probe);
}

// A tick under settings, or with a device, that are not as they were baked.
void tick_as_set(const Model& model, State& state, Scratch& scratch, const Input& input, Output& output,
                 const StageProbe& probe) PALPATE_RT {
  Model set = model;
  apply_in_units_of_stiffness(state.live, set.params);
  soften(state.late, set.params);
  find_forces(set, state, scratch, input, probe);
  to_newtons(state.live, scratch);
  set.params = model.params;
  apply(state.live, set.params);
  soften(state.late, set.params);
  make_safe(set, state, scratch, input, output);
}

// The tick in the body's frame.
void render(const Model& model, State& state, Scratch& scratch, const Input& input, Output& output,
            const StageProbe& probe) PALPATE_RT {
  follow_settings(input.live, state.live);
  watch_delay(model, input, state);
  if (state.live.changed == 0 && state.late.coupling == 1) {
    find_forces(model, state, scratch, input, probe);
    make_safe(model, state, scratch, input, output);
  } else {
    tick_as_set(model, state, scratch, input, output, probe);
  }
  if (is_beyond_stated(model, scratch.work)) scratch.status |= Status::kWorkBeyondStated;
  probe.passed(Stage::kSafety);
  publish(state, scratch, output);
  probe.passed(Stage::kPublish);
}

}  // namespace

void tick(const Model& model, State& state, Scratch& scratch, const Input& input, Output& output,
          const StageProbe& probe) PALPATE_RT {
  const TickFloatMode mode;
  if (!holds_body(model) || input.drive != Drive::kDevice) return render(model, state, scratch, input, output, probe);
  render(model, state, scratch, seen_from_body(model, input), output, probe);
}

}  // namespace palpate
