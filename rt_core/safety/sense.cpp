#include "rt_core/decay.h"
#include "rt_core/safety/edge_observer.h"
#include "rt_core/safety/encoder_observer.h"
#include "rt_core/safety/hand_velocity.h"
#include "rt_core/safety/seat.h"
#include "rt_core/tick.h"
#include "rt_core/tool/two_tools.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

namespace {

// The share of stale ticks is over about so long.
constexpr double kStaleWindow_s = 0.256;
double stale_window_ticks(const ModelParams& params) PALPATE_RT { return max_of(1, kStaleWindow_s / params.period_s); }

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
  if (input.stale_ticks > 0 && state.rejected_ticks == 0) return true;  // tells nothing new
  // A silence that was not bridged is time in which the hand went on.
  const bool gap = input.stale_ticks == 0 && state.unseen_ticks > model.params.silence_hold_ticks;
  const double elapsed_ticks =
      1.0 + input.stale_ticks + input.overrun_ticks + (gap ? state.unseen_ticks : state.rejected_ticks);
  const double elapsed_s = model.params.period_s * elapsed_ticks;
  const double reach_m = model.params.speed_max_m_per_s * elapsed_s;
  const double reach_rad = model.params.turn_max_rad_per_s * elapsed_s;
  const Quat now = normalised(input.pose_w.orientation), last = state.told_w.orientation;
  const double cosine = abs_of(now.w * last.w + now.x * last.x + now.y * last.y + now.z * last.z);
  const double chord2 = max_of(0.0, 2 - 2 * cosine);
  const Vec3 way = input.pose_w.position_m - state.told_w.position_m;
  if (!(norm(way) <= reach_m && 4 * chord2 <= reach_rad * reach_rad)) return false;
  // Nor can it have left the motion it had by more than its largest acceleration makes of the time; a step of the
  // encoder is nobody's acceleration.
  const double most_m = bend_m(model.params, elapsed_s);
  return !(most_m > 0) || norm(way - elapsed_s * state.hand_velocity_m_per_s) <= most_m;
}

// Ends what decays, so that a still hand feels nothing change (rt_core/decay.h).
Vec3 by_edges(double step, double elapsed_s, Vec3 change, EdgeMemory& memory) PALPATE_RT {
  const Vec3 apart = between_edges(step, elapsed_s, change, memory);
  memory.ahead = settled(memory.ahead);
  memory.eased = settled(memory.eased);
  return apart;
}

// Where the handle is within the encoder's steps, from what was told before and is told now, `elapsed_s` later.
Vec3 observed_position(const ModelParams& p, State& state, double elapsed_s, Vec3 before_m, Vec3 told_m) PALPATE_RT {
  const ObserverGains gains = observer_gains(kObservedPosition, p.encoder_step_m, p.period_s);
  if (p.encoder_law_m == EncoderLaw::kEdges) {
    const Vec3 change_m = told_m - before_m;
    const Vec3 by_edges_m = told_m + by_edges(p.encoder_step_m, elapsed_s, change_m, state.edges_m);
    // Between two contacts not: what is met next may be stiff.
    const bool rests = state.feels_N_per_m > 0 && state.feels_N_per_m <= p.track_below_N_per_m;
    return on_track(gains, p.encoder_step_m, elapsed_s, told_m, change_m, by_edges_m, rests, state.observed_m,
                    state.track);
  }
  return state.device_w.position_m + observe(gains, told_m - state.device_w.position_m, state.observed_m);
}

Quat observed_orientation(const ModelParams& p, State& state, double elapsed_s, const Quat& before,
                          const Quat& told) PALPATE_RT {
  if (p.encoder_law_rad == EncoderLaw::kEdges) {
    const Vec3 change = small_rotation_vector(told * conjugate(before));
    const Vec3 apart = by_edges(p.encoder_step_rad, elapsed_s, change, state.edges_rad);
    return normalised(small_rotation(apart) * told);
  }
  const Vec3 ahead = small_rotation_vector(told * conjugate(state.device_w.orientation));
  const ObserverGains gains = observer_gains(kObservedAngle, p.encoder_step_rad, p.period_s);
  return normalised(small_rotation(observe(gains, ahead, state.observed_rad)) * state.device_w.orientation);
}

// `pose`, as the encoders told it `elapsed_s` after `before`, to where the handle is between their steps.
void observe_handle(const Model& model, State& state, double elapsed_s, const Pose& before, Pose& pose) PALPATE_RT {
  const ModelParams& p = model.params;
  const Pose told = pose;
  // A device that evaluates the local model smooths by itself, ten times as often, and tells where it evaluated it.
  if (p.encoder_step_m > 0 && !(p.local_period_s > 0))
    pose.position_m = observed_position(p, state, elapsed_s, before.position_m, told.position_m);
  if (p.encoder_step_rad > 0)
    pose.orientation = observed_orientation(p, state, elapsed_s, before.orientation, told.orientation);
  if (!is_finite(pose)) {  // a state spoilt in memory
    pose = told;
    state.edges_m = state.edges_rad = {};
    state.track = {told.position_m, 0};
  }
  for (ObservedMotion* motion : {&state.observed_m, &state.observed_rad}) {
    motion->per_s = settled(motion->per_s);
    motion->apart = settled(motion->apart);
  }
}

// Velocity of the handle from fresh samples; between them, for as long as the last force is held, the handle is taken
// to move on. One number lost in a press at 50 mm/s is 0.05 mm and 0.1 N.
void follow_hand(const Model& model, State& state, Scratch& scratch, const Input& input, Pose& pose) PALPATE_RT {
  const double period_s = model.params.period_s;
  if (input.stale_ticks == 0 || state.rejected_ticks > 0) {
    const double elapsed_s = period_s * (1.0 + input.overrun_ticks + state.rejected_ticks);
    const Vec3 velocity = (1 / elapsed_s) * (pose.position_m - state.told_w.position_m);
    state.hand_velocity_m_per_s = settled(state.hand_velocity_m_per_s + (1 / velocity_lag_ticks(model.params)) *
                                                                            (velocity - state.hand_velocity_m_per_s));
    const Pose before = state.told_w;
    state.told_w = pose;
    return observe_handle(model, state, elapsed_s, before, pose);
  }
  bridge_edges(period_s, state.edges_m);
  bridge_edges(period_s, state.edges_rad);
  pose = state.device_w;
  state.told_w = pose;
  if (input.stale_ticks > static_cast<std::uint32_t>(model.params.silence_hold_ticks)) {
    state.hand_velocity_m_per_s = {};
    return;
  }
  pose.position_m += period_s * state.hand_velocity_m_per_s;
  state.told_w = pose;  // what the next sample is measured against
  scratch.status |= Status::kSampleBridged;
}

void start_at(State& state, const Pose& pose) PALPATE_RT {
  state.device_w = state.device_previous_w = state.told_w = pose;
  state.tool_w = state.tool_previous_w = pose;
  state.safety.tool_corrected_w = pose;
  state.track = {pose.position_m, 0};
  state.started = 1;
}

// The sample of this tick into state.device_w: believed, bridged or refused.
void take_sample(const Model& model, State& state, Scratch& scratch, const Input& input) PALPATE_RT {
  const bool nobody_holds = input.drive != Drive::kDevice;  // a press: poses may jump
  const bool accepted = nobody_holds ? is_finite(input.pose_w) : is_plausible(model, state, input);
  state.device_previous_w = state.device_w;  // held
  if (!accepted) {
    scratch.status |= Status::kInputRejected;
    state.rejected_ticks += state.rejected_ticks < kMaxRejectedTicks ? 1 : 0;
    state.unseen_ticks += state.unseen_ticks < kMaxRejectedTicks ? 1 : 0;
    return;
  }
  Pose pose{input.pose_w.position_m, normalised(input.pose_w.orientation)};
  if (state.started == 0) start_at(state, pose);
  state.told_w = input.drive == Drive::kDevice ? state.told_w : pose;
  const bool tells = nobody_holds || input.stale_ticks == 0 || state.rejected_ticks > 0;
  if (nobody_holds)
    forget_seat(state);
  else if (tells && comes_anew(model, state, input, pose))
    seat_anew(model, state, pose);
  else
    follow_hand(model, state, scratch, input, pose);
  state.device_w = pose;
  state.unseen_ticks = tells ? 0 : state.unseen_ticks + (state.unseen_ticks < kMaxRejectedTicks ? 1 : 0);
  if (model.params.held_part == HeldPart::kBoth)
    state.second_w = {input.second_w.position_m, normalised(input.second_w.orientation)};
  state.rejected_ticks = 0;
}

// The tool goes with the coupling's end, `from` the last tick's, as far as contact lets it: in the free all the way,
// however weak the device. Behind a hand that has beaten the motors it goes with the end at which the coupling is held.
void predict_tool(const Model& model, State& state, Scratch& scratch, const Pose& from) PALPATE_RT {
  const Pose& before = state.safety.tool_corrected_w;
  const Pose to = coupling_end(state);
  Twist way = twist_between(from, to), tool;
  if (scratch.held_by_hand != 0) {
    std::uint32_t beaten = 0;
    const Pose end = held_end(model, from, before, beaten);
    if (beaten != 0) way = twist_between(end, held_end(model, to, before, beaten));
  }
  if (!follow(model, state, way, tool, scratch.work.landings)) scratch.status |= Status::kCouplingSingular;
  state.tool_w = moved(before, tool);
  if (scratch.held_by_hand != 0) scratch.grip_w = held_end(model, to, state.tool_w, scratch.status);
}

// One hand's sample, and where its tool is taken to be.
void sense_tool(const Model& model, State& state, Scratch& scratch, const Input& input) PALPATE_RT {
  const bool was_apart = state.apart != 0;
  const Pose end_before = coupling_end(state);
  take_sample(model, state, scratch, input);
  if (state.apart != 0) ease_seat(model, state);
  const bool apart = was_apart || state.apart != 0;
  if (apart) scratch.status |= Status::kSeatedAnew;
  state.tool_previous_w = state.tool_w;
  scratch.grip_w = state.device_w;
  if (scratch.driven != 0) {
    state.tool_w = state.device_w;
    return;
  }
  predict_tool(model, state, scratch, apart ? end_before : state.device_previous_w);
}

}  // namespace

void sense(const Model& model, State& state, Scratch& scratch, const Input& input) PALPATE_RT {
  scratch.status = 0;
  scratch.work = {};
  scratch.driven = input.drive == Drive::kTool ? 1 : 0;
  scratch.held_by_hand = input.drive == Drive::kDevice ? 1 : 0;
  if (input.stale_ticks > 0) scratch.status |= Status::kInputHeld;
  // What lasts longer is silence, which has a limit of its own.
  if (input.stale_ticks <= static_cast<std::uint32_t>(model.params.silence_hold_ticks))
    state.stale_share = settled(state.stale_share + ((input.stale_ticks > 0 ? 1 : 0) - state.stale_share) /
                                                        stale_window_ticks(model.params));
  sense_tool(model, state, scratch, input);
  if (!has_two_tools(model)) return;
  scratch.work.other_samples += 1;
  const OthersTurn turn(state, scratch);
  sense_tool(model, state, scratch, input_of_second(model, input));
}

}  // namespace palpate
