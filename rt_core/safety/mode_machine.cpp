#include "rt_core/safety/mode_machine.h"

namespace palpate {

namespace {

// The loop's reasons to let the force go for a while.
constexpr std::uint32_t kLetGo = Command::kUnheard | Command::kStall;

bool edge(const Input& input, const SafetyState& safety, std::uint32_t command) PALPATE_RT {
  return (input.commands & command) != 0 && (safety.last_commands & command) == 0;
}

double step_of(double duration_s, const Model& model) PALPATE_RT {
  return duration_s > model.params.period_s ? model.params.period_s / duration_s : 1.0;
}

Mode mode_when_late(const Model& model, const Input& input, std::uint32_t late_ticks) PALPATE_RT {
  if ((input.commands & kLetGo) != 0) return Mode::kRamp;
  if (late_ticks == 0) return Mode::kForce;
  if (late_ticks <= static_cast<std::uint32_t>(model.params.silence_hold_ticks)) return Mode::kHold;
  if (late_ticks <= static_cast<std::uint32_t>(model.params.silence_passive_ticks)) return Mode::kPassive;
  return Mode::kRamp;
}

void leave_rest(const Input& input, const Findings& found, SafetyState& safety) PALPATE_RT {
  safety.ramp = 0;
  if (safety.mode == Mode::kFault) {
    if (!edge(input, safety, Command::kReset) || input.device_fault != 0) return;
    safety.fault = 0;
    safety.mode = Mode::kIdle;
    return;
  }
  safety.stopping = 0;
  const bool may_start = found.late_ticks == 0 && !found.pressed && (input.commands & (Command::kStop | kLetGo)) == 0;
  if (edge(input, safety, Command::kArm) && may_start) safety.mode = Mode::kForce;
}

void update_gain(const Model& model, SafetyState& safety) PALPATE_RT {
  switch (safety.mode) {
    case Mode::kForce:
      safety.ramp = min_of(1.0, safety.ramp + step_of(model.params.ramp_in_s, model));
      break;
    case Mode::kPassive:
      safety.ramp *= kPassiveDecay;
      break;
    case Mode::kRamp:
      safety.ramp = max_of(0.0, safety.ramp - step_of(model.params.ramp_out_s, model));
      break;
    case Mode::kHold:
    case Mode::kIdle:
    case Mode::kFault:
      break;
  }
}

}  // namespace

void advance_mode(const Model& model, const Input& input, const Findings& found, SafetyState& safety) PALPATE_RT {
  std::uint32_t faults = found.faults | input.device_fault;
  const bool at_rest = safety.mode == Mode::kIdle || safety.mode == Mode::kFault;
  if (!at_rest && found.late_ticks >= static_cast<std::uint32_t>(model.params.silence_fault_ticks))
    faults |= found.late_fault;
  // At rest nothing is rendered, so a device that is merely silent or deaf (not started yet) is no fault; everything
  // else is.
  if (safety.mode == Mode::kIdle)
    faults &= ~(Fault::kDeviceSilent | Fault::kOverrun | Fault::kStalled | Fault::kDeviceDeaf | Fault::kUnstable |
                Fault::kSamplesSparse);
  safety.fault |= faults;

  if (safety.fault != 0 && safety.mode != Mode::kFault) {
    safety.mode = safety.ramp > 0 ? Mode::kRamp : Mode::kFault;
  } else if (at_rest) {
    leave_rest(input, found, safety);
  } else {
    if ((input.commands & Command::kStop) != 0) safety.stopping = 1;
    safety.mode = safety.stopping != 0 ? Mode::kRamp : mode_when_late(model, input, found.late_ticks);
  }

  update_gain(model, safety);
  if (safety.mode == Mode::kRamp && !(safety.ramp > 0)) {
    safety.ramp = 0;
    if (safety.fault != 0) safety.mode = Mode::kFault;
    if (safety.fault == 0 && safety.stopping != 0) safety.mode = Mode::kIdle;
  }
  safety.last_commands = input.commands;
}

}  // namespace palpate
