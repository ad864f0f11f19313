// The control loop on a scripted clock: slots, overruns, silence, stopping; and closed-loop behaviour with the
// simulated device and a wall of springs.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "hal/bus/loopback.h"
#include "hal/device/device_node.h"
#include "hal/loop/loop.h"
#include "tests/hal/fault_transport.h"

namespace palpate {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

// f = -k x for x < 0, zero on request, on silence and on faults: a stand-in for the core.
struct Wall {
  double stiffness_N_per_m = 0;
  std::function<void(std::uint64_t)> during;  // called inside each step with its number
  std::uint64_t steps = 0;
  void step(const Input& input, Output& output, const StageProbe& probe) {
    if (during) during(steps);
    steps += 1;
    output = {};
    const double x = input.pose_w.position_m.x;
    output.fault = input.device_fault;
    const bool quiet = (input.commands & Command::kStop) != 0;
    output.mode = output.fault != 0 ? Mode::kFault : quiet ? Mode::kIdle : Mode::kForce;
    if (output.mode == Mode::kForce && x < 0) output.device_w.force_N.x = -stiffness_N_per_m * x;
    for (int s = 0; s < kStageCount; ++s) probe.mark(probe.context, static_cast<Stage>(s));
  }
  void fill(const Input& input, const Output& output, TickRecord& record) {
    record.input = input;
    record.output = output;
  }
};

struct Recorder {
  std::vector<TickRecord> records;
  void publish(const TickRecord& record) { records.push_back(record); }
};
struct Silent {
  std::uint32_t poll() { return Command::kArm; }
};

// Remembers what was sent; can be made deaf (no fresh samples) from a script.
struct ScriptedDevice {
  explicit ScriptedDevice(SimulatedDevice& device) : inner(device) {}
  SimulatedDevice& inner;
  std::function<bool(int)> silent;
  std::function<void(DeviceSample&, int)> change;  // with the number of the call, from 0
  int receives = 0, samples = 0;
  DeviceSample last;
  std::vector<DeviceCommand> sent;
  void receive(DeviceSample& sample) noexcept {
    inner.receive(sample);
    if (change) change(sample, samples++);
    if (silent && silent(receives++)) {
      sample = last;
      sample.fresh = false;
      sample.received = 0;
    } else {
      last = sample;
    }
  }
  bool transmit(const DeviceCommand& command) noexcept {
    sent.push_back(command);
    return inner.transmit(command);
  }
};

struct Bench {
  explicit Bench(const PlantOptions& plant = {}, HandPath path = {}) : simulated(plant, path, clock) {}
  LoopSummary run(std::uint64_t ticks) {
    options.ticks = ticks;
    Loop loop(device, clock, wall, recorder, host, kinematics, options, stop);
    return loop.run();
  }
  VirtualClock clock;
  SimulatedDevice simulated;
  ScriptedDevice device{simulated};
  Wall wall;
  Recorder recorder;
  Silent host;
  CartesianKinematics kinematics;
  LoopOptions options;
  std::atomic<bool> stop{false};
};

void expect_ends_with_zero_force(const Bench& bench) {
  ASSERT_GE(bench.device.sent.size(), bench.options.zero_ticks);
  for (std::uint32_t i = 0; i < bench.options.zero_ticks; ++i) {
    const DeviceCommand& command = bench.device.sent[bench.device.sent.size() - 1 - i];
    EXPECT_EQ(command.force_N, Vec3{});
    EXPECT_EQ(command.torque_Nm, Vec3{});
    EXPECT_EQ(command.flags & CommandFlag::kEnable, 0u);
  }
}

TEST(Loop, FreeMotionHasOneTickPerSlotAndNoForce) {
  Bench bench({}, HandPath({{0, {{0.01, 0, 0}, {}}}, {0.2, {{0.05, 0.02, 0}, {}}}}));
  bench.wall.stiffness_N_per_m = 500;
  const LoopSummary s = bench.run(300);
  EXPECT_EQ(s.end, LoopEnd::kTicksDone);
  EXPECT_EQ(s.ticks, 301u);  // and one that saw the stop through
  EXPECT_EQ(s.missed_slots + s.stale_ticks + s.send_failures + s.start_ticks, 0u);
  for (std::size_t i = 0; i < bench.recorder.records.size(); ++i) {
    const TickRecord& r = bench.recorder.records[i];
    EXPECT_EQ(r.sequence, i + 1);
    EXPECT_EQ(r.timing.deadline_ns, static_cast<std::int64_t>(i + 1) * kPeriod_ns);
    EXPECT_EQ(r.timing.wake_latency_ns, 0);
    EXPECT_EQ(r.output.device_w.force_N, Vec3{});
  }
  expect_ends_with_zero_force(bench);
}

// While the button is pressed the tool stays where it was and the force is asked to go; afterwards it moves on from
// there, by as much as the handle.
TEST(Loop, TheClutchHoldsTheToolWhileTheHandleMoves) {
  Bench bench({}, HandPath({{0, {{0.01, 0, 0}, {}}}, {0.4, {{0.05, 0.02, 0}, {}}}}));
  bench.options.clutch_buttons = 2;
  std::vector<Vec3> handle_m;
  handle_m.reserve(400);
  bench.device.change = [&](DeviceSample& sample, int call) {
    sample.buttons = call >= 100 && call < 200 ? 3u : 1u;
    handle_m.push_back(sample.position_m);
  };
  bench.run(300);
  const auto& records = bench.recorder.records;
  const Vec3 held = records[99].input.pose_w.position_m;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const bool pressed = i >= 100 && i < 200;
    EXPECT_EQ((records[i].input.commands & Command::kUnheard) != 0, pressed) << i;
    EXPECT_TRUE(!pressed || norm(records[i].input.pose_w.position_m - held) < 1e-15) << i;
  }
  const Vec3 lost = handle_m[199] - handle_m[99];
  EXPECT_GT(norm(lost), 5e-3);
  for (std::size_t i = 200; i < records.size(); ++i)
    EXPECT_LT(norm(records[i].input.pose_w.position_m + lost - handle_m[i]), 1e-15) << i;
}

// The hand pulls to 10 mm behind the wall: static balance k_wall d = k_hand (10 mm - d), in the plant's exact position.
TEST(Loop, RestingOnTheWallBalancesTheHand) {
  PlantOptions plant;
  plant.friction_N = 0;
  plant.encoder_m = 0;
  Bench bench(plant, HandPath({{0, {{0.01, 0, 0}, {}}}, {0.3, {{-0.01, 0, 0}, {}}}}));
  bench.wall.stiffness_N_per_m = 600;
  const LoopSummary s = bench.run(1500);
  const double depth_m = 300.0 * 0.01 / (300.0 + 600.0);
  const TickRecord& r = bench.recorder.records[1499];
  EXPECT_NEAR(r.input.pose_w.position_m.x, -depth_m, 1e-9);
  EXPECT_NEAR(r.output.device_w.force_N.x, 600 * depth_m, 1e-6);
  EXPECT_EQ(s.faults, 0u);
}

double swing_after_contact(double stiffness_N_per_m) {
  PlantOptions plant;
  plant.mass_kg = 0.1;
  plant.damping_N_s_per_m = 1;
  plant.friction_N = 0;
  plant.encoder_m = 0;
  plant.hand_mass_kg = 0;
  plant.hand_stiffness_N_per_m = 50;
  plant.hand_damping_N_s_per_m = 0;
  plant.force_max_N = 100;
  Bench bench(plant, HandPath({{0, {{0.001, 0, 0}, {}}}, {0.2, {{-0.04, 0, 0}, {}}}}));
  bench.wall.stiffness_N_per_m = stiffness_N_per_m;
  bench.run(4000);
  double lowest = 1, highest = -1;
  for (std::size_t i = 3500; i < 4000; ++i) {
    const double x = bench.recorder.records[i].input.pose_w.position_m.x;
    lowest = min_of(lowest, x);
    highest = max_of(highest, x);
  }
  return highest - lowest;
}

// Colgate & Brown 1994 with one tick of transport delay: K T/2 + K T < b gives K < 667 N/m for b = 1 N s/m.
TEST(Loop, AWallWithinTheDampingBoundIsStillAndOneFarAboveChatters) {
  EXPECT_LT(swing_after_contact(300), 1e-6);
  EXPECT_GT(swing_after_contact(3000), 1e-3);
}

TEST(Overrun, LateByLessThanAPeriodRunsAtOnce) {
  Bench bench;
  bench.wall.during = [&](std::uint64_t step) { bench.clock.advance(step == 5 ? 1'400'000 : 0); };
  const LoopSummary s = bench.run(20);
  EXPECT_EQ(s.missed_slots, 0u);
  EXPECT_EQ(bench.recorder.records[6].timing.wake_latency_ns, 400'000);
  EXPECT_EQ(bench.recorder.records[5].timing.compute_ns, 1'400'000);
  EXPECT_EQ(bench.recorder.records[7].timing.wake_latency_ns, 0);
  EXPECT_EQ(s.worst_wake_ns, 400'000);
}

TEST(Overrun, LongWorkSkipsSlotsAndNeverBursts) {
  Bench bench;
  bench.wall.during = [&](std::uint64_t step) { bench.clock.advance(step == 5 ? 3'200'000 : 0); };
  const LoopSummary s = bench.run(20);
  const auto& r = bench.recorder.records;
  // Tick 5 held slot 6 (6 ms) and ended at 9.2 ms: slots 7, 8 and 9 are gone, the next is 10.
  EXPECT_EQ(r[6].timing.deadline_ns, 10 * kPeriod_ns);
  EXPECT_EQ(r[6].input.overrun_ticks, 3u);
  EXPECT_EQ(r[6].input.stale_ticks, 0u);
  EXPECT_EQ(r[7].timing.deadline_ns, 11 * kPeriod_ns);
  EXPECT_EQ(r[7].input.overrun_ticks, 0u);
  EXPECT_EQ(s.missed_slots, 3u);
  EXPECT_EQ(s.overrun_ticks, 1u);
  EXPECT_EQ(s.worst_missed, 3u);
  EXPECT_EQ(s.faults, 0u);
  for (std::size_t i = 1; i < r.size(); ++i)
    EXPECT_GE(r[i].timing.deadline_ns - r[i - 1].timing.deadline_ns, kPeriod_ns);
}

TEST(Overrun, ALateWakeUpWaitsForTheNextSlot) {
  Bench bench;
  bench.wall.during = [&](std::uint64_t step) { bench.clock.late(step == 5 ? 2'300'000 : 0); };
  bench.run(20);
  const TickRecord& r = bench.recorder.records[6];  // meant for 7 ms, woke at 9.3 ms
  EXPECT_EQ(r.timing.deadline_ns, 10 * kPeriod_ns);
  EXPECT_EQ(r.timing.wake_latency_ns, 0);
  EXPECT_EQ(r.input.overrun_ticks, 3u);
}

TEST(Overrun, TooManyInARowLatchTheFaultAndOneLongGapToo) {
  Bench always;
  always.wall.during = [&](std::uint64_t step) { always.clock.advance(step < 30 ? 2'500'000 : 0); };
  always.run(40);
  const auto& r = always.recorder.records;
  EXPECT_EQ(r[9].input.device_fault, 0u);  // tick 0 came in time, ticks 1..9 make nine overruns in a row
  EXPECT_EQ(r[10].input.device_fault, Fault::kOverrun);
  EXPECT_EQ(r[32].input.device_fault, 0u);  // the HAL does not latch; the core does
  Bench once;
  once.wall.during = [&](std::uint64_t step) { once.clock.advance(step == 3 ? 25 * kPeriod_ns : 0); };
  EXPECT_EQ(once.run(10).faults, Fault::kStalled);
  EXPECT_EQ(once.recorder.records[4].input.overrun_ticks, 25u);
}

TEST(DeadlineTracker, LoopAndSimulatedDeviceAreHalfAPeriodApart) {
  constexpr std::int64_t kPeriod = 1'000'000;
  for (const std::int64_t now : {0LL, 1LL, 499'999LL, 500'000LL, 999'999LL, 123'456'789'012LL}) {
    const std::int64_t slot = first_slot_ns(now, kPeriod, slot_phase_ns(kPeriod));
    const std::int64_t step = first_slot_ns(now, kPeriod, step_phase_ns(kPeriod));
    for (const std::int64_t first : {slot, step}) {
      EXPECT_GE(first - now, kPeriod / 2);
      EXPECT_LE(first - now, 3 * kPeriod / 2);
    }
    EXPECT_EQ(slot % kPeriod, kPeriod / 4);
    EXPECT_EQ(std::abs(slot - step), kPeriod / 2);
  }
  EXPECT_EQ(first_slot_ns(0, kPeriod, -1), kPeriod);  // virtual time
}

TEST(DeadlineTracker, SlotsStayOnOneGrid) {
  DeadlineTracker slots({}, 1000);
  EXPECT_FALSE(slots.skip(1000 + kPeriod_ns - 1));
  EXPECT_TRUE(slots.skip(1000 + kPeriod_ns));
  EXPECT_EQ(slots.deadline_ns(), 1000 + 2 * kPeriod_ns);  // strictly in the future
  EXPECT_EQ(slots.missed(), 2u);
  EXPECT_TRUE(slots.skip(std::int64_t{4'000'000} * kPeriod_ns));
  EXPECT_EQ((slots.deadline_ns() - 1000) % kPeriod_ns, 0);
}

TEST(Silence, AtStartEndsTheRunWithoutATick) {
  Bench bench;
  bench.options.start_timeout_ticks = 50;
  bench.device.silent = [](int) { return true; };
  const LoopSummary s = bench.run(100);
  EXPECT_EQ(s.end, LoopEnd::kSilentAtStart);
  EXPECT_EQ(s.ticks, 0u);
  EXPECT_EQ(s.start_ticks, 50u);
  EXPECT_EQ(bench.wall.steps, 0u);
  for (const DeviceCommand& command : bench.device.sent) EXPECT_EQ(command.force_N, Vec3{});
  expect_ends_with_zero_force(bench);
}

TEST(Silence, InMotionIsCountedRepeatsThePoseAndFaults) {
  Bench bench({}, HandPath({{0, {{0.01, 0, 0}, {}}}, {0.5, {{0.05, 0, 0}, {}}}}));
  bench.device.silent = [](int receive) { return receive >= 10 && receive < 40; };
  const LoopSummary s = bench.run(80);
  const auto& r = bench.recorder.records;
  for (std::size_t i = 10; i < 40; ++i) {
    EXPECT_EQ(r[i].input.stale_ticks, i - 9);
    EXPECT_EQ(r[i].input.pose_w, r[9].input.pose_w);
    EXPECT_EQ(r[i].input.device_fault, i - 9 >= 20 ? Fault::kDeviceSilent : 0u);
  }
  EXPECT_EQ(r[40].input.stale_ticks, 0u);
  EXPECT_EQ(r[40].input.device_fault, 0u);
  EXPECT_EQ(s.stale_ticks, 30u);
  EXPECT_EQ(s.worst_stale, 30u);
  EXPECT_EQ(s.faults, Fault::kDeviceSilent);
}

TEST(Silence, MissedSlotsCountIntoIt) {
  Bench bench;
  bench.device.silent = [](int receive) { return receive == 6; };
  bench.wall.during = [&](std::uint64_t step) { bench.clock.advance(step == 5 ? 3'200'000 : 0); };
  bench.run(20);
  EXPECT_EQ(bench.recorder.records[6].input.stale_ticks, 4u);
}

TEST(Stop, OnRequestRampsAndEndsWithZeroForce) {
  PlantOptions plant;
  Bench bench(plant, HandPath({{0, {{-0.01, 0, 0}, {}}}}));
  bench.wall.stiffness_N_per_m = 300;
  bench.wall.during = [&](std::uint64_t step) { bench.stop = step >= 50; };
  const LoopSummary s = bench.run(0);
  EXPECT_EQ(s.end, LoopEnd::kStopped);
  EXPECT_EQ(s.ticks, 52u);
  EXPECT_GT(bench.device.sent[40].force_N.x, 0.5);
  EXPECT_EQ(bench.recorder.records.back().input.commands & Command::kStop, Command::kStop);
  expect_ends_with_zero_force(bench);
}

// A controller that ignores the stop request cannot keep the force on.
TEST(Stop, IsBoundedEvenIfTheControllerRefuses) {
  struct Stubborn : Wall {
    void step(const Input& input, Output& output, const StageProbe& probe) {
      Wall::step(input, output, probe);
      output.mode = Mode::kForce;
      output.device_w.force_N = {1, 0, 0};
    }
  };
  Bench bench;
  Stubborn stubborn;
  bench.stop = false;
  bench.options.ticks = 10;
  bench.options.stop_ticks = 30;
  Loop loop(bench.device, bench.clock, stubborn, bench.recorder, bench.host, bench.kinematics, bench.options,
            bench.stop);
  EXPECT_EQ(loop.run().ticks, 10u + 30u);
  expect_ends_with_zero_force(bench);
}

TEST(Loop, APositionOutsideTheWorkspaceReachesTheCoreAsNotFinite) {
  Bench bench({}, HandPath({{0, {{0.2, 0, 0}, {}}}}));
  bench.kinematics.radius_m = 0.1;
  bench.run(3);
  EXPECT_FALSE(is_finite(bench.recorder.records[0].input.pose_w));
}

// The very same loop against a node on a wire, with both ends in this thread.
struct WireDevice {
  DeviceBus& bus;
  DeviceNode& node;
  VirtualClock& clock;
  void receive(DeviceSample& sample) noexcept {
    node.step(clock.now_ns());
    bus.receive(sample);
  }
  bool transmit(const DeviceCommand& command) noexcept { return bus.transmit(command); }
};

TEST(Loop, RunsOverTheWireWithFaultsAndLosesNothingItShouldKeep) {
  std::string error;
  auto [host_end, device_end] = open_loopback_pair(error);
  FaultTransport faulty(*host_end, {{50, 5, TransportFault::kLose},
                                    {100, 1, TransportFault::kCorrupt, 77},
                                    {150, 2, TransportFault::kDuplicate},
                                    {200, 1, TransportFault::kReorder},
                                    {250, 3, TransportFault::kFullQueue}});
  DeviceBus bus(faulty, WireProfile::kFd);
  DeviceNode node(*device_end, {}, {}, HandPath({{0, {{0.01, 0, 0}, {}}}, {0.2, {{-0.01, 0, 0}, {}}}}));
  VirtualClock clock;
  WireDevice device{bus, node, clock};
  Wall wall;
  wall.stiffness_N_per_m = 400;
  Recorder recorder;
  Silent silent;
  LoopOptions options;
  options.ticks = 400;
  const std::atomic<bool> stop{false};
  Loop loop(device, clock, wall, recorder, silent, CartesianKinematics{}, options, stop);
  const LoopSummary s = loop.run();
  EXPECT_EQ(s.stale_ticks, 5u + 1u + 1u);
  EXPECT_EQ(s.gaps, 5u + 1u + 1u);
  EXPECT_EQ(s.send_failures, 3u);
  EXPECT_EQ(s.faults, 0u);
  EXPECT_EQ(bus.counters().checksum, 1u);
  EXPECT_EQ(bus.counters().duplicates, 2u);
  EXPECT_EQ(bus.counters().reordered, 1u);
  EXPECT_EQ(recorder.records.size(), s.ticks);
  EXPECT_GT(recorder.records[395].output.device_w.force_N.x, 0.1);
  node.step(clock.now_ns());  // takes what the loop sent last
  EXPECT_EQ(node.command().force_N, Vec3{});
  EXPECT_EQ(node.command().flags, 0u);
}

}  // namespace
}  // namespace palpate
