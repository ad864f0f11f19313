// A whole device and a whole controller in virtual time: simulated hand and handle, node, fault script and wire on one
// side, device bus, control loop and the real tick() with the smallest scene on the other.
#pragma once

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/bus/bus_model.h"
#include "hal/bus/loopback.h"
#include "hal/device/fault_player.h"
#include "hal/loop/loop.h"
#include "sim_host/run/host_port.h"
#include "sim_host/tick_memory.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {

// The hand reaches 15 mm beyond touch into the middle of a face (3 N) and slides a little, from 0.1 s on.
inline HandPath pressing_hand() {
  const double face_m = 0.03 / std::sqrt(3.0);
  const Vec3 outward = (-1 / std::sqrt(3.0)) * Vec3{1, 1, 1};
  const auto at = [&](double gap_m) { return (face_m + 0.01 + gap_m) * outward; };
  const Vec3 along{0.002, -0.002, 0};
  return HandPath(
      {{0, {at(0.004), {}}}, {0.1, {at(0.004), {}}}, {0.3, {at(-0.015), {}}}, {1.2, {at(-0.015) + along, {}}}});
}

// The device lives on its own clock: every receive() of the controller first lets it do the periods that have passed.
class WiredDevice {
 public:
  WiredDevice(const std::string& script, WireProfile profile, const VirtualClock& clock)
      : clock_(clock), ends_(open_loopback_pair(error_)), plug_(std::move(ends_.second), {}), sender_(plug_) {
    NodeOptions options;
    options.profile = profile;
    node_ = std::make_unique<DeviceNode>(sender_, options, PlantOptions{}, pressing_hand());
    std::vector<FaultLine> lines;
    if (!parse_fault_script(script, lines, error_)) ADD_FAILURE() << error_;
    player_ = std::make_unique<FaultPlayer>(std::move(lines), *node_, sender_, plug_);
    bus_ = std::make_unique<DeviceBus>(*ends_.first, profile);
  }
  void receive(DeviceSample& sample) noexcept {
    while (due_ns_ <= clock_.now_ns()) {
      player_->advance();
      node_->step(due_ns_);
      motor_N_.push_back(node_->plant().motor().force_N);
      due_ns_ += player_->period_ns();
    }
    bus_->receive(sample);
  }
  bool transmit(const DeviceCommand& command) noexcept {
    last_sent_ = command;
    return bus_->transmit(command);
  }
  DeviceNode& node() { return *node_; }
  const BusCounters& counters() const { return bus_->counters(); }
  const DeviceCommand& last_sent() const { return last_sent_; }
  const std::vector<Vec3>& motor_N() const { return motor_N_; }

 private:
  const VirtualClock& clock_;
  std::string error_;
  std::pair<std::unique_ptr<Transport>, std::unique_ptr<Transport>> ends_;
  Plug plug_;
  FaultSender sender_;
  std::unique_ptr<DeviceNode> node_;
  std::unique_ptr<FaultPlayer> player_;
  std::unique_ptr<DeviceBus> bus_;
  DeviceCommand last_sent_;
  std::vector<Vec3> motor_N_;
  std::int64_t due_ns_ = 1'000'000;  // its tick n falls into record n
};

struct RecordList {
  std::vector<TickRecord> records;
  void publish(const TickRecord& record) { records.push_back(record); }
};

// What surrounds one tick, for tests that meddle with it: `meddle` is called before every tick with its number.
struct Surroundings {
  std::uint64_t tick;
  VirtualClock& clock;
  ModelParams& params;
  State& state;
  MailboxRegion& mailbox;
  bool& host_lives;
};
using Meddle = std::function<void(const Surroundings&)>;

// A host that arms once and shows every tick that it lives, until it dies.
struct BenchHost {
  MailboxRegion region{};
  MailboxWriter writer{region};
  bool lives = true;
  void beat() {
    if (lives) writer.beat();
  }
};

class BenchController {
 public:
  BenchController(ModelController& inner, VirtualClock& clock, Model& model, State& state, BenchHost& host,
                  const Meddle& meddle)
      : inner_(inner), clock_(clock), model_(model), state_(state), host_(host), meddle_(meddle) {}
  void step(const Input& input, Output& output, const StageProbe& probe) {
    if (meddle_) meddle_({tick_, clock_, model_.params, state_, host_.region, host_.lives});
    tick_ += 1;
    host_.beat();
    inner_.step(input, output, probe);
  }
  void fill(const Input& input, const Output& output, TickRecord& record) { inner_.fill(input, output, record); }

 private:
  ModelController& inner_;
  VirtualClock& clock_;
  Model& model_;
  State& state_;
  BenchHost& host_;
  const Meddle& meddle_;
  std::uint64_t tick_ = 0;
};

constexpr std::uint32_t kHostSilenceTicks = 2000;  // 2 s, as palpate-rt has it

// Everything a fault did, tick by tick.
struct FaultRun {
  ModelParams limits{};
  LoopSummary summary;
  std::vector<TickRecord> records;
  BusCounters counters;
  DeviceCommand last_sent;
  Wrench last_motor;
  std::vector<Vec3> motor_N;  // rendered in each period of the device
};

// The real tick and loop on `device`, whose time `clock` is. `change`: of the scene.
template <class D>
FaultRun run_on(D& device, VirtualClock& clock, std::uint64_t ticks, double rate_max_N_per_s = 2e4,
                const Meddle& meddle = {}, std::uint32_t ride_through_ticks = 0,
                const CartesianKinematics& kinematics = {}, std::uint32_t clutch_buttons = 0,
                const std::function<void(ImageBytes&)>& change = {}) {
  ImageBytes image = tiny_image();
  image.params().force_rate_max_N_per_s = rate_max_N_per_s;
  if (change) change(image);
  image.seal();
  Model model;
  if (open_image(image.bytes(), model).error != ImageError::kNone) ADD_FAILURE() << "the tiny scene is refused";
  const auto state = make_state(model);
  const auto scratch = make_scratch(model);
  reset(*state);
  ModelController core(model, *state, *scratch);
  RecordList recorder;
  BenchHost host;
  host.writer.set(Command::kArm, false);
  BenchController controller(core, clock, model, *state, host, meddle);
  const std::atomic<bool> interrupted{false};
  std::atomic<bool> stop{false};
  HostPort port(&host.region, kHostSilenceTicks, interrupted, stop);
  SupervisedDevice supervised(device, port);
  LoopOptions options;
  options.deadline.period_ns = deadline_limits(model.params).period_ns;
  options.ticks = ticks;
  options.ride_through_ticks = ride_through_ticks;
  options.clutch_buttons = clutch_buttons;
  Loop loop(supervised, clock, controller, recorder, port, kinematics, options, stop);
  FaultRun run;
  run.limits = model.params;
  run.summary = loop.run();
  run.records = std::move(recorder.records);
  return run;
}

inline FaultRun run_with_faults(const std::string& script, std::uint64_t ticks = 1500,
                                WireProfile profile = WireProfile::kFd, double rate_max_N_per_s = 2e4,
                                const Meddle& meddle = {}, std::uint32_t ride_through_ticks = 0) {
  VirtualClock clock;
  WiredDevice device(script, profile, clock);
  FaultRun run = run_on(device, clock, ticks, rate_max_N_per_s, meddle, ride_through_ticks);
  DeviceSample sample;
  clock.advance(1'000'000);
  device.receive(sample);  // the device's last period: it takes what the loop sent last
  run.counters = device.counters();
  run.last_sent = device.last_sent();
  run.motor_N = device.motor_N();
  run.last_motor = device.node().plant().motor();
  return run;
}

}  // namespace palpate::test
