// Work that driven fingers do on the object, from the forces of contact and the motion of the parts that carry them:
// independent of the tick's own account, which takes it from what object and tool receive (safety/hand_energy.h).
#pragma once

#include <vector>

#include "rt_core/state.h"

namespace palpate {

class FingerWork {
 public:
  FingerWork(const Model& model, const State& state, const Scratch& scratch);
  void add();  // after each tick
  double work_J() const { return work_J_; }

 private:
  const Model& model_;
  const State& state_;
  const Scratch& scratch_;
  std::vector<Wrench> load_tool_;  // on each piece, tool frame, about the tool's origin: at the last tick
  double work_J_ = 0;
};

}  // namespace palpate
