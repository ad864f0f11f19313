#include "sim_host/view/steering.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim_host/run/joint_script.h"

namespace palpate {

namespace {

SharedMemory hand_memory() {
  std::string error;
  SharedMemory memory = SharedMemory::create("palpate-hand", sizeof(HandTargetRegion), error);
  if (!memory) throw std::runtime_error(error);
  return memory;
}

}  // namespace

Steering::Steering() : memory_(hand_memory()), writer_(*static_cast<HandTargetRegion*>(memory_.data())) {}

void Steering::pull(const Pose& pose) {
  writer_.write({pose, HandWish::kPull, 0});
  pulls_.fetch_add(1);
}

void Steering::take_up(const Model& model) {
  const std::lock_guard lock(mutex_);
  joint_.assign(model.joint.begin(), model.joint.end());
  joints_ = {};
}

void Steering::begin_from(const double (&closing)[kMaxFingers]) {
  const std::lock_guard lock(mutex_);
  if (moved_) return;
  for (std::int32_t f = 0; f < kMaxFingers; ++f)
    joints_.closing[f] = static_cast<float>(std::clamp(closing[f], 0.0, 1.0));
}

void Steering::close_by(std::int32_t finger, double share) {
  const std::lock_guard lock(mutex_);
  moved_ = true;
  for (std::int32_t f = 0; f < kMaxFingers; ++f) {
    if (finger >= 0 && f != finger) continue;
    const double before = double{joints_.closing[f]}, after = std::clamp(before + share, 0.0, 1.0);
    joints_.closing[f] = static_cast<float>(after);
    for (std::size_t j = 0; j < joint_.size(); ++j)
      if (joint_[j].finger == f && (joints_.direct >> j & 1u) != 0)
        put(j, at(j) + (after - before) * (joint_[j].closed - joint_[j].open));
  }
}

// Where the command has it.
double Steering::at(std::size_t joint) const {
  const Joint& j = joint_[joint];
  if ((joints_.direct >> joint & 1u) != 0) return double{joints_.target[joint]};
  return j.open + double{joints_.closing[j.finger]} * (j.closed - j.open);
}

void Steering::put(std::size_t joint, double position) {
  joints_.direct |= 1u << joint;
  joints_.target[joint] = joint_target(joint_[joint], position);
}

void Steering::move_joint(std::size_t joint, double share) {
  const std::lock_guard lock(mutex_);
  if (joint >= joint_.size()) return;
  moved_ = true;
  const Joint& j = joint_[joint];
  const double way = j.closed < j.open ? -1 : 1;
  put(joint, at(joint) + way * share * (j.highest - j.lowest));
}

void Steering::put_joint(std::size_t joint, double position) {
  const std::lock_guard lock(mutex_);
  if (joint >= joint_.size() || !std::isfinite(position)) return;
  moved_ = true;
  put(joint, position);
}

void Steering::free_joint(std::size_t joint) {
  const std::lock_guard lock(mutex_);
  if (joint < joint_.size()) joints_.direct &= ~(1u << joint);
}

std::optional<JointCommand> Steering::told(bool is_there) const {
  const std::lock_guard lock(mutex_);
  if (!moved_ && !is_there) return std::nullopt;
  return joints_;
}

void Steering::hold() { writer_.write({{}, HandWish::kHold, 0}); }

}  // namespace palpate
