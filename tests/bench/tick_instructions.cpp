// Plays the scripted hand in one baked scene for callgrind: each tick is counted alone and dumped alone, so that the
// worst of them can be named. tick_instructions.sh runs it and judges the figures.
// Usage: valgrind --tool=callgrind --collect-atstart=no ... tick_instructions IMAGE
#include <valgrind/callgrind.h>

#include <cstdio>
#include <exception>
#include <memory>

#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

void play(const char* path) {
  const ImageFile image(path);
  const Model& model = image.model();
  const auto state = make_state(model);
  const auto scratch = make_scratch(model);
  reset(*state);
  Output output;
#define PALPATE_STAGE(name, function, shown, what) \
  std::printf("bound %s %.0f\n", #function, model.stage_cost[static_cast<int>(Stage::name)].instructions);
  PALPATE_STAGES(PALPATE_STAGE)
#undef PALPATE_STAGE
  ScriptedHand hand(model);
  for (int i = 0; i < kScriptTicks; ++i) {
    const Input input = hand.next(output);
    CALLGRIND_TOGGLE_COLLECT;
    tick(model, *state, *scratch, input, output);
    CALLGRIND_TOGGLE_COLLECT;
    char label[64];
    std::snprintf(label, sizeof(label), "tick %d contacts %d regions %d", i, output.contacts, output.regions);
    CALLGRIND_DUMP_STATS_AT(label);
  }
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: tick_instructions IMAGE\n");
    return 2;
  }
  try {
    palpate::test::play(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tick_instructions: %s\n", error.what());
    return 2;
  }
  return 0;
}
