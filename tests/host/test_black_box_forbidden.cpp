// A forbidden system call in the real-time thread, all the way: the kernel refuses it, the host's port sees it, the
// supervised device hands it to the tick as a fault, and the loop ends.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "hal/device/device_sim.h"
#include "hal/loop/loop.h"
#include "hal/system/syscall_filter.h"
#include "sim_host/run/host_port.h"

namespace palpate {
namespace {

constexpr std::uint64_t kForbiddenTick = 50;
constexpr std::size_t kMostRecords = 400;

// A sanitizer's own library makes system calls in any thread at any time, so there only the forbidden call itself is
// made under the filter, by a thread of its own; otherwise the whole loop runs under it, as in the controller.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

void open_null() { syscall(SYS_openat, AT_FDCWD, "/dev/null", O_RDONLY, 0); }

// Leaves by the bare system call: the sanitizer's own clean-up of a thread would be refused too.
void* open_null_filtered(void* done) {
  std::string reason;
  if (install_syscall_filter(reason)) open_null();
  static_cast<std::atomic<bool>*>(done)->store(true);
  syscall(SYS_exit, 0);
  return nullptr;
}

void forbidden_call() {
  if (!kSanitized) return open_null();
  std::atomic<bool> done{false};
  pthread_t thread{};
  ASSERT_EQ(pthread_create(&thread, nullptr, open_null_filtered, &done), 0);
  pthread_join(thread, nullptr);
  EXPECT_TRUE(done);
}

// Latches what it is told, as the core does, and breaks the rule once.
struct Careless {
  std::uint64_t steps = 0;
  std::uint32_t latched = 0;
  void step(const Input& input, Output& output, const StageProbe&) {
    if (steps++ == kForbiddenTick) forbidden_call();
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
    installed = kSanitized || install_syscall_filter(reason);
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
