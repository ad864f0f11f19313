#include "hal/system/rt_linux.h"

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>

namespace palpate {
namespace {

RtVerdict accepted(const char* item, std::string detail) { return {item, true, 0, std::move(detail)}; }

RtVerdict refused(const char* item, int error, const std::string& remedy) {
  return {item, false, error, std::string(std::strerror(error)) + ": " + remedy};
}

RtVerdict set_scheduler(int priority) {
  constexpr const char* kItem = "scheduler";
  if (priority == 0) return accepted(kItem, "left alone");
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
  if (error == 0) return accepted(kItem, "SCHED_FIFO " + std::to_string(priority));
  if (error == EINVAL) return refused(kItem, error, "priority must be 1..99");
  return refused(kItem, error,
                 "SCHED_FIFO " + std::to_string(priority) +
                     " needs an rtprio limit: add '@realtime - rtprio 99' to /etc/security/limits.d and log in again "
                     "(with CONFIG_RT_GROUP_SCHED also give the cgroup a cpu.rt_runtime)");
}

RtVerdict set_affinity(int cpu) {
  constexpr const char* kItem = "affinity";
  if (cpu < 0) return accepted(kItem, "left alone");
  cpu_set_t set;
  CPU_ZERO(&set);
  if (cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(cpu), &set);
  const int error = ::pthread_setaffinity_np(::pthread_self(), sizeof set, &set);
  if (error == 0) return accepted(kItem, "CPU " + std::to_string(cpu));
  return refused(kItem, error,
                 "CPU " + std::to_string(cpu) + " is not one of those listed in /sys/devices/system/cpu/online");
}

RtVerdict lock_memory() {
  constexpr const char* kItem = "memory lock";
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return accepted(kItem, "all pages, now and later");
  return refused(kItem, errno,
                 "raise the memlock limit: add '@realtime - memlock unlimited' to /etc/security/limits.d");
}

RtVerdict quiet_heap() {
  // Neither trimmed nor served by separate mappings: pages touched once stay ours.
  if (::mallopt(M_TRIM_THRESHOLD, -1) == 1 && ::mallopt(M_MMAP_MAX, 0) == 1)
    return accepted("heap", "never trimmed, no separate mappings");
  return refused("heap", EINVAL, "this C library has no mallopt: harmless, the loop does not allocate");
}

// Touches one byte in every page below the caller's frame, so that the loop's stack is already there.
__attribute__((noinline)) RtVerdict touch_stack(std::size_t bytes) {
  constexpr std::size_t kMost = 1024 * 1024, kPage = 4096;
  if (bytes == 0) return accepted("stack", "left alone");
  if (bytes > kMost) return refused("stack", EINVAL, "ask for at most 1 MiB");
  volatile char block[kMost];
  for (std::size_t i = kMost; i > kMost - bytes; i -= std::min(kPage, i)) block[i - 1] = 1;
  if (block[kMost - 1] != 1) return refused("stack", EFAULT, "the stack does not hold what was written");
  return accepted("stack", std::to_string(bytes / 1024) + " KiB touched");
}

// The kernel's page that clock readings come from is mapped when first read, and mlockall leaves it out: one page fault
// in the loop's first tick on Linux 6.18 (seen with the tracepoint page_fault_user, 2026-11-21).
void touch_clock() {
  timespec now;
  ::clock_gettime(CLOCK_MONOTONIC, &now);
}

RtVerdict hold_latency(int& fd) {
  constexpr const char* kItem = "cpu sleep states";
  constexpr const char* kPath = "/dev/cpu_dma_latency";
  const std::int32_t target_us = 0;
  fd = ::open(kPath, O_WRONLY | O_CLOEXEC);
  if (fd >= 0 && ::write(fd, &target_us, sizeof target_us) == sizeof target_us)
    return accepted(kItem, "0 us held while running");
  return refused(kItem, errno, std::string("allow writing ") + kPath + " by a udev rule, or boot with cpuidle.off=1");
}

std::atomic<bool> stop_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "the signal handler writes it");

void on_signal(int) { stop_flag.store(true, std::memory_order_relaxed); }

std::atomic<std::uint32_t> arm_requests{0};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "the signal handler writes it");

void on_arm_signal(int) { arm_requests.fetch_add(1, std::memory_order_relaxed); }

}  // namespace

RtSetup::RtSetup(const RtOptions& options) {
  // Memory first: pages of the stack and heap touched later are then locked as they come.
  if (options.lock_memory) verdicts_.push_back(lock_memory());
  if (options.quiet_heap) verdicts_.push_back(quiet_heap());
  verdicts_.push_back(touch_stack(options.stack_bytes));
  touch_clock();
  verdicts_.push_back(set_affinity(options.cpu));
  if (options.no_deep_sleep) verdicts_.push_back(hold_latency(latency_fd_));
  verdicts_.push_back(set_scheduler(options.priority));  // last: the rest needs no priority and may take long
}

RtSetup::~RtSetup() {
  if (latency_fd_ >= 0) ::close(latency_fd_);
}

bool RtSetup::all_ok() const {
  return std::all_of(verdicts_.begin(), verdicts_.end(), [](const RtVerdict& v) { return v.ok; });
}

std::string RtSetup::text() const {
  std::string text;
  for (const RtVerdict& v : verdicts_) text += (v.ok ? "ok       " : "REFUSED  ") + v.item + ": " + v.detail + "\n";
  return text;
}

ThreadUsage thread_usage() {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return {usage.ru_minflt, usage.ru_majflt, usage.ru_nvcsw, usage.ru_nivcsw};
}

const std::atomic<bool>& install_stop_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &action, nullptr);
  ::sigaction(SIGTSTP, &action, nullptr);
  return stop_flag;
}

const std::atomic<std::uint32_t>& install_arm_signal() {
  struct sigaction action {};
  action.sa_handler = on_arm_signal;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGUSR1, &action, nullptr);
  return arm_requests;
}

}  // namespace palpate
