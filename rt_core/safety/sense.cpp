#include "rt_core/tick.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

namespace {

// Not one rotation: bytes of another meaning, or a driver's zeros. Checked before anything normalises it.
bool is_rotation(const Quat& q) PALPATE_RT {
  const double length2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return length2 >= 1 - kQuaternionSlack && length2 <= 1 + kQuaternionSlack;
}

// The handle cannot have moved or turned further than its top speeds allow in the time since the last accepted sample.
// The angle is measured by the chord between the quaternions, 4 sin(angle / 4) = 2 sqrt(2 - 2 |a.b|): 0.1 % short at
// 0.3 rad and 10 % at a half turn, so a turn is never refused that the limit allows.
bool is_plausible(const Model& model, const State& state, const Input& input) PALPATE_RT {
  if (!is_finite(input.pose_w) || !is_rotation(input.pose_w.orientation)) return false;
  if (state.started == 0) return true;
  const double elapsed_ticks = 1.0 + input.stale_ticks + input.overrun_ticks + state.rejected_ticks;
  const double elapsed_s = model.params.period_s * elapsed_ticks;
  const double reach_m = model.params.speed_max_m_per_s * elapsed_s;
  const double reach_rad = model.params.turn_max_rad_per_s * elapsed_s;
  const Quat now = normalised(input.pose_w.orientation), last = state.device_w.orientation;
  const double cosine = abs_of(now.w * last.w + now.x * last.x + now.y * last.y + now.z * last.z);
  const double chord2 = max_of(0.0, 2 - 2 * cosine);
  return norm(input.pose_w.position_m - state.device_w.position_m) <= reach_m && 4 * chord2 <= reach_rad * reach_rad;
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
  scratch.work = {};
  const bool driven = input.drive == Drive::kTool;
  scratch.driven = driven ? 1 : 0;
  const bool nobody_holds = input.drive != Drive::kDevice;  // a press: poses may jump
  const bool accepted = nobody_holds ? is_finite(input.pose_w) : is_plausible(model, state, input);
  if (accepted) {
    const Pose pose{input.pose_w.position_m, normalised(input.pose_w.orientation)};
    if (state.started == 0) start_at(state, pose);
    state.device_previous_w = state.device_w;
    state.device_w = pose;
    state.rejected_ticks = 0;
  } else {
    scratch.status |= Status::kInputRejected;
    state.device_previous_w = state.device_w;  // held
    state.rejected_ticks += state.rejected_ticks < kMaxRejectedTicks ? 1 : 0;
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
