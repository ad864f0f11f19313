#include "rt_core/safety/seat.h"

#include "rt_core/decay.h"
#include "rt_core/safety/hand_velocity.h"

namespace palpate {

namespace {

// Energy that is not paid is let go within so many ticks, and so much of the coupling's stretch in one at most: as fast
// as a surplus is braked away (hand_energy.cpp).
constexpr Real kYield_ticks = 8;
// In free air the end goes back by so much of the handle's way in a tick, and of the coupling's longest stretch. What
// is met then is met by 0.25 % of the largest force, 21 mN with 8.5 N: less than the shipped device's friction.
constexpr Real kFreeWayShare = 0.25, kFreeStepShare = 0.0025;
constexpr Real kFreeStep_rad = 1e-3;  // of a device without torque
// Nobody goes farther within the silence that latches a fault; turns stay those of a Twist. What is more is the tool's.
constexpr Real kSeatMost_m = 0.05, kSeatMost_rad = 0.5;
// Of the largest force: less holds nothing.
constexpr Real kNothingShare = 1e-3;

bool at_rest(const State& state) PALPATE_RT {
  return state.safety.mode == Mode::kIdle || state.safety.mode == Mode::kFault;
}

// Nothing of the object pulled at the tool in the last tick.
bool in_air(const SafetyState& safety) PALPATE_RT {
  return squared_norm(safety.object_w.force_N) == 0 && squared_norm(safety.object_w.torque_Nm) == 0;
}

Real work_J(const Wrench& w, const Twist& way) PALPATE_RT {
  return dot(w.force_N, way.translation_m) + dot(w.torque_Nm, way.rotation_rad);
}

// What coupling and object would give a hand that is let go, by the object's tangent along the force.
Real held_J(const ModelParams& p, const State& state) PALPATE_RT {
  const SafetyState& safety = state.safety;
  const Vec3 force_N = safety.last_good_w.force_N, along = unit_or(force_N, {});
  const double* k = state.contact_stiffness;
  const Vec3 answer{k[0] * along.x + k[1] * along.y + k[2] * along.z, k[6] * along.x + k[7] * along.y + k[8] * along.z,
                    k[12] * along.x + k[13] * along.y + k[14] * along.z};
  const Real object = max_of(dot(along, answer) * state.live.stiffness, 1e-3 * p.coupling_N_per_m);
  const Real turned_J = 0.5 * squared_norm(safety.last_good_w.torque_Nm) / p.coupling_Nm_per_rad;
  return min_of(max_of(0, safety.stored_J),
                0.5 * squared_norm(force_N) * (1 / p.coupling_N_per_m + 1 / object) + turned_J);
}

// `apart` after a tick: home as far as `stretch`, from the end to the tool, becomes shorter by it; else by `own`.
Vec3 eased(Vec3 apart, Vec3 stretch, Real own) PALPATE_RT {
  const Real size = norm(apart);
  if (!(size > 0)) return {};
  const Real shorter = -dot(stretch, apart) / size;
  const Real step = shorter > 0 ? shorter : own;
  return step < size ? (1 - step / size) * apart : Vec3{};
}

// Lets the end go towards the tool for what is not paid: a stretch s less by a share of it lets go share K s^2.
Twist yielded(const ModelParams& p, SafetyState& safety, const Twist& stretch) PALPATE_RT {
  if (!(safety.unpaid_J > 0)) return {};
  const Real whole_J = p.coupling_N_per_m * squared_norm(stretch.translation_m) +
                       p.coupling_Nm_per_rad * squared_norm(stretch.rotation_rad);
  const Real nothing_N = kNothingShare * p.force_max_N, nothing_m = nothing_N / p.coupling_N_per_m;
  if (squared_norm(stretch.translation_m) < nothing_m * nothing_m &&
      squared_norm(safety.object_w.force_N) < nothing_N * nothing_N)
    safety.unpaid_J = 0;
  const Real share = safety.unpaid_J < whole_J ? safety.unpaid_J / whole_J : 1;
  return {(share / kYield_ticks) * stretch.translation_m, (share / kYield_ticks) * stretch.rotation_rad};
}

}  // namespace

bool comes_anew(const Model& model, const State& state, const Input& input, const Pose& handle_w) PALPATE_RT {
  const ModelParams& p = model.params;
  if (state.started == 0 || at_rest(state)) return false;
  if ((input.commands & Command::kStall) != 0) return false;  // the simulated device stood still with the machine
  if (state.unseen_ticks > p.silence_hold_ticks) return true;
  if (input.overrun_ticks > static_cast<std::uint32_t>(p.silence_hold_ticks)) return true;
  if (state.rejected_ticks == 0) return false;
  const double elapsed_s = p.period_s * (1.0 + input.overrun_ticks + state.rejected_ticks);
  const Vec3 beyond_m = handle_w.position_m - state.told_w.position_m - elapsed_s * state.hand_velocity_m_per_s;
  return norm(beyond_m) > bend_m(p, p.period_s);
}

void seat_anew(const Model& model, State& state, const Pose& handle_w) PALPATE_RT {
  SafetyState& safety = state.safety;
  std::uint32_t beaten = 0;
  const Pose end = held_end(model, coupling_end(state), safety.tool_corrected_w, beaten);
  const Twist way = twist_between(state.device_w, handle_w);
  const Wrench &now = safety.last_device_w, &before = safety.last_good_w;
  const Real got_J = max_of(work_J(now, way), work_J(before, way));
  const Real unpaid_J = state.apart != 0 ? safety.unpaid_J : max_of(0, safety.surplus_J);
  const bool over = squared_norm(now.force_N) == 0 && squared_norm(now.torque_Nm) == 0;
  safety.unpaid_J = over ? held_J(model.params, state) : max_of(0, unpaid_J + got_J);
  const Twist apart = twist_between(handle_w, end);
  state.seat_m = shortened(apart.translation_m, kSeatMost_m);
  state.seat_rad = shortened(apart.rotation_rad, kSeatMost_rad);
  state.apart = 1;
  state.device_w = state.device_previous_w = state.told_w = handle_w;
  state.observed_m = state.observed_rad = {};
  state.edges_m = state.edges_rad = {};
  state.track = {handle_w.position_m, 0};
}

void ease_seat(const Model& model, State& state) PALPATE_RT {
  const ModelParams& p = model.params;
  SafetyState& safety = state.safety;
  if (at_rest(state) || !is_finite(state.seat_m) || !is_finite(state.seat_rad)) return forget_seat(state);
  Twist stretch = twist_between(coupling_end(state), safety.tool_corrected_w);
  const Twist yield = yielded(p, safety, stretch);
  stretch.translation_m -= yield.translation_m;
  stretch.rotation_rad -= yield.rotation_rad;
  const bool loose = in_air(safety);
  const Twist way = twist_between(state.device_previous_w, state.device_w);
  const Real step_m = kFreeWayShare * norm(way.translation_m) + kFreeStepShare * p.force_max_N / p.coupling_N_per_m;
  const Real step_rad =
      kFreeWayShare * norm(way.rotation_rad) +
      (p.torque_max_Nm > 0 ? kFreeStepShare * p.torque_max_Nm / p.coupling_Nm_per_rad : kFreeStep_rad);
  const Vec3 apart_m = eased(state.seat_m + yield.translation_m, stretch.translation_m, loose ? step_m : 0);
  const Vec3 apart_rad = eased(state.seat_rad + yield.rotation_rad, stretch.rotation_rad, loose ? step_rad : 0);
  state.seat_m = settled(shortened(apart_m, kSeatMost_m));
  state.seat_rad = settled(shortened(apart_rad, kSeatMost_rad));
  if (squared_norm(state.seat_m) == 0 && squared_norm(state.seat_rad) == 0 && !(safety.unpaid_J > 0) &&
      safety.ramp >= 1)
    forget_seat(state);
}

void count_unpaid(State& state, double made_J) PALPATE_RT {
  double& unpaid_J = state.safety.unpaid_J;
  unpaid_J = is_finite(unpaid_J + made_J) ? clamp_to(unpaid_J + made_J, 0, kHuge) : 0;
}

void forget_seat(State& state) PALPATE_RT {
  state.apart = 0;
  state.seat_m = state.seat_rad = {};
  state.safety.unpaid_J = 0;
}

}  // namespace palpate
