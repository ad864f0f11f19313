// Makes the calling thread a real-time thread, one verdict per measure. Nothing here aborts: a refused measure is
// reported with its errno and what to do, and the caller decides whether to go on.
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

namespace palpate {

struct RtOptions {
  int priority = 80;                     // SCHED_FIFO 1..99; 0: leave the scheduling policy alone
  int cpu = -1;                          // pin to this CPU; -1: leave the affinity alone
  bool lock_memory = true;               // mlockall, so that no page fault happens later
  bool quiet_heap = true;                // keep freed memory, so that the heap never returns pages
  std::size_t stack_bytes = 256 * 1024;  // of the stack touched now; at most 1 MiB; 0: none
  bool no_deep_sleep = true;             // hold /dev/cpu_dma_latency at 0
};

struct RtVerdict {
  std::string item;  // "scheduler", "affinity", "memory lock", "heap", "stack", "cpu sleep states"
  bool ok = false;
  int error = 0;       // errno of a refusal
  std::string detail;  // what was set, or why not and the remedy
};

// Keeps what must stay held (the cpu_dma_latency file); destroy it after the loop.
class RtSetup {
 public:
  explicit RtSetup(const RtOptions& options);
  ~RtSetup();
  RtSetup(const RtSetup&) = delete;
  RtSetup& operator=(const RtSetup&) = delete;

  const std::vector<RtVerdict>& verdicts() const { return verdicts_; }
  bool all_ok() const;
  std::string text() const;  // one line per verdict

 private:
  int latency_fd_ = -1;
  std::vector<RtVerdict> verdicts_;
};

// What the kernel counted for the calling thread since it started (getrusage). Over a run no page fault may be added;
// waits are the sleeps of the loop, preemptions are what ran at a higher priority: interrupt threads.
struct ThreadUsage {
  long minor_faults = 0, major_faults = 0, waits = 0, preemptions = 0;
};
ThreadUsage thread_usage();
inline ThreadUsage operator-(const ThreadUsage& a, const ThreadUsage& b) {
  return {a.minor_faults - b.minor_faults, a.major_faults - b.major_faults, a.waits - b.waits,
          a.preemptions - b.preemptions};
}

// SIGINT and SIGTERM set the flag returned here instead of ending the process; SIGPIPE and SIGTSTP are ignored (a
// stopped controller would leave the device waiting). Call once at start-up.
const std::atomic<bool>& install_stop_signals();
// SIGUSR1 counts up the number returned here: an operator's request to arm, where there is no host.
const std::atomic<std::uint32_t>& install_arm_signal();

}  // namespace palpate
