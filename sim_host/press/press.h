// Presses without a device: drives tick() through a list of tool poses, one pose per tick, and hands out every result.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "rt_core/record.h"
#include "sim_host/press/pose_csv.h"

namespace palpate {

struct PressRow {
  double time_s = 0;
  TickRecord record{};             // inputs, outputs, regions and state hash of this tick
  std::int64_t compute_ns = 0;     // of tick(), on this machine, now: not repeatable
  std::int64_t instructions = -1;  // of tick() in user space; -1 where the kernel does not count them
};

// Counts this thread's user-space instructions through perf_event_open.
class InstructionCounter {
 public:
  InstructionCounter();
  ~InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;
  bool available() const { return fd_ >= 0; }
  void start();
  // Instructions since start(); -1 when not available.
  std::int64_t stop();

 private:
  int fd_ = -1;
};

// Called after every tick. `state` and `scratch` (the contacts) are the tick's; they change with the next one.
using PressListener = std::function<void(const PressRow& row, const State& state, const Scratch& scratch)>;

// How the poses move the tool.
struct PressDrive {
  // 0: the poses are the tool's own. Otherwise they are where a hand pulls the tool with this spring: each tick moves
  // the tool to where spring and contact balance, by one Newton step with the last tick's tangent, and on a
  // nodal body in the tick itself (massless, quasi-static; orientation as given). For motions scripted for a hand,
  // which aim deep below the surface.
  double hand_N_per_m = 0;
};

// Resets `state`, then renders one tick per pose with Drive::kTool: the virtual coupling is bypassed, so
// output.contact_w is the wrench of the object on the tool held at that pose. (A nodal body's tool on a hand: with
// Drive::kHeld, the hand's spring in place of the coupling.) `counter` may be null.
void press(const Model& model, std::span<const TimedPose> poses, const PressDrive& drive, State& state,
           InstructionCounter* counter, const PressListener& listen);

}  // namespace palpate
