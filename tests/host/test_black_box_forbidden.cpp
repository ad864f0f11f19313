// A forbidden system call in the real-time thread, all the way: the kernel refuses it, the host's port sees it, the
// supervised device hands it to the tick as a fault, and the loop ends.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <thread>
#include <vector>

#include "hal/device_sim.h"
#include "hal/loop.h"
#include "hal/syscall_filter.h"
#include "sim_host/host_port.h"

namespace palpate {
namespace {

constexpr std::uint64_t kForbiddenTick = 50;
constexpr std::size_t kMostRecords = 400;

// Latches what it is told, as the core does, and breaks the rule once.
struct Careless {
  std::uint64_t steps = 0;
  std::uint32_t latched = 0;
  void step(const Input& input, Output& output, const StageProbe&) {
    if (steps++ == kForbiddenTick) syscall(SYS_openat, AT_FDCWD, "/dev/null", O_RDONLY, 0);
    latched |= input.device_fault;
    output = {};
    output.fault = latched;
    output.mode = latched != 0 ? Mode::kFault : Mode::kForce;
    if (latched == 0) output.device_w.force_N = {1, 0, 0};
  }
  void fill(const Input& input, const Output& output, TickRecord& record) {
    record.input = input;
    record.output = output;
  }
};

struct Memory {
  TickRecord record[kMostRecords];
  std::size_t count = 0;
  void publish(const TickRecord& r) {
    if (count < kMostRecords) record[count++] = r;
  }
};

TEST(ForbiddenCall, BecomesAFaultOfTheNextTickAndEndsTheLoop) {
  clear_forbidden_syscall();
  VirtualClock clock;
  SimulatedDevice plant({}, {}, clock);
  std::atomic<bool> stop{false}, interrupted{false};
  HostPort port(nullptr, 1000, interrupted, stop);
  SupervisedDevice device(plant, port);
  Careless controller;
  const auto memory = std::make_unique<Memory>();
  const CartesianKinematics kinematics;
  LoopOptions options;
  options.ticks = 300;
  LoopSummary summary;
  bool installed = false;
  std::string reason;
  std::thread thread([&] {
    installed = install_syscall_filter(reason);
    if (!installed) return;
    Loop loop(device, clock, controller, *memory, port, kinematics, options, stop);
    summary = loop.run();
  });
  thread.join();
  clear_forbidden_syscall();
  ASSERT_TRUE(installed) << reason;
  EXPECT_EQ(summary.end, LoopEnd::kStopped);
  EXPECT_EQ(summary.faults, Fault::kForbiddenCall);
  EXPECT_EQ(port.faults(), Fault::kForbiddenCall);
  ASSERT_GT(memory->count, kForbiddenTick + 1);
  EXPECT_LT(memory->count, kForbiddenTick + 5);
  for (std::size_t i = 0; i <= kForbiddenTick; ++i) EXPECT_EQ(memory->record[i].input.device_fault, 0u) << i;
  const TickRecord& last = memory->record[memory->count - 1];
  EXPECT_EQ(last.input.device_fault, Fault::kForbiddenCall);
  EXPECT_EQ(last.output.device_w, Wrench{});
}

}  // namespace
}  // namespace palpate
