// The mouse as a device: what a viewer tells the simulated hand of a run, and a hand's fingers.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "hal/system/shared_memory.h"
#include "rt_core/live.h"
#include "sim_host/rings/hand_target.h"

namespace palpate {

// Pull and closing are told by one thread; the run asks from another.
class Steering {
 public:
  // Throws std::runtime_error when there is no memory to share.
  Steering();
  // The handle is pulled to `pose`, and held there until it is told otherwise.
  void pull(const Pose& pose);
  // The hand stays where its own motion has it now, until it is pulled.
  void hold();
  // How often it was pulled so far.
  std::uint64_t pulls() const { return pulls_.load(); }
  // 0 open to 1 closed, of all fingers or jaws; from the first call on.
  void close_to(double closing) { closing_.store(static_cast<float>(closing)); }
  // Below 0: nobody asked yet.
  float closing() const { return closing_.load(); }
  // One of the run's live settings is to be this; the others stay as anybody wanted them.
  void set(float LiveSettings::*which, float value) {
    const std::lock_guard lock(mutex_);
    asked_.emplace_back(which, value);
  }
  // What was asked since the last time.
  void apply_settings(LiveSettings& wanted) {
    const std::lock_guard lock(mutex_);
    for (const auto& [which, value] : asked_) wanted.*which = value;
    asked_.clear();
  }
  // For the simulated device (palpate-device --hand-fd).
  int fd() const { return memory_.fd(); }

 private:
  SharedMemory memory_;
  HandTargetWriter writer_;
  std::mutex mutex_;
  std::vector<std::pair<float LiveSettings::*, float>> asked_;
  std::atomic<float> closing_{-1};
  std::atomic<std::uint64_t> pulls_{0};
};

}  // namespace palpate
