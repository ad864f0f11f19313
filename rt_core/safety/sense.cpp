#include "rt_core/stages.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

namespace {

// The handle cannot have moved further than its top speed allows in the time since the last accepted sample.
bool is_plausible(const Model& model, const State& state, const Input& input) PALPATE_RT {
  if (!is_finite(input.pose_w)) return false;
  if (state.started == 0) return true;
  const double elapsed_ticks = 1.0 + input.stale_ticks + input.overrun_ticks + state.rejected_ticks;
  const double reach_m = model.params.speed_max_m_per_s * model.params.period_s * elapsed_ticks;
  return norm(input.pose_w.position_m - state.device_w.position_m) <= reach_m;
}

void start_at(State& state, const Pose& pose) PALPATE_RT {
  state.device_w = state.device_previous_w = pose;
  state.tool_w = state.tool_previous_w = pose;
  state.safety.tool_corrected_w = pose;
  state.started = 1;
}

}  // namespace

void sense(const Model& model, State& state, Scratch& scratch, const Input& input) PALPATE_RT {
  scratch.status = 0;
  const bool driven = input.drive == Drive::kTool;  // a press: poses may jump, nobody is holding a device
  scratch.driven = driven ? 1 : 0;
  const bool accepted = driven ? is_finite(input.pose_w) : is_plausible(model, state, input);
  if (accepted) {
    const Pose pose{input.pose_w.position_m, normalised(input.pose_w.orientation)};
    if (state.started == 0) start_at(state, pose);
    state.device_previous_w = state.device_w;
    state.device_w = pose;
    state.rejected_ticks = 0;
  } else {
    scratch.status |= Status::kInputRejected;
    state.device_previous_w = state.device_w;  // held
    state.rejected_ticks += state.rejected_ticks < 1'000'000 ? 1 : 0;
  }
  if (input.stale_ticks > 0) scratch.status |= Status::kInputHeld;

  state.tool_previous_w = state.tool_w;
  if (driven) {
    state.tool_w = state.device_w;
    return;
  }
  Twist tool;
  const Twist handle = twist_between(state.device_previous_w, state.device_w);
  if (!follow(model, state, handle, tool)) scratch.status |= Status::kCouplingSingular;
  state.tool_w = moved(state.safety.tool_corrected_w, tool);
}

}  // namespace palpate
