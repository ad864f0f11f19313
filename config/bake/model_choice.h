// error_target: of the models that a scene leaves open, the cheapest one whose presses meet the target within the
// tick's budget. The presses are the elastic body's check presses (elastic_check.h); each model presses the same ball
// at the same places by ticks.
#pragma once

#include <span>

#include "config/bake/compile.h"

namespace palpate {

struct ModelCandidate {
  const char* name;
  const char* what;
  const char* leaves_out;
  void (*choose)(SceneDesc& scene);  // makes the scene state it
};
// Cheaper than the elastic body, from cheap to dear.
std::span<const ModelCandidate> cheaper_models();

CompileResult choose_model(const SceneDesc& scene, const BakeRun& run);

}  // namespace palpate
