// The public entry of the real-time core.
#pragma once

#include "rt_core/stages.h"

namespace palpate {

// Renders one period. Deterministic: the same model, state and input give the same bits in state and output.
// Bounded, allocation-free, lock-free. `output` is completely overwritten. Safe for every input, NaN included.
void tick(const Model& model, State& state, Scratch& scratch, const Input& input, Output& output,
          const StageProbe& probe = {}) PALPATE_RT;

}  // namespace palpate
