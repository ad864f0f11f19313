// Two hands, two devices, one loop and one tick, in virtual time: one hand holds the tube, the other the clip, and they
// snap them together between them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

#include "hal/device/device_sim.h"
#include "hal/loop/loop.h"
#include "rt_core/tool/held_body.h"
#include "sim_host/run/device_process.h"
#include "tests/support/baked_scene.h"
#include "tests/support/scene_hand.h"

namespace palpate::test {
namespace {

constexpr Vec3 kGrip_m{0, -0.012, 0};
constexpr double kUp_m = 0.006;  // of the 14.5 mm the clip's hand does, upwards

SceneDesc snap_between() {
  SceneDesc scene = load_scene(PALPATE_SOURCE_DIR "/config/scenes/snap_in_paper.toml");
  scene.device.holds = HeldPart::kBoth;
  scene.device.grip_m = kGrip_m;
  scene.device.coupling_N_per_m = 4500;  // two of these devices admit 5,000 between them
  return scene;
}

// A device that does what a script says to its samples.
struct Scripted {
  SimulatedDevice inner;
  std::function<void(std::uint64_t, DeviceSample&)> change = {};
  std::uint64_t receives = 0;
  DeviceCommand sent = {};
  Vec3 most_N = {};
  void receive(DeviceSample& sample) noexcept {
    inner.receive(sample);
    if (change) change(receives, sample);
    receives += 1;
  }
  bool transmit(const DeviceCommand& command) noexcept {
    sent = command;
    if (norm(command.force_N) > norm(most_N)) most_N = command.force_N;
    return inner.transmit(command);
  }
};

struct Records {
  std::vector<TickRecord> all;
  void publish(const TickRecord& record) { all.push_back(record); }
};

HandPath tube_path() {
  const Vec3 from{0, 0.0145 + 0.002, 0}, to{0, kUp_m, 0};
  return HandPath({{0, {from, {}}}, {0.5, {from, {}}}, {3, {to, {}}}});
}
HandPath clip_path() {
  const Vec3 to = kGrip_m + Vec3{0, kUp_m, 0};
  return HandPath({{0, {kGrip_m, {}}}, {1, {kGrip_m, {}}}, {2.5, {to, {}}}});
}

struct Bench {
  explicit Bench(const BakedScene& baked) : model(baked.model()) {
    reset(*state);
    options.deadline = deadline_limits(model.params);
    options.link = link_limits(model.params);
    options.silence_fault_ticks = static_cast<std::uint32_t>(model.params.silence_fault_ticks);
  }
  LoopSummary run(std::uint64_t ticks) {
    options.ticks = ticks;
    ModelController controller(model, *state, *scratch);
    return Loop(tube, clock, controller, records, host, CartesianKinematics{}, options, stop, &clip,
                CartesianKinematics{})
        .run();
  }
  const Model& model;
  StatePtr state = make_state(model);
  ScratchPtr scratch = make_scratch(model);
  VirtualClock clock;
  PlantOptions plant = plant_of(snap_between());
  Scripted tube{SimulatedDevice(plant, tube_path(), clock)}, clip{SimulatedDevice(plant, clip_path(), clock)};
  Records records;
  ArmedHost host;
  LoopOptions options;
  std::atomic<bool> stop{false};
};

const BakedScene& baked() {
  static const BakedScene scene(snap_between());
  return scene;
}

TEST(TwoHands, SnapTheClipOverTheTubeBetweenThem) {
  Bench bench(baked());
  const LoopSummary s = bench.run(4000);
  EXPECT_EQ(s.end, LoopEnd::kTicksDone);
  EXPECT_EQ(s.faults, 0u);
  EXPECT_EQ(s.missed_slots + s.stale_ticks + s.send_failures, 0u);
  double most_N = 0, least_N = 0;
  for (const TickRecord& r : bench.records.all) {
    EXPECT_NEAR(norm(r.output.device_w.force_N + r.output.second_w.force_N), 0, 1e-14);
    most_N = std::max(most_N, r.output.device_w.force_N.y);
    least_N = std::min(least_N, r.output.device_w.force_N.y);
  }
  std::printf("tube pushed by %.2f N on the way in, pulled by %.2f N\n", most_N, -least_N);
  EXPECT_GT(most_N, 5) << "the snap: with friction 10.7 N at 3 mm (docs/papers.md)";
  EXPECT_LT(least_N, -2) << "and pulls";
  const Pose clip = bench.clip.inner.plant().pose(), tube = bench.tube.inner.plant().pose();
  EXPECT_LT(norm(tool_seen(kGrip_m, clip, tube).position_m), 1e-3) << "seated";
  EXPECT_NEAR(clip.position_m.y - kGrip_m.y, kUp_m, 1e-3) << "both hands moved";
  EXPECT_EQ(bench.tube.sent.flags & bench.clip.sent.flags & CommandFlag::kEnable, 0u);
  EXPECT_EQ(bench.tube.sent.force_N, Vec3{});
  EXPECT_EQ(bench.clip.sent.force_N, Vec3{});
}

// The tube's way is that of one hand alone: the clip's hand, lifted, only adds its own.
TEST(TwoHands, TheSameRunTwiceIsTheSameToTheBitAndReplays) {
  Bench one(baked()), other(baked());
  one.run(3500), other.run(3500);
  ASSERT_EQ(one.records.all.size(), other.records.all.size());
  const StatePtr state = make_state(baked().model());
  const ScratchPtr scratch = make_scratch(baked().model());
  Output output;
  for (std::size_t i = 0; i < one.records.all.size(); ++i) {
    const TickRecord &a = one.records.all[i], &b = other.records.all[i];
    ASSERT_EQ(a.state_hash, b.state_hash) << i;
    ASSERT_EQ(std::memcmp(&a.output, &b.output, sizeof(Output)), 0) << i;
    tick(baked().model(), *state, *scratch, a.input, output);  // a recording holds no more than the inputs
    ASSERT_EQ(hash_state(*state), a.state_hash) << i;
    ASSERT_EQ(std::memcmp(&a.output, &output, sizeof(Output)), 0) << i;
  }
}

struct Trouble {
  const char* name;
  std::uint32_t fault;
  std::function<void(std::uint64_t, DeviceSample&)> change;
};
// Seated and pressed at 3.2 s, then: whichever device fails, both are let go and the fault is latched.
TEST(TwoHands, TroubleOfEitherDeviceLetsBothGo) {
  const Trouble troubles[] = {
      {"silent", Fault::kDeviceSilent, [](std::uint64_t n, DeviceSample& s) { s.fresh = s.fresh && n < 1800; }},
      {"stopped", Fault::kDeviceReported,
       [](std::uint64_t n, DeviceSample& s) { s.faults |= n < 1800 ? 0u : Fault::kDeviceReported; }},
      {"deaf", Fault::kDeviceDeaf, [](std::uint64_t n, DeviceSample& s) { s.command_lag = n < 1800 ? 0u : 60u; }},
      {"out of its workspace", Fault::kSamplesRejected,
       [](std::uint64_t n, DeviceSample& s) { s.position_m.x += n < 1800 ? 0.0 : 2.0; }},
  };
  for (const Trouble& trouble : troubles)
    for (const bool second : {false, true}) {
      Bench bench(baked());
      (second ? bench.clip : bench.tube).change = trouble.change;
      const LoopSummary s = bench.run(2400);
      EXPECT_TRUE((s.faults & trouble.fault) != 0) << trouble.name << second << " faults " << s.faults;
      const TickRecord &before = bench.records.all[1790], &last = bench.records.all.back();
      EXPECT_GT(norm(before.output.device_w.force_N), 1) << "pressed until then";
      EXPECT_EQ(last.output.mode, Mode::kFault) << trouble.name << second;
      EXPECT_EQ(last.output.device_w, Wrench{});
      EXPECT_EQ(last.output.second_w, Wrench{});
      for (std::size_t i = 1800; i < bench.records.all.size(); ++i) {
        const Wrench &a = bench.records.all[i].output.device_w, &b = bench.records.all[i - 1].output.device_w;
        ASSERT_LT(norm(a.force_N - b.force_N), 2.5) << trouble.name << second << " tick " << i << ": a ramp, no kick";
      }
    }
}

// Nobody is armed before both devices are there.
TEST(TwoHands, NothingMovesBeforeBothAreThere) {
  Bench bench(baked());
  bench.clip.change = [](std::uint64_t, DeviceSample& s) { s.fresh = false; };
  bench.options.start_timeout_ticks = 100;
  const LoopSummary s = bench.run(500);
  EXPECT_EQ(s.end, LoopEnd::kSilentAtStart);
  EXPECT_EQ(s.ticks, 0u);
  EXPECT_EQ(bench.tube.most_N, Vec3{});
}

}  // namespace
}  // namespace palpate::test
