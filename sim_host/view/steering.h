// The mouse as a device: what a viewer tells the simulated hand of a run, and a hand's fingers and joints.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "hal/system/shared_memory.h"
#include "rt_core/io.h"
#include "rt_core/live.h"
#include "rt_core/model.h"
#include "sim_host/rings/hand_target.h"

namespace palpate {

// A viewer tells from one thread; the run asks from another.
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
  // The tool of a scene that begins: open, and no joint away from its finger.
  void take_up(const Model& model);
  // Nobody moved a finger yet: they go on from where the run has them.
  void begin_from(const double (&closing)[kMaxFingers]);
  // Moves one finger or jaw, or all (finger < 0), by a share of its way: 0 open to 1 closed. Joints that were moved by
  // themselves go along as far as the others do.
  void close_by(std::int32_t finger, double share);
  // Moves one joint by a share of its range, the way its finger closes; it stays there whatever its finger does, until
  // it is let go. Nothing where there is no such joint.
  void move_joint(std::size_t joint, double share);
  // Puts it there (rad or m), within its limits.
  void put_joint(std::size_t joint, double position);
  // It goes with its finger again.
  void free_joint(std::size_t joint);
  // Where the fingers and joints are told to be; nothing before anybody asked, unless somebody `is_there` to.
  std::optional<JointCommand> told(bool is_there) const;
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
  double at(std::size_t joint) const;
  void put(std::size_t joint, double position);

  mutable std::mutex mutex_;
  std::vector<std::pair<float LiveSettings::*, float>> asked_;
  std::vector<Joint> joint_;  // of the tool
  JointCommand joints_;
  bool moved_ = false;  // somebody asked
  std::atomic<std::uint64_t> pulls_{0};
};

}  // namespace palpate
