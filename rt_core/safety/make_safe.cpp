// The last stage of every tick, in every mode, for every model:
//   wrench of the virtual coupling -> its damping, energy -> finite? -> magnitude -> mode gain -> rate.
#include "rt_core/safety/contact_transient.h"
#include "rt_core/safety/hand_energy.h"
#include "rt_core/safety/local_device.h"
#include "rt_core/safety/mode_machine.h"
#include "rt_core/safety/seat.h"
#include "rt_core/tick.h"
#include "rt_core/tool/held_body.h"
#include "rt_core/tool/two_tools.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

namespace {

bool is_finite_wrench(const Wrench& w) PALPATE_RT { return is_finite(w.force_N) && is_finite(w.torque_Nm); }

// Scales v so that its length is at most `limit`; the direction is kept. Returns whether it had to.
bool clamp_length(Vec3& v, double limit) PALPATE_RT {
  const double length = norm(v);
  if (length <= limit) return false;
  v = (limit / length) * v;
  return true;
}

// After a non-finite number anywhere: drop contact memory and start again from the handle's pose.
void restart_contact(State& state) PALPATE_RT {
  state.tool_w = state.tool_previous_w = state.safety.tool_corrected_w = state.device_w;
  state.safety.ring_N = state.safety.ring_before_N = {};
  forget_seat(state);
  forget_contact(state);
}

Wrench limited(const Model& model, Wrench wrench, Scratch& scratch) PALPATE_RT {
  const bool force = clamp_length(wrench.force_N, model.params.force_max_N);
  const bool torque = clamp_length(wrench.torque_Nm, model.params.torque_max_Nm);
  if (force) scratch.status |= Status::kForceClamped;
  // A device without torque is not beaten: it has none to give.
  if (torque && model.params.torque_max_Nm > 0) scratch.status |= Status::kTorqueClamped;
  return wrench;
}

// What the last tick put out lies within the limits, to rounding. Were a bit of it flipped since, steps from there
// would take a million ticks to come back (found by scenes.Soak, 2026-11-22).
Wrench within_limits(const Model& model, Wrench last) PALPATE_RT {
  constexpr double kRounding = 1 + 1e-9;
  clamp_length(last.force_N, kRounding * model.params.force_max_N);
  clamp_length(last.torque_Nm, kRounding * model.params.torque_max_Nm);
  return last;
}

// A fault limiter, set above what contact does but for a snap (a slow rate limit inside the loop destabilises it): the
// device's rate, and in no tick more than kOutputStepShare of its limit.
Wrench rate_limited(const Model& model, const Wrench& last, const Wrench& wanted, Scratch& scratch) PALPATE_RT {
  const double step_N =
      min_of(model.params.force_rate_max_N_per_s * model.params.period_s, kOutputStepShare * model.params.force_max_N);
  Vec3 force_step = wanted.force_N - last.force_N;
  Vec3 torque_step = wanted.torque_Nm - last.torque_Nm;
  // Torque may change by the same fraction of its own limit as force does.
  const double step_Nm =
      model.params.force_max_N > 0 ? step_N / model.params.force_max_N * model.params.torque_max_Nm : 0;
  const bool force = clamp_length(force_step, step_N);
  const bool torque = clamp_length(torque_step, step_Nm);
  if (force || torque) scratch.status |= Status::kRateLimited;
  return {last.force_N + force_step, last.torque_Nm + torque_step};
}

// What a device that evaluates the local model has made of the last output by now: the rate is limited from there. It
// followed a tap of 0.3 m/s on 4 N/mm by 1.2 N in a tick, which from the last output itself would be cut to 0.85.
// Before the first force of a contact it was told nothing to follow, and it does not follow an encoder that jumps.
Wrench followed(const State& state, const FeltStiffness& felt, double period_s, Wrench last) PALPATE_RT {
  const Vec3 way_m = state.device_w.position_m - state.device_previous_w.position_m;
  if (squared_norm(last.force_N) == 0 || norm(way_m) > kLocalFastest_m_per_s * period_s) return last;
  last.force_N += -(felt * way_m);
  return last;
}

Findings findings(const State& state, const Input& input, std::uint32_t faults) PALPATE_RT {
  Findings found;
  found.faults = faults;
  found.late_ticks = input.stale_ticks > input.overrun_ticks ? input.stale_ticks : input.overrun_ticks;
  if (input.overrun_ticks > 0 && input.stale_ticks == 0) found.late_fault = Fault::kStalled;
  const auto rejected = static_cast<std::uint32_t>(state.rejected_ticks);
  if (rejected > found.late_ticks) {
    found.late_ticks = rejected;
    found.late_fault = Fault::kSamplesRejected;
  }
  if (state.stale_share > kStaleShareMost) found.faults |= Fault::kSamplesSparse;
  found.pressed = norm(state.safety.last_good_w.force_N) > kArmForceMax_N;
  return found;
}

// Of two hands: both are let go for what either's sample or wrench shows.
Findings together(Findings a, const Findings& b) PALPATE_RT {
  a.faults |= b.faults;
  if (b.late_ticks > a.late_ticks) a.late_ticks = b.late_ticks, a.late_fault = b.late_fault;
  a.pressed = a.pressed || b.pressed;
  return a;
}

// What one hand's tool asks for.
struct Asked {
  FeltStiffness felt;
  Findings found;
};

// A hand's wrench before mode and rate, into state.safety.last_good_w; `given_J`: what another tool did on the body.
Asked judge(const Model& model, State& state, Scratch& scratch, const Input& input, double given_J) PALPATE_RT {
  SafetyState& safety = state.safety;
  const bool driven = input.drive == Drive::kTool;
  Wrench wrench = scratch.contact_wrench_w;
  if (driven || is_finite_wrench(wrench)) safety.tool_corrected_w = scratch.tool_corrected_w;
  if (!driven && is_finite_wrench(wrench)) wrench = coupling_wrench(model, scratch.grip_w, safety.tool_corrected_w);

  std::uint32_t faults = 0;
  if (input.drive == Drive::kDevice && is_finite_wrench(wrench)) {
    if (is_unstable(model, safety, wrench.force_N, norm(state.hand_velocity_m_per_s))) faults |= Fault::kUnstable;
    add_coupling_damping(model, safety, wrench.force_N);
    ring(model, state, scratch, wrench.force_N);
    drain_energy(model, state, scratch, input, given_J, wrench.force_N);
  }
  if (!is_finite_wrench(wrench)) faults |= Fault::kNotFinite;
  if (!is_finite(safety.tool_corrected_w)) faults |= Fault::kStateCorrupt;
  if ((faults & (Fault::kNotFinite | Fault::kStateCorrupt)) != 0) {
    restart_contact(state);
    scratch.contact_wrench_w = {};
    scratch.energy_J = 0;
    wrench = safety.last_good_w;  // ramped out below
  }
  safety.last_good_w = limited(model, wrench, scratch);
  const FeltStiffness felt = felt_stiffness(model, state, scratch);
  if (model.params.track_below_N_per_m > 0) state.feels_N_per_m = stiffness_size(felt.along, felt.across);
  scratch.work.felt += asks_what_is_felt(model.params) ? 1 : 0;
  return {felt, findings(state, input, faults)};
}

void find_mode(const Model& model, State& state, Scratch& scratch, const Input& input,
               const Findings& found) PALPATE_RT {
  SafetyState& safety = state.safety;
  if (input.drive != Drive::kDevice) {  // no device, no hand: nothing to ramp
    safety.fault |= found.faults & (Fault::kNotFinite | Fault::kStateCorrupt);
    safety.mode = safety.fault == 0 ? Mode::kForce : Mode::kFault;
    safety.ramp = safety.fault == 0 ? 1 : 0;
    return;
  }
  advance_mode(model, input, found, safety);
  if (safety.mode == Mode::kIdle && found.pressed && (input.commands & Command::kArm) != 0)
    scratch.status |= Status::kStartsInside;
  if (state.late.ticks > 0) scratch.status |= Status::kDeviceLate;
  if ((input.commands & Command::kUnheard) != 0) scratch.status |= Status::kCommandsUnheard;
  if (safety.ramp < 1 && safety.mode != Mode::kIdle) scratch.status |= Status::kRamping;
}

// How that answers the handle's motion, for a device that evaluates it.
LocalFelt told_with_output(const Model& model, const State& state, const Scratch& scratch,
                           const FeltStiffness& felt) PALPATE_RT {
  const SafetyState& safety = state.safety;
  const LocalFelt told = local_felt(model, state, felt);
  // Nobody knows where the handle is whose sample was refused: the force alone, not a spring from there.
  if ((scratch.status & Status::kInputRejected) != 0) return {{}, told.point_w_m};
  // Without a force there is no sense that it may not turn round against: a spring would pull.
  constexpr double kWireStep_N = 1e-3;
  if (squared_norm(safety.last_device_w.force_N) < kWireStep_N * kWireStep_N) return {{}, told.point_w_m};
  return {safety.ramp * told.felt, told.point_w_m};
}

// What one hand's device is sent, into state.safety.last_device_w; and how that answers the handle's motion.
LocalFelt put_out(const Model& model, State& state, Scratch& scratch, const Input& input,
                  const FeltStiffness& felt) PALPATE_RT {
  SafetyState& safety = state.safety;
  const Wrench scaled{safety.ramp * safety.last_good_w.force_N, safety.ramp * safety.last_good_w.torque_Nm};
  if (input.drive != Drive::kDevice) {
    safety.last_device_w = scaled;
    return {{}, state.device_w.position_m};
  }
  const bool local = model.params.local_period_s > 0;
  if (local) {
    const FeltStiffness before = safety.ramp * share_below_limit(model, state, felt, -1, 0) * felt;
    safety.last_device_w = followed(state, before, model.params.period_s, safety.last_device_w);
  }
  safety.last_device_w = rate_limited(model, within_limits(model, safety.last_device_w), scaled, scratch);
  const LocalFelt told =
      local ? told_with_output(model, state, scratch, felt) : LocalFelt{{}, state.device_w.position_m};
  remember_output(model, safety, told);
  return told;
}

void put_out_second(const Model& model, State& state, Scratch& scratch, const Input& input, const FeltStiffness& felt,
                    Output& output) PALPATE_RT {
  const SafetyState first = state.safety;
  const OthersTurn turn(state, scratch);
  SafetyState& safety = state.safety;
  safety.mode = first.mode;
  safety.fault = first.fault;
  safety.ramp = first.ramp;
  safety.stopping = first.stopping;
  safety.last_commands = first.last_commands;
  const LocalFelt told = put_out(model, state, scratch, input, felt);
  output.second_w = safety.last_device_w;
  output.second_handle_w_m = told.point_w_m;
  output.second_felt_along_N_per_m = told.felt.along;
  output.second_felt_across_N_per_m = told.felt.across;
  output.second_tool_w = state.tool_w;
}

}  // namespace

void make_safe(const Model& model, State& state, Scratch& scratch, const Input& input, Output& output) PALPATE_RT {
  const bool two_tools = has_two_tools(model);
  Asked second;
  double given_J = 0;
  if (two_tools) {
    given_J = work_of_other_J(state, scratch);
    scratch.work.other_outputs += 1;
    const OthersTurn turn(state, scratch);
    second = judge(model, state, scratch, input, work_of_other_J(state, scratch));
  }
  const Asked asked = judge(model, state, scratch, input, given_J);
  find_mode(model, state, scratch, input, two_tools ? together(asked.found, second.found) : asked.found);
  const LocalFelt told = put_out(model, state, scratch, input, asked.felt);

  const SafetyState& safety = state.safety;
  output.device_w = safety.last_device_w;
  output.handle_w_m = told.point_w_m;
  output.felt_along_N_per_m = told.felt.along;
  output.felt_across_N_per_m = told.felt.across;
  output.surplus_J = safety.surplus_J;
  output.ramp = safety.ramp;
  output.fault = safety.fault;
  output.mode = safety.mode;
  output.late_ticks = state.late.ticks;
  output.second_w = {};
  output.second_handle_w_m = output.second_felt_along_N_per_m = output.second_felt_across_N_per_m = {};
  output.second_tool_w = {};
  if (holds_body(model) && input.drive == Drive::kDevice) render_on_body(model, state, scratch, output);
  if (two_tools) put_out_second(model, state, scratch, input, second.felt, output);
}

}  // namespace palpate
