#include "rt_core/safety/hand_energy.h"

#include "rt_core/decay.h"
#include "rt_core/safety/device_shadow.h"
#include "rt_core/safety/late_outputs.h"
#include "rt_core/safety/local_device.h"
#include "rt_core/safety/seat.h"

namespace palpate {

namespace {

// Below 30 mm/s the coupling is not damped: the shipped device's friction of 0.06 N takes more than its spring of
// 2000 N/m makes in 1 ms up to there.
constexpr double kDampingDead_m_per_s = 0.03;
// The rate of the stretch is that of the last 4 ms: an encoder step of 30 um makes 6 mm/s of it, well below the dead
// zone.
constexpr double kDampingSmooth_s = 4e-3;
// A surplus below this lifts a handle of 0.1 kg by 1 mm: no kick, however weak the device (one of 0.05 N holds 0.6 uJ
// in its coupling, which an encoder step makes).
constexpr double kKick_J = 1e-3;
// Nor does a share of what is stored: fingers that squeeze a block hold 17 mJ in it, of which its nodes' energy errs by
// 3.7 while it is turned, slowly; jaws that a hand of 1700 N/m drags over the elastic one 33, of which it errs by 12; a
// stiff coupling of 10,000 N/m holds 3.6 at the largest force (2026-11-26).
constexpr double kStoredShare = 0.5;
// A change of the force counts as a swing from this share of the largest force on.
// A weak device's from what a few encoder steps of 30 um make through a coupling of 1 to 2 N/mm.
constexpr double kSwingShare = 0.02, kSwingLeast_N = 0.1;
// A surplus is braked away over eight ticks: all of it in one makes a force that alternates (10 swings in six taps on
// half_shell, 2026-11-22).
constexpr double kDrain_ticks = 8;
// What a tick seems to swallow is credit for the next ones up to this share of what the coupling holds (0.1 mJ with the
// shipped device): an encoder's staircase is no energy, but only over several of its steps.
constexpr double kCreditShare = 0.005;
// Each swing counts one, and a tick keeps 0.95 of the count: ten are reached by 14 swings in a row, never by one in two
// ticks (9.8), as an encoder step makes.
constexpr double kSwingKept = 0.95, kSwingsMost = 10;

// `brake` against `force_N`, at most to zero along it.
void add_brake(Vec3 brake_N, Vec3& force_N) PALPATE_RT {
  const double size = norm(force_N);
  const Vec3 along = unit_or(force_N, {});
  const double back = -dot(brake_N, along);
  if (back > size) brake_N += (back - size) * along;
  force_N += brake_N;
}

bool is_local(const Model& model) PALPATE_RT { return model.params.local_period_s > 0; }

// What acted on the handle between the last two samples: an output takes the delay to arrive.
Wrench acted(const Model& model, State& state) PALPATE_RT {
  const Late late = late_of(model.params, state.safety.sent, 6);
  return {is_local(model) ? shadow_device(model, state) : late.mean(0), late.mean(3)};
}

// Energy of a spring whose force stays at `most` from there on.
double spring_J(double stretch, double stiffness, double most) PALPATE_RT {
  const double end = most / stiffness;
  return stretch < end ? 0.5 * stiffness * stretch * stretch : most * (stretch - 0.5 * end);
}

// Work of the driven joints on the object since the last tick, at least: what the object stores more and what it did
// on the tool as a whole, E' - E + F dx. Friction takes some of it, which is no credit.
double joint_work_J(const State& state, const Scratch& scratch) PALPATE_RT {
  const SafetyState& safety = state.safety;
  if (state.articulation.moved == 0) return 0;
  const Twist way = twist_between(state.tool_previous_w, state.tool_w);
  const Wrench &now = scratch.contact_wrench_w, &before = safety.object_w;
  return scratch.energy_J - safety.object_J + 0.5 * dot(now.force_N + before.force_N, way.translation_m) +
         0.5 * dot(now.torque_Nm + before.torque_Nm, way.rotation_rad);
}

bool nothing_sent(const SafetyState& safety) PALPATE_RT {
  if (squared_norm(safety.last_device_w.force_N) != 0 || squared_norm(safety.rendered_N) != 0) return false;
  for (const double value : safety.sent) {  // bound: 6 kForceHistory
    if (value != 0) return false;
  }
  return true;
}

// Brakes what the account has too much; the handle went `way_m` in this tick.
void brake_surplus(const Model& model, const State& state, Scratch& scratch, Vec3 way_m, Vec3& force_N) PALPATE_RT {
  const ModelParams& p = model.params;
  const SafetyState& safety = state.safety;
  // A device with a loop of its own smooths its encoder, and is braked on its way out alone: a brake of a hand that
  // comes in would arrive when it goes out again, and push it. A step of the encoder is 30 mm/s of one tick, and the
  // smoothed velocity 6 ms late: the mean of both (swings in 10 ticks with the first alone, 3 ms; 2026-11-25).
  const bool local = is_local(model);
  const Vec3 tick_m_per_s = (1 / p.period_s) * way_m;
  const Vec3 velocity = local ? 0.5 * (tick_m_per_s + state.hand_velocity_m_per_s) : state.hand_velocity_m_per_s;
  const double speed2 = squared_norm(velocity);
  if (!(safety.surplus_J > 0 && speed2 > kDampingDead_m_per_s * kDampingDead_m_per_s)) return;
  if (local && !(dot(force_N, velocity) > 0)) return;
  const double most = p.coupling_N_per_m * (p.period_s + 2 * p.delay_s);
  const double damping = min_of(safety.surplus_J / (kDrain_ticks * p.period_s * speed2), most);
  const double fade =
      local ? 1 - kDampingDead_m_per_s / square_root(speed2) : 1;  // not at once from one tick to the next
  scratch.status |= Status::kEnergyDrained;
  add_brake(-(fade * damping) * velocity, force_N);
}

}  // namespace

void add_coupling_damping(const Model& model, SafetyState& safety, Vec3& force_N) PALPATE_RT {
  const ModelParams& p = model.params;
  const Vec3 stretch_m = (1 / p.coupling_N_per_m) * force_N;
  const Vec3 rate = (1 / (p.period_s + kDampingSmooth_s)) * (stretch_m - safety.stretch_slow_m);
  safety.stretch_slow_m = settled(safety.stretch_slow_m + p.period_s * rate);
  const double speed = norm(rate);
  if (!(speed > kDampingDead_m_per_s)) return;
  add_brake((p.coupling_Ns_per_m * (1 - kDampingDead_m_per_s / speed)) * rate, force_N);
}

void drain_energy(const Model& model, State& state, Scratch& scratch, const Input& input, double given_J,
                  Vec3& force_N) PALPATE_RT {
  const ModelParams& p = model.params;
  SafetyState& safety = state.safety;
  const Twist stretch = twist_between(safety.tool_corrected_w, coupling_end(state));
  const double stored_J =
      scratch.energy_J + spring_J(norm(stretch.translation_m), p.coupling_N_per_m, p.force_max_N) +
      spring_J(norm(stretch.rotation_rad), p.coupling_Nm_per_rad, p.torque_max_Nm > 0 ? p.torque_max_Nm : kHuge);
  const Twist way = twist_between(state.device_previous_w, state.device_w);
  const Wrench on_handle = acted(model, state);
  const bool counts = safety.mode == Mode::kForce && safety.ramp >= 1 && input.stale_ticks == 0 &&
                      input.overrun_ticks == 0 && (scratch.status & Status::kInputRejected) == 0 &&
                      state.live.moves == 0 && state.late.moves == 0;
  const double made_J = dot(on_handle.force_N, way.translation_m) + dot(on_handle.torque_Nm, way.rotation_rad) +
                        stored_J - safety.stored_J - joint_work_J(state, scratch) - given_J;
  const double most_J = 0.5 * p.force_max_N * p.force_max_N / p.coupling_N_per_m;
  if (state.apart != 0) count_unpaid(state, made_J);
  safety.stored_J = stored_J;
  safety.object_J = scratch.energy_J;
  safety.object_w = scratch.contact_wrench_w;
  safety.surplus_J = counts && is_finite(made_J) ? max_of(-kCreditShare * most_J, safety.surplus_J + made_J) : 0.0;
  if (squared_norm(force_N) == 0 && nothing_sent(safety)) safety.surplus_J = 0;
  brake_surplus(model, state, scratch, way.translation_m, force_N);
}

bool is_unstable(const Model& model, SafetyState& safety, Vec3 force_N, double hand_m_per_s) PALPATE_RT {
  const ModelParams& p = model.params;
  const Vec3 step = force_N - safety.last_coupling_N;
  const double least = max_of(kSwingLeast_N, kSwingShare * p.force_max_N);
  const bool large = squared_norm(step) > least * least && squared_norm(safety.last_step_N) > least * least;
  const bool back = large && dot(step, safety.last_step_N) < -0.5 * norm(step) * norm(safety.last_step_N);
  safety.swings = settled(kSwingKept * safety.swings + (back ? 1 : 0));
  safety.last_step_N = step;
  safety.last_coupling_N = force_N;
  const double slope_J =
      is_local(model) ? hand_m_per_s * p.force_max_N / (2e3 * kLocalSlopeShare_per_ms) : 0.0;  // v F^2 / (2 slope)
  const double held_J = 0.5 * p.force_max_N * p.force_max_N / p.coupling_N_per_m + slope_J;
  const double most_J = max_of(kKick_J, max_of(held_J, kStoredShare * safety.stored_J));
  return safety.swings > kSwingsMost || safety.surplus_J > most_J;
}

void remember_output(const Model& model, SafetyState& safety, const LocalFelt& told) PALPATE_RT {
  const Wrench& w = safety.last_device_w;
  const double now[6] = {w.force_N.x, w.force_N.y, w.force_N.z, w.torque_Nm.x, w.torque_Nm.y, w.torque_Nm.z};
  remember(now, 6, safety.sent);
  if (is_local(model)) remember_told(safety, told);
}

}  // namespace palpate
