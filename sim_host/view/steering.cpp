#include "sim_host/view/steering.h"

#include <stdexcept>

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

void Steering::hold() { writer_.write({{}, HandWish::kHold, 0}); }

}  // namespace palpate
