// The run of the tiny scene that tests of recordings play: the tool comes down on the tetrahedron's face, slides and
// leaves.
#pragma once

#include <cmath>
#include <cstdint>

#include "rt_core/record.h"
#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"

namespace palpate::test {

// Input of tick `i` of `ticks`; armed from the seventh tick on.
inline Input tiny_run_input(std::uint64_t i, std::uint64_t ticks) {
  Input input;
  const double phase = static_cast<double>(i) / static_cast<double>(ticks);
  input.pose_w.position_m = {0.02 * phase, 0.01 * phase, 0.06 - 0.05 * std::sin(3.14159 * phase)};
  input.commands = i > 5 ? Command::kArm : 0;
  return input;
}

// Plays it from `state` on and hands out the record of every tick.
template <class Each>
void play_tiny_run(const Model& model, State& state, std::uint64_t ticks, const Each& each) {
  const ScratchPtr scratch = make_scratch(model);
  for (std::uint64_t i = 0; i < ticks; ++i) {
    const Input input = tiny_run_input(i, ticks);
    Output output;
    tick(model, state, *scratch, input, output);
    TickRecord record{};
    fill_record(state, input, output, record);
    record.sequence = i + 1;
    each(record);
  }
}

}  // namespace palpate::test
