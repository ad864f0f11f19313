// The control loop, one template for the real device and the simulated one, the real clock and the scripted one:
// wait -> receive -> tick -> transmit -> publish, at most once per slot. Allocation-free; every step is bounded.
//
// Two hands (HeldPart::kBoth, kTwoTools) are two devices in one loop and one tick: each has its own sample, frame and
// link watch. A tick without a fresh sample of both is a tick without a sample; what either finds wrong is a fault of
// the run, and lets both go.
//
// Before the first sample the controller is not ticked (there is no pose to render): zero-force commands go out so that
// the device sees a living controller. After that each slot is one tick, with a sample or without. Stopping asks the
// controller to ramp down (Command::kStop) for a bounded time; whatever happens, the last commands sent are zero force
// with the drives disabled.
#pragma once

#include <algorithm>
#include <atomic>
#include <concepts>
#include <cstdint>

#include "hal/device/device.h"
#include "hal/device/kinematics.h"
#include "hal/loop/clock.h"
#include "hal/loop/deadline.h"
#include "hal/loop/link_watch.h"
#include "hal/loop/phase_lock.h"
#include "rt_core/record.h"
#include "rt_core/tick.h"

namespace palpate {

// The scene's limits (device.late_max_ms, device.stall_max_ms), in slots of its period.
inline DeadlineLimits deadline_limits(const ModelParams& params) noexcept {
  DeadlineLimits limits;
  limits.period_ns = static_cast<std::int64_t>(params.period_s * 1e9 + 0.5);
  limits.consecutive_ticks = static_cast<std::uint32_t>(params.late_ticks_max);
  const double slots = params.stall_max_s / params.period_s + 0.5;
  // One late wake-up alone costs two slots (skip() above): a smaller limit would latch on what is counted as lateness.
  limits.slots_at_once = slots < 2 ? 2u : static_cast<std::uint32_t>(slots);
  return limits;
}

// The node's watchdog in ticks, within what the classic echo's 6 bits can tell; deaf for the limit of silence: a fault.
inline LinkLimits link_limits(const ModelParams& params) noexcept {
  LinkLimits limits;
  limits.lag_ticks = static_cast<std::uint32_t>(clamp_to(kNodeWatchdog_s / params.period_s, 4, 40));
  limits.fault_ticks = static_cast<std::uint32_t>(params.silence_fault_ticks);
  return limits;
}

// How long a device may evaluate one command's local model: as long as a lost sample is bridged by default.
inline double local_valid_s(const ModelParams& params) noexcept {
  return params.local_period_s > 0 ? min_of(3 * params.period_s, kLocalValid_s) : 0;
}

struct LoopOptions {
  DeadlineLimits deadline;
  LinkLimits link;
  std::uint32_t clutch_buttons = 0;  // while one is pressed the tool stays and the handle moves; the force is let go
  double local_valid_s = 0;  // > 0: the scene is baked for a device that evaluates the local model, and needs one
  std::uint64_t ticks = 0;   // controller ticks before an orderly stop; 0: until stopped
  std::uint32_t start_timeout_ticks = 2000;  // without any sample at start
  std::uint32_t silence_fault_ticks = 20;    // without a fresh sample in motion: Fault::kDeviceSilent
  // Ticks in a row, in time and with a sample, after which a run that stood still goes on by itself; 0: it latches the
  // fault. Only for a simulated device, which stood still with the machine and hurts nobody.
  std::uint32_t ride_through_ticks = 0;
  std::int64_t phase_ns = -1;      // of the slots on the clock's grid; negative: as the loop happens to start
  std::uint32_t stop_ticks = 200;  // longest ramp-down
  std::uint32_t zero_ticks = 5;    // zero-force commands that end every run
};

enum class LoopEnd : int { kTicksDone = 0, kStopped, kSilentAtStart };

struct LoopSummary {
  LoopEnd end = LoopEnd::kStopped;
  std::uint64_t ticks = 0;
  std::uint64_t start_ticks = 0;    // waited for the first sample
  std::uint64_t missed_slots = 0;   // periods without a tick
  std::uint64_t overrun_ticks = 0;  // ticks that followed missed slots
  std::uint32_t worst_missed = 0;   // most slots missed in one go
  std::uint64_t stale_ticks = 0;    // ticks without a fresh sample
  std::uint32_t worst_stale = 0;    // longest silence in periods
  std::uint64_t gaps = 0;           // status sequence numbers missing
  std::uint64_t send_failures = 0;  // commands the bus did not take
  std::uint32_t stalls = 0;         // ridden through
  std::int64_t worst_wake_ns = 0;   // largest wake-up latency
  std::uint32_t worst_lag = 0;      // most commands sent beyond the newest one the device said it obeyed
  std::uint64_t unheard_ticks = 0;  // ticks in which force was let go because the device did not hear
  std::uint32_t link_drops = 0;     // times that began
  std::uint32_t faults = 0;         // every latched fault seen
  bool phase_locked = false;        // the slots followed the device's clock
  double device_ppm = 0;            // by which that is fast, of the last slot
  std::int64_t worst_phase_ns = 0;  // furthest that a sample's age was from half a period once locked
};

// What computes the force. step: one tick. fill: completes a record after it.
template <typename T>
concept Controller = requires(T c, const Input& in, Output& out, const StageProbe& probe, TickRecord& record) {
  c.step(in, out, probe);
  c.fill(in, out, record);
};
// Telemetry must never wait; commands are level bits, polled once per tick. A source may also have joints() and
// live(): what came with the last poll for an articulated tool, and for the live settings.
template <typename T>
concept RecordSink = requires(T sink, const TickRecord& record) {
  sink.publish(record);
};
template <typename T>
concept CommandSource = requires(T source) {
  { source.poll() } -> std::convertible_to<std::uint32_t>;
};

// The controller everything is built for: rt_core's tick().
class ModelController {
 public:
  ModelController(const Model& model, State& state, Scratch& scratch) noexcept
      : model_(model), state_(state), scratch_(scratch) {}
  void step(const Input& input, Output& output, const StageProbe& probe) noexcept {
    tick(model_, state_, scratch_, input, output, probe);
  }
  void fill(const Input& input, const Output& output, TickRecord& record) noexcept {
    fill_record(state_, input, output, record);
  }

 private:
  const Model& model_;
  State& state_;
  Scratch& scratch_;
};

template <Device D, Clock C, Controller K, RecordSink S, CommandSource H>
class Loop {
 public:
  // All references must outlive the loop. `stop` is set by a signal handler or another thread. `second`: of the hand
  // that holds the body, where the scene has one; its frame is `second_kinematics`.
  Loop(D& device, C& clock, K& controller, S& sink, H& host, const CartesianKinematics& kinematics,
       const LoopOptions& options, const std::atomic<bool>& stop, D* second = nullptr,
       const CartesianKinematics& second_kinematics = {}) noexcept
      : hand_{{&device, kinematics, LinkWatch(options.link)}, {second, second_kinematics, LinkWatch(options.link)}},
        hands_(second != nullptr ? 2 : 1),
        clock_(clock),
        controller_(controller),
        sink_(sink),
        host_(host),
        options_(options),
        stop_(stop),
        slots_(options.deadline, first_slot_ns(clock.now_ns(), options.deadline.period_ns, options.phase_ns)),
        phase_(options.deadline.period_ns) {}

  LoopSummary run() noexcept {
    summary_.end = wait_for_device();
    if (summary_.end == LoopEnd::kTicksDone) summary_.end = render();
    finish();
    summary_.missed_slots = slots_.total_missed();
    summary_.overrun_ticks = slots_.overrun_ticks();
    summary_.worst_missed = slots_.worst_missed();
    summary_.phase_locked = phase_.locked();
    summary_.device_ppm = phase_.device_ppm();
    summary_.worst_phase_ns = phase_.worst_ns();
    return summary_;
  }

 private:
  // One hand's device.
  struct Hand {
    D* device;
    CartesianKinematics kinematics;
    LinkWatch link;
    DeviceSample sample = {};
    bool met = false;  // a sample has arrived
    bool clutched = false;
  };
  template <class Each>
  void each_hand(const Each& each) noexcept {
    for (int i = 0; i < hands_; ++i) each(hand_[i]);
  }
  template <class Is>
  bool any_hand(const Is& is) const noexcept {
    return is(hand_[0]) || (hands_ == 2 && is(hand_[1]));
  }

  bool stop_requested() const noexcept { return stop_.load(std::memory_order_relaxed); }

  void receive() noexcept {
    each_hand([](Hand& hand) {
      hand.device->receive(hand.sample);
      hand.met = hand.met || hand.sample.fresh;
    });
  }

  // Sleeps until the tick's slot. A late wake-up skips once; if even the wake-up after that is late, the tick runs all
  // the same, so a system that is always late still ticks and reaches the overrun fault.
  void wait() noexcept {
    slots_.skip(clock_.now_ns());
    clock_.wait_until(slots_.deadline_ns());
    woke_ns_ = clock_.now_ns();
    if (slots_.skip(woke_ns_)) {
      clock_.wait_until(slots_.deadline_ns());
      woke_ns_ = clock_.now_ns();
    }
    slots_.start();
  }

  // kTicksDone: a sample has arrived and rendering may start.
  LoopEnd wait_for_device() noexcept {
    for (;;) {
      if (stop_requested()) return LoopEnd::kStopped;
      wait();
      receive();
      if (!any_hand([](const Hand& hand) { return !hand.met; })) return LoopEnd::kTicksDone;
      if (++summary_.start_ticks >= options_.start_timeout_ticks) return LoopEnd::kSilentAtStart;
      send_zero();
      slots_.advance();
    }
  }

  // The first samples are already there and their slot has begun.
  LoopEnd render() noexcept {
    std::uint32_t stopping = 0;  // ticks since the stop began
    LoopEnd end = LoopEnd::kStopped;
    for (bool first = true;; first = false) {
      if (!first) {
        slots_.advance(phase_.correction_ns());
        wait();
      }
      const bool done = options_.ticks > 0 && summary_.ticks >= options_.ticks;
      if (stopping == 0 && (done || stop_requested())) {
        stopping = 1;
        end = stop_requested() ? LoopEnd::kStopped : LoopEnd::kTicksDone;
      }
      one_tick(!first, stopping > 0);
      if (stopping > 0 && (at_rest() || stopping++ >= options_.stop_ticks)) return end;
    }
  }

  bool at_rest() const noexcept {
    const bool safe_mode = output_.mode == Mode::kIdle || output_.mode == Mode::kFault;
    return safe_mode && is_zero();
  }
  bool is_zero() const noexcept { return output_.device_w == Wrench{} && output_.second_w == Wrench{}; }

  void one_tick(bool receive, bool stopping) noexcept {
    TickTiming& timing = record_.timing;
    timing.deadline_ns = slots_.deadline_ns();
    timing.wake_latency_ns = brief(woke_ns_ - timing.deadline_ns);
    if (receive) this->receive();
    each_hand([](Hand& hand) { hand.link.look(hand.sample); });
    const std::int64_t received_ns = clock_.now_ns();
    if (receive) follow_phase(received_ns - timing.deadline_ns);
    make_input(stopping);
    stamps_ = {&clock_, &timing, received_ns};
    for (std::int32_t& stage_ns : timing.stage_ns) stage_ns = 0;
    controller_.step(input_, output_, StageProbe{&Loop::mark, &stamps_});
    const std::int64_t computed_ns = clock_.now_ns();
    const bool armed = output_.mode != Mode::kIdle && output_.mode != Mode::kFault;
    push(hand_[0], output_, armed);
    if (hands_ == 2) push(hand_[1], of_second(output_), armed);
    const std::int64_t sent_ns = clock_.now_ns();
    timing.receive_ns = brief(received_ns - woke_ns_);
    timing.compute_ns = brief(computed_ns - received_ns);
    timing.transmit_ns = brief(sent_ns - computed_ns);
    timing.publish_ns = publish_ns_;
    account(timing);
    controller_.fill(input_, output_, record_);
    record_.sequence = summary_.ticks;
    sink_.publish(record_);
    publish_ns_ = brief(clock_.now_ns() - sent_ns);
  }

  // Of the first hand's device: two with clocks of their own cannot both be followed.
  void follow_phase(std::int64_t since_slot_ns) noexcept {
    const DeviceSample& sample = hand_[0].sample;
    if (sample.fresh && sample.age_ns >= 0) phase_.see(sample.age_ns - since_slot_ns);
  }

  // What the second device renders, in the place of what the first does.
  static Output of_second(Output output) noexcept {
    output.device_w = output.second_w;
    output.handle_w_m = output.second_handle_w_m;
    output.felt_along_N_per_m = output.second_felt_along_N_per_m;
    output.felt_across_N_per_m = output.second_felt_across_N_per_m;
    return output;
  }
  void push(Hand& hand, const Output& output, bool armed) noexcept {
    const bool enabled = hand.link.enable(armed, is_zero());
    const std::uint32_t flags = enabled ? CommandFlag::kEnable : 0u;
    send(hand, to_command(hand.kinematics, output, flags, options_.local_valid_s));
  }

  // A position outside the workspace is passed on as not a number: the core rejects and reports it.
  void take_pose(Hand& hand, Pose& pose_w) noexcept {
    if (!hand.sample.fresh) return;
    const bool believed = in_workspace(hand.kinematics, hand.sample);
    hand.clutched = (hand.sample.buttons & options_.clutch_buttons) != 0;
    if (hand.clutched && summary_.ticks > 0 && believed && is_finite(pose_w)) clutch(hand, pose_w);
    pose_w = pose_in_world(hand.kinematics, hand.sample);
    if (!believed) pose_w.position_m.x = std::numeric_limits<double>::quiet_NaN();
  }

  void make_input(bool stopping) noexcept {
    const bool silent = any_hand([](const Hand& hand) { return !hand.sample.fresh; });
    stale_ = silent ? stale_ + 1 + slots_.missed() : 0;
    take_pose(hand_[0], input_.pose_w);
    take_pose(hand_[1], input_.second_w);
    if (hand_[0].sample.fresh) input_.buttons = hand_[0].sample.buttons;
    input_.stale_ticks = stale_;
    input_.command_lag = 0;
    each_hand([&](const Hand& hand) { input_.command_lag = std::max(input_.command_lag, hand.link.lag_ticks()); });
    input_.overrun_ticks = slots_.missed();
    input_.commands = host_.poll() | (stopping ? Command::kStop : 0u);
    const bool nobody = any_hand([&](const Hand& hand) {  // there to render it
      const bool lacks_model = options_.local_valid_s > 0 && (hand.sample.flags & DeviceFlag::kLocalModel) == 0;
      return !hand.link.proven() || lacks_model;
    });
    if (nobody) input_.commands &= ~Command::kArm;
    const bool clutched = any_hand([](const Hand& hand) { return hand.clutched; });
    if (unheard() || clutched) input_.commands |= Command::kUnheard;
    if constexpr (requires { host_.joints(); }) input_.joints = host_.joints();
    if constexpr (requires { host_.live(); }) input_.live = host_.live();
    input_.device_fault = 0;
    each_hand([&](const Hand& hand) {
      input_.device_fault |= hand.sample.faults | (hand.link.fault() ? Fault::kDeviceDeaf : 0u);
    });
    std::uint32_t late = stale_ >= options_.silence_fault_ticks ? Fault::kDeviceSilent : 0u;
    if (slots_.late_too_often()) late |= Fault::kOverrun;
    if (slots_.stalled()) late |= Fault::kStalled;
    if (options_.ride_through_ticks == 0) {
      input_.device_fault |= late;
    } else {
      ride_through(late != 0 || slots_.missed() >= options_.silence_fault_ticks);
    }
    input_.drive = Drive::kDevice;
  }

  // The device's origin moves so that the tool stays where it was. Orientation goes on: a hand cannot let go of it.
  static void clutch(Hand& hand, const Pose& pose_w) noexcept {
    const Pose seen_w = pose_in_world(hand.kinematics, hand.sample);
    hand.kinematics.position_w += pose_w.position_m - seen_w.position_m;
  }

  // A stall on a simulated device: force is let go until the machine has kept up for a while. What the core is told of
  // lateness stays below the limit at which it would latch by itself.
  void ride_through(bool stalled) noexcept {
    if (stalled && !riding_) summary_.stalls += 1;
    riding_ = riding_ || stalled;
    if (!riding_) return;
    calm_ticks_ = stalled || slots_.missed() > 0 || stale_ > 0 ? 0 : calm_ticks_ + 1;
    const std::uint32_t most = options_.silence_fault_ticks - 1;
    input_.stale_ticks = input_.stale_ticks < most ? input_.stale_ticks : most;
    input_.overrun_ticks = input_.overrun_ticks < most ? input_.overrun_ticks : most;
    riding_ = calm_ticks_ <= options_.ride_through_ticks;
    if (!riding_) return;
    // Arming is an edge: a host that asks for it meanwhile gives one when the ride is over.
    input_.commands = (input_.commands & ~Command::kArm) | Command::kStall;
  }

  void account(const TickTiming& timing) noexcept {
    summary_.ticks += 1;
    summary_.stale_ticks += stale_ > 0;
    summary_.worst_stale = stale_ > summary_.worst_stale ? stale_ : summary_.worst_stale;
    summary_.faults |= output_.fault;
    summary_.link_drops = 0;
    each_hand([&](const Hand& hand) {
      summary_.gaps += hand.sample.gaps;
      summary_.worst_lag = hand.link.lag_ticks() > summary_.worst_lag ? hand.link.lag_ticks() : summary_.worst_lag;
      summary_.link_drops += hand.link.drops();
    });
    summary_.unheard_ticks += unheard();
    if (timing.wake_latency_ns > summary_.worst_wake_ns) summary_.worst_wake_ns = timing.wake_latency_ns;
  }

  bool unheard() const noexcept {
    return any_hand([](const Hand& hand) { return hand.link.unheard(); });
  }

  void send(Hand& hand, const DeviceCommand& command) noexcept {
    summary_.send_failures += !hand.device->transmit(command);
  }
  void send_zero() noexcept {
    each_hand([&](Hand& hand) { send(hand, {}); });
  }

  // However the run ended: zero force, drives off, in several slots so that one lost frame does not matter.
  void finish() noexcept {
    for (std::uint32_t i = 0; i < options_.zero_ticks; ++i) {
      send_zero();
      slots_.advance();
      wait();
    }
  }

  static std::int32_t brief(std::int64_t ns) noexcept {
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(ns < kMost ? ns : kMost);
  }

  struct Stamps {
    const C* clock;
    TickTiming* timing;
    std::int64_t last_ns;
  };
  static void mark(void* context, Stage stage) PALPATE_RT {
    auto* stamps = static_cast<Stamps*>(context);
    const std::int64_t now_ns = stamps->clock->now_ns();
    stamps->timing->stage_ns[static_cast<std::int32_t>(stage)] = brief(now_ns - stamps->last_ns);
    stamps->last_ns = now_ns;
  }

  Hand hand_[2];  // the second only with two hands
  int hands_;
  C& clock_;
  K& controller_;
  S& sink_;
  H& host_;
  LoopOptions options_;
  const std::atomic<bool>& stop_;
  DeadlineTracker slots_;
  PhaseLock phase_;
  Input input_;
  Output output_;
  TickRecord record_{};
  Stamps stamps_{};
  LoopSummary summary_;
  std::uint32_t stale_ = 0;
  bool riding_ = false;  // through a stall
  std::uint32_t calm_ticks_ = 0;
  std::int64_t woke_ns_ = 0;
  std::int32_t publish_ns_ = 0;
};

}  // namespace palpate
