#include "rt_core/tool/virtual_coupling.h"

#include <type_traits>

#include "rt_core/cholesky.h"
#include "rt_core/contact/contact_stiffness.h"
#include "rt_core/decay.h"
#include "rt_core/safety/seat.h"
#include "rt_core/tool/landing.h"
#include "rt_core/tool/two_tools.h"

namespace palpate {

namespace {

constexpr std::integral_constant<std::int32_t, 6> kDof;  // loops over it are unrolled

// After one swing of the force (safety/hand_energy.h) the tool may go a fifth as far by itself, after two a ninth: two
// states of contact that throw it to and fro lose it within a few ticks. Without this snap_in_paper, dragged sideways
// in its seat, alternated by 0.8 N for as long as it was dragged (2026-11-22).
constexpr Real kSwingCalm = 4;

// How far the tool may go by itself, of the coupling's longest stretch, when the hand goes `hand` of it; `calm`: under
// a hand at rest. Friction that may give energy back needs the wide step: held to the narrow one its surplus grew to
// kUnstable in a slide of heart_compass_paper with that friction (2026-11-23). While no force is rendered there is
// nothing to step, and what asks whether the tool starts inside the body must not wait until it has come out. While the
// coupling's end stands apart (safety/seat.h) the end gives way to a surplus, so that such friction does without: with
// the wide step its force swung in 2 ticks after gaps (heart_compass_paper, 2026-11-25).
Real own_share(const ModelParams& p, const State& state, Real hand, Real calm) PALPATE_RT {
  const bool gives = p.friction_law == FrictionLaw::kPaper || p.friction_law == FrictionLaw::kPreslidingPaper;
  return (gives && state.apart == 0) || state.safety.mode != Mode::kForce
             ? kToolStepShare
             : clamp_to(kFollowShare * hand, calm, kToolStepShare);
}

// Cholesky factor of contact_stiffness + diag(coupling). Returns false when singular.
bool factor(const Model& model, const double (&contact_stiffness)[36], Real (&matrix)[36]) PALPATE_RT {
  __builtin_memcpy(matrix, contact_stiffness, sizeof matrix);
  for (std::int32_t i = 0; i < 3; ++i) {
    matrix[i * (kDof + 1)] += model.params.coupling_N_per_m;
    matrix[(i + 3) * (kDof + 1)] += model.params.coupling_Nm_per_rad;
  }
  return cholesky_factor(matrix, kDof);
}

// The motion under a wrench, of the Cholesky factor.
Twist solved(const Real (&factor)[36], const Wrench& wrench) PALPATE_RT {
  const Vec3 f = wrench.force_N, m = wrench.torque_Nm;
  Real x[kDof] = {f.x, f.y, f.z, m.x, m.y, m.z};
  cholesky_solve(factor, x, kDof);
  return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
}

// Springs of the slipping regions that `motion` of the tool would turn back. Returns whether there are any.
bool add_reversals(const State& state, const Twist& motion, ContactStiffness& stiffness) PALPATE_RT {
  bool any = false;
  for (const Region& region : state.region) {  // bound: kMaxRegions
    if (region.id == 0 || region.lost_ticks > 0 || !(region.reversal_N_per_m > 0)) continue;
    if (region.hand != hand_of(state)) continue;
    const Vec3 arm = region.centre_w - state.tool_w.position_m;
    const Vec3 forward = unit_or(region.stretch_w, {});
    if (!(dot(motion.translation_m + cross(motion.rotation_rad, arm), forward) < 0)) continue;
    add_spring(stiffness, region.reversal_N_per_m, forward, cross(arm, forward));
    any = true;
  }
  return any;
}

// Motion of the tool from `from` under a wrench: the tangent is right for slipping forwards, so try that first. False,
// `motion` untouched, when it is singular. Adds to `landings` what looking for them took (Work), and to `held`, if
// given, what holds the tool there.
bool answer(const Model& model, const State& state, const Pose& from, const Wrench& wrench, Twist& motion,
            std::int32_t& landings, ContactStiffness* held) PALPATE_RT {
  Real matrix[kDof * kDof];
  if (!factor(model, state.contact_stiffness, matrix)) return false;
  Twist answered = solved(matrix, wrench);
  ContactStiffness further;
  if (add_reversals(state, answered, further)) {
    double stiffer[36];
    store(further, stiffer);
    for (std::int32_t k = 0; k < 36; ++k) stiffer[k] += state.contact_stiffness[k];  // bound: 36
    if (!factor(model, stiffer, matrix)) return false;
    answered = solved(matrix, wrench);
  }
  if (touches_in_parts(model)) landings += 1 + land(model, state, from, matrix, answered, held);
  motion = answered;
  return true;
}

}  // namespace

Twist twist_between(const Pose& from, const Pose& to) PALPATE_RT {
  return {to.position_m - from.position_m, small_rotation_vector(to.orientation * conjugate(from.orientation))};
}

Pose moved(const Pose& pose, const Twist& twist) PALPATE_RT {
  return {settled(pose.position_m + twist.translation_m),
          settled(normalised(small_rotation(twist.rotation_rad) * pose.orientation))};
}

bool follow(const Model& model, const State& state, const Twist& handle, Twist& tool,
            std::int32_t& landings) PALPATE_RT {
  tool = handle;
  return answer(
      model, state, state.safety.tool_corrected_w,
      {model.params.coupling_N_per_m * handle.translation_m, model.params.coupling_Nm_per_rad * handle.rotation_rad},
      tool, landings, nullptr);
}

bool correct(const Model& model, const State& state, const Wrench& contact_w, const Wrench& coupling_on_tool_w,
             Twist& correction, std::int32_t& landings, ContactStiffness* held) PALPATE_RT {
  correction = {};
  return answer(model, state, state.tool_w,
                {contact_w.force_N + coupling_on_tool_w.force_N, contact_w.torque_Nm + coupling_on_tool_w.torque_Nm},
                correction, landings, held);
}

void balance_tool(const Model& model, const State& state, Scratch& scratch) PALPATE_RT {
  scratch.tool_corrected_w = scratch.driven ? state.tool_w : state.safety.tool_corrected_w;
  const Wrench& contact_w = scratch.contact_wrench_w;
  if (scratch.driven || !is_finite(contact_w.force_N) || !is_finite(contact_w.torque_Nm)) return;
  const Wrench on_handle = coupling_wrench(model, scratch.grip_w, state.tool_w);
  const Wrench on_tool{-on_handle.force_N, -on_handle.torque_Nm};
  Twist correction;
  ContactStiffness* held = model.params.local_period_s > 0 ? &scratch.told_besides : nullptr;
  if (!correct(model, state, contact_w, on_tool, correction, scratch.work.landings_again, held))
    scratch.status |= Status::kCouplingSingular;
  scratch.tool_corrected_w = moved(state.tool_w, correction);
  if (scratch.held_by_hand != 0)
    scratch.tool_corrected_w = within_step(model, state, scratch.tool_corrected_w, scratch.status);
}

Pose held_end(const Model& model, const Pose& device_w, const Pose& tool_w, std::uint32_t& status) PALPATE_RT {
  const ModelParams& p = model.params;
  const Twist offset = twist_between(tool_w, device_w);
  const Real stretch_m = norm(offset.translation_m), most_m = p.force_max_N / p.coupling_N_per_m;
  const Real turn_rad = norm(offset.rotation_rad), most_rad = p.torque_max_Nm / p.coupling_Nm_per_rad;
  Pose end = device_w;
  if (stretch_m > most_m) {
    end.position_m = tool_w.position_m + (most_m / stretch_m) * offset.translation_m;
    status |= Status::kForceClamped;
  }
  if (most_rad > 0 && turn_rad > most_rad) {
    end.orientation = normalised(small_rotation((most_rad / turn_rad) * offset.rotation_rad) * tool_w.orientation);
    status |= Status::kTorqueClamped;
  }
  return end;
}

Pose within_step(const Model& model, const State& state, const Pose& tool_w, std::uint32_t& status) PALPATE_RT {
  const ModelParams& p = model.params;
  const Pose& from = state.safety.tool_corrected_w;
  const Twist step = twist_between(from, tool_w), hand = twist_between(state.device_previous_w, state.device_w);
  const Real reach_m = p.force_max_N / p.coupling_N_per_m, reach_rad = p.torque_max_Nm / p.coupling_Nm_per_rad;
  const Real way_m = norm(hand.translation_m), way_rad = norm(hand.rotation_rad);
  const Real fast = max_of(reach_m > 0 ? way_m / reach_m : 0, reach_rad > 0 ? way_rad / reach_rad : 0);
  const Real tired = 1 + kSwingCalm * state.safety.swings;
  const Real calm = min_of(kCalmStepShare, kCalmSpeed_m_per_s * p.period_s / reach_m);
  const Real most_m = own_share(p, state, fast, calm) / tired * reach_m + way_m, length_m = norm(step.translation_m);
  Real share = length_m > most_m ? most_m / length_m : 1;
  if (reach_rad > 0) {
    const Real most_rad = own_share(p, state, fast, kCalmStepShare) / tired * reach_rad + way_rad,
               turn_rad = norm(step.rotation_rad);
    if (turn_rad > most_rad) share = min_of(share, most_rad / turn_rad);
  }
  if (!(share < 1)) return tool_w;
  status |= Status::kToolHeldBack;
  return moved(from, {share * step.translation_m, share * step.rotation_rad});
}

Wrench coupling_wrench(const Model& model, const Pose& device_w, const Pose& tool_w) PALPATE_RT {
  const Twist offset = twist_between(device_w, tool_w);
  return {model.params.coupling_N_per_m * offset.translation_m, model.params.coupling_Nm_per_rad * offset.rotation_rad};
}

FeltStiffness felt_stiffness(const Model& model, const State& state, const Scratch& scratch) PALPATE_RT {
  const ModelParams& p = model.params;
  if (!asks_what_is_felt(p) || scratch.held_by_hand == 0) return {};
  // The contact was found in units of the stiffness that is set during the run (live_model.h).
  const bool touches = scratch.contact_count > 0;
  Real matrix[kDof * kDof], contact[kDof * kDof];
  store(scratch.told_besides, contact);
  for (std::int32_t i = 0; i < kDof * kDof; ++i)  // bound: 36
    contact[i] = state.live.stiffness * (contact[i] + (touches ? state.contact_stiffness[i] : 0));
  if (!touches && !(contact[0] + contact[7] + contact[14] > 0)) return {};
  if (!factor(model, contact, matrix)) return {};
  const Real k = p.coupling_N_per_m;
  Real answer[3][kDof] = {};
  for (std::int32_t i = 0; i < 3; ++i) {  // bound: 3
    answer[i][i] = k;
    cholesky_solve(matrix, answer[i], kDof);
  }
  const auto across = [&](int i, int j) { return -0.5 * k * (answer[i][j] + answer[j][i]); };
  return {{k * max_of(0, 1 - answer[0][0]), k * max_of(0, 1 - answer[1][1]), k * max_of(0, 1 - answer[2][2])},
          {across(1, 2), across(0, 2), across(0, 1)}};
}

namespace {

// Where the handle stands on a spring whose force ends at F_max.
struct OnSpring {
  Vec3 inward;    // unit, from the tool to the handle
  Real beyond_m;  // the place of F_max; below 0: so far before it, the object giving way too
  Real tick_m;    // inwards in the last tick
};
OnSpring on_spring(const ModelParams& p, const State& state, const FeltStiffness& felt) PALPATE_RT {
  const Vec3 stretch = coupling_end(state).position_m - state.safety.tool_corrected_w.position_m;
  const Vec3 inward = unit_or(stretch, {});
  const Real stiffness = dot(inward, felt * inward), over_m = norm(stretch) - p.force_max_N / p.coupling_N_per_m;
  const Real before_m = stiffness > 0 ? over_m * p.coupling_N_per_m / stiffness : -kHuge;
  return {inward, over_m > 0 ? over_m : before_m,
          dot(state.device_w.position_m - state.device_previous_w.position_m, inward)};
}

}  // namespace

Real share_below_limit(const Model& model, const State& state, const FeltStiffness& felt, Real from_ticks,
                       Real to_ticks) PALPATE_RT {
  if (!(model.params.local_period_s > 0)) return 1;
  const OnSpring at = on_spring(model.params, state, felt);
  const Real from_m = at.beyond_m + from_ticks * at.tick_m, to_m = at.beyond_m + to_ticks * at.tick_m;
  constexpr Real kStill_m = 1e-9;
  if (!(abs_of(to_m - from_m) > kStill_m)) return at.beyond_m < 0 ? 1 : 0;
  return clamp_to((min_of(to_m, 0) - min_of(from_m, 0)) / (to_m - from_m), 0, 1);
}

LocalFelt local_felt(const Model& model, const State& state, const FeltStiffness& felt) PALPATE_RT {
  // What a hand's acceleration adds to its motion of the last tick; 100 m/s^2 is a fist that is let go.
  constexpr Real kAcceleration_m_per_s2 = 100;
  const ModelParams& p = model.params;
  const Vec3 handle_m = state.device_w.position_m;
  if (!(p.local_period_s > 0)) return {{}, handle_m};
  const Real until_s = p.period_s + p.delay_s, until_ticks = until_s / p.period_s;
  const bool full =
      norm(state.safety.last_device_w.force_N) >= (1 - 1e-9) * p.force_max_N && state.live.force_limit == 1;
  const OnSpring at = on_spring(p, state, felt);
  if (!(at.beyond_m > 0) && state.safety.ramp >= 1 && state.live.force_limit == 1) return {felt, handle_m};
  if (!full) return {share_below_limit(model, state, felt, 0, until_ticks) * felt, handle_m};
  const Real reach_m = until_ticks * abs_of(at.tick_m) + 0.5 * kAcceleration_m_per_s2 * until_s * until_s;
  if (at.beyond_m > reach_m) return {{}, handle_m};
  return {felt, handle_m - max_of(0, at.beyond_m) * at.inward};
}

}  // namespace palpate
