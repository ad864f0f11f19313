// A device that attacks: the simulated handle and hand behind a wire on which an attacker writes what it likes. Its
// node is the dumbest that keeps the protocol: it obeys the newest command at once, without a slew limit of its own,
// and lets go after 20 ms, so that every step the controller allows is a step on the hand.
#pragma once

#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/hal/fault_bench.h"

namespace palpate::test {

// What the attacker may do in one period of the device.
struct Attack {
  std::uint64_t tick = 0;     // of the device, from 0
  std::uint64_t since = 0;    // ticks since the attack began
  wire::Status status;        // what an honest node would send
  std::vector<Frame> frames;  // sent instead of it, if any
  bool send = true;
  bool hear = true;  // whether commands reach the node in this period
  std::mt19937* random = nullptr;
  const std::vector<Frame>* sent_before = nullptr;  // every honest frame so far
};
using Attacker = std::function<void(Attack&)>;

class EvilDevice {
 public:
  EvilDevice(VirtualClock& clock, std::uint64_t from_tick, Attacker attacker)
      : clock_(clock),
        ends_(open_loopback_pair(error_)),
        bus_(*ends_.first, WireProfile::kFd),
        plant_(PlantOptions{}, pressing_hand()),
        from_tick_(from_tick),
        attacker_(std::move(attacker)) {}

  void receive(DeviceSample& sample) noexcept {
    for (; due_ns_ <= clock_.now_ns(); due_ns_ += 1'000'000) step();
    bus_.receive(sample);
  }
  bool transmit(const DeviceCommand& command) noexcept { return bus_.transmit(command); }
  const BusCounters& counters() const { return bus_.counters(); }
  const std::vector<Vec3>& motor_N() const { return motor_N_; }

 private:
  void obey(const Frame& frame) {
    wire::Command command;
    if (wire::decode({frame.data, frame.length}, 1, command) != wire::DecodeResult::kOk) return;
    const bool enable = (command.flags & CommandFlag::kEnable) != 0;
    if (enable && !enabled_) latched_ = false;
    enabled_ = enable;
    echo_ = command.sequence;
    heard_tick_ = plant_.ticks();
    Vec3 torque_Nm;
    wire::get_wrench(command, command_.force_N, torque_Nm);
  }
  void step() {
    Attack attack;
    attack.tick = plant_.ticks();
    Frame arrived[kMaxFramesPerReceive];
    const int count = ends_.second->receive(arrived);
    attack.status = honest();
    attack.random = &random_;
    attack.sent_before = &honest_frames_;
    const bool attacks = attack.tick >= from_tick_;
    attack.since = attacks ? attack.tick - from_tick_ : 0;
    if (attacks) attacker_(attack);
    for (int i = 0; i < count && attack.hear; ++i) obey(arrived[i]);
    if (plant_.ticks() > heard_tick_ + 20) latched_ = enabled_ = true;
    const bool rendered = enabled_ && !latched_;
    command_.flags = rendered ? CommandFlag::kEnable : 0u;
    plant_.step(command_);
    motor_N_.push_back(rendered ? command_.force_N : Vec3{});
    if (!attack.send) return;
    if (attack.frames.empty()) attack.frames.push_back(frame_of(attack.status));
    for (const Frame& frame : attack.frames) ends_.second->send({&frame, 1});
  }
  wire::Status honest() {
    wire::Status status;
    status.sequence = static_cast<std::uint32_t>(plant_.ticks()) & 0xFFFFu;
    status.command_sequence = echo_;
    status.time_us = static_cast<std::uint32_t>(1000 * plant_.ticks());
    status.flags = DeviceFlag::kCalibrated | (enabled_ && !latched_ ? DeviceFlag::kEnabled : 0u) |
                   (latched_ ? DeviceFlag::kWatchdog : 0u);
    wire::set_pose(status, plant_.measured_m(), plant_.pose().orientation);
    honest_frames_.push_back(frame_of(status));
    return status;
  }

 public:
  static Frame frame_of(const wire::Status& status) {
    Frame frames[2];
    make_status_frames(1, status, frames);
    return frames[0];
  }

 private:
  VirtualClock& clock_;
  std::string error_;
  std::pair<std::unique_ptr<Transport>, std::unique_ptr<Transport>> ends_;
  DeviceBus bus_;
  DevicePlant plant_;
  std::uint64_t from_tick_;
  Attacker attacker_;
  std::mt19937 random_{20261122};
  std::vector<Frame> honest_frames_;
  std::vector<Vec3> motor_N_;
  DeviceCommand command_;
  std::uint32_t echo_ = 0;
  std::uint64_t heard_tick_ = 0;
  bool enabled_ = true, latched_ = true;
  std::int64_t due_ns_ = 1'000'000;
};

}  // namespace palpate::test
