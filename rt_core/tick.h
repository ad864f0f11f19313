// The public entry of the real-time core.
#pragma once

#include "rt_core/stages.h"

namespace palpate {

// Called after each stage, when given: the HAL takes a time stamp there. rt_core itself never reads a clock.
struct StageProbe {
  void (*mark)(void* context, Stage stage) PALPATE_RT = nullptr;
  void* context = nullptr;
};

// Renders one period. Deterministic: the same model, state and input give the same bits in state and output.
// Bounded, allocation-free, lock-free. `output` is completely overwritten. Safe for every input, NaN included.
void tick(const Model& model, State& state, Scratch& scratch, const Input& input, Output& output,
          const StageProbe& probe = {}) PALPATE_RT;

}  // namespace palpate
