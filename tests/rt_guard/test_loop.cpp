// The whole real-time thread: receive, tick, transmit and publish through the real loop, wire codec and loopback
// transport, with the shipped system-call filter installed and the guard armed, for 100,000 ticks. The period is a
// tenth of the real one so that the test takes ten seconds; nothing here depends on deadlines being met.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "hal/bus/device_bus.h"
#include "hal/bus/loopback.h"
#include "hal/device/device_node.h"
#include "hal/loop/loop.h"
#include "hal/system/rt_linux.h"
#include "hal/system/syscall_filter.h"
#include "sim_host/rings/telemetry.h"
#include "sim_host/tick_memory.h"
#include "tests/rt_guard/guard.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

constexpr std::uint64_t kWarmUpTicks = 2000;
constexpr std::uint64_t kTicks = 100000;
constexpr std::int64_t kPeriod_ns = 100'000;

// Presses 8 mm deep and slides to and fro, twice a second of the device's own time, for the whole run.
HandPath pressing_path(const Model& model) {
  const Vec3 touch = touching_position(model);
  std::vector<HandPose> poses{{0.0, {touch + Vec3{0, 0.01, 0}, {}}}};
  for (int i = 1; i < 250; ++i) {
    const Vec3 slide{i % 2 == 0 ? 0.004 : -0.004, i % 20 == 0 ? 0.005 : -0.008, 0};
    poses.push_back({0.5 * i, {touch + slide, {}}});
  }
  return HandPath(std::move(poses));
}

// Publishes into a real telemetry region, and counts what the test wants to know.
struct Sink {
  explicit Sink(TelemetryWriter& telemetry) : writer(telemetry) {}
  void publish(const TickRecord& record) noexcept {
    writer.write(record);
    ticks_in_contact += record.output.contacts > 0 ? 1 : 0;
  }
  TelemetryWriter& writer;
  std::uint64_t ticks_in_contact = 0;
};
struct ArmedHost {
  std::uint32_t poll() noexcept { return Command::kArm; }
};

// Minor and major faults of a thread of this process, read from outside it.
long faults_of_thread(pid_t thread) {
  std::ifstream file("/proc/self/task/" + std::to_string(thread) + "/stat");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  std::istringstream fields(text.substr(text.rfind(')') + 2));  // the name before may hold anything
  std::string skipped;
  long minor = 0, major = 0;
  for (int i = 3; i < 10; ++i) fields >> skipped;  // fields 3..9 of proc(5)
  fields >> minor >> skipped >> major;
  return fields ? minor + major : -1;
}

struct RealTimeThread {
  const Model& model;
  Transport& transport;
  TelemetryWriter& telemetry;
  std::atomic<pid_t> id{0};
  std::atomic<int> stage{0};  // 1: warm, 2: go, 3: done, 4: leave
  CallCount calls;
  int forbidden = -2;
  std::uint64_t ticks = 0, ticks_in_contact = 0;
  std::string refused;  // why the filter could not be installed

  void wait_for(int wanted) const {
    while (stage.load() != wanted) __builtin_ia32_pause();
  }

  // Where memory cannot be locked (no privilege), the script at least touches every page of code a tick can need:
  // libccd's is used only when a contact is lost.
  void visit_all_code(State& state, Scratch& scratch) const {
    reset(state);
    Output output;
    ScriptedHand hand(model);
    for (int i = 0; i < kScriptTicks; ++i) tick(model, state, scratch, hand.next(output), output);
    reset(state);
  }

  void run() {
    id = gettid();
    const RtSetup setup({.priority = 0, .no_deep_sleep = false});
    const auto state = make_state(model);
    const auto scratch = make_scratch(model);
    visit_all_code(*state, *scratch);
    ModelController controller(model, *state, *scratch);
    DeviceBus device(transport, WireProfile::kFd);
    MonotonicClock clock;
    ArmedHost host;
    Sink sink(telemetry);
    const std::atomic<bool> stop{false};
    LoopOptions options;
    options.deadline = {kPeriod_ns, 1'000'000'000, 1'000'000'000};
    options.silence_fault_ticks = 1'000'000'000;
    options.start_timeout_ticks = 100'000;
    options.stop_ticks = 0;
    options.ticks = kWarmUpTicks;
    Loop(device, clock, controller, sink, host, CartesianKinematics{}, options, stop).run();
    install_syscall_filter(refused);
    arm();  // touches the guard's own pages, in case memory could not be locked
    calls = disarm();
    forbidden = forbidden_syscall();
    stage = 1;
    wait_for(2);
    sink.ticks_in_contact = 0;
    options.ticks = kTicks;
    arm();
    ticks = Loop(device, clock, controller, sink, host, CartesianKinematics{}, options, stop).run().ticks;
    calls = disarm();
    forbidden = forbidden_syscall();
    ticks_in_contact = sink.ticks_in_contact;
    stage = 3;
    wait_for(4);
  }
};

TEST(RealTimeThread, HundredThousandTicksWithoutHeapLockPageFaultOrForbiddenCall) {
  const ImageFile image(std::string(PALPATE_IMAGE_DIR) + "/ellipsoid_mallet.pal");
  std::string error;
  auto [controller_end, device_end] = open_loopback_pair(error);
  ASSERT_TRUE(controller_end && device_end) << error;
  const auto region = std::make_unique<TelemetryRegion>();
  TelemetryWriter telemetry;
  telemetry.open(*region, image.model(), kPeriod_ns, "", "");
  clear_forbidden_syscall();

  std::atomic<bool> device_stop{false};
  std::thread device([&, end = device_end.get()] {
    DeviceNode node(*end, {}, {}, pressing_path(image.model()));
    MonotonicClock clock;
    for (std::int64_t deadline_ns = clock.now_ns(); !device_stop; deadline_ns += kPeriod_ns) {
      clock.wait_until(deadline_ns);
      node.step(clock.now_ns());
    }
  });
  RealTimeThread thread{image.model(), *controller_end, telemetry, {}, {}, {}, -2, 0, 0, {}};
  std::thread controller([&] { thread.run(); });
  while (thread.stage != 1) usleep(1000);
  const long faults_before = faults_of_thread(thread.id);
  thread.stage = 2;
  while (thread.stage != 3) usleep(1000);
  const long faults_after = faults_of_thread(thread.id);
  thread.stage = 4;
  controller.join();
  device_stop = true;
  device.join();
  clear_forbidden_syscall();  // leaving the thread makes calls the filter refuses

  EXPECT_EQ(thread.refused, "");
  EXPECT_GE(thread.ticks, kTicks);
  EXPECT_GT(thread.ticks_in_contact, kTicks / 2) << "without contact this proves nothing";
  EXPECT_EQ(thread.calls.heap, 0) << thread.calls.first;
  EXPECT_EQ(thread.calls.lock, 0) << thread.calls.first;
  EXPECT_EQ(thread.forbidden, -1) << "number of the first forbidden system call";
  ASSERT_GE(faults_before, 0);
  EXPECT_EQ(faults_after - faults_before, 0);
}

}  // namespace
}  // namespace palpate::test
