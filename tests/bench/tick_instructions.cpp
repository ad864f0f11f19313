// Plays the scripted hand in one baked scene for callgrind: each tick is counted alone and dumped alone, so that the
// worst of them can be named. tick_instructions.sh runs it and judges the figures.
// Usage: valgrind --tool=callgrind --collect-atstart=no ... tick_instructions IMAGE
#include <valgrind/callgrind.h>

#include "tests/support/counted_run.h"

namespace palpate::test {
namespace {

void print_bounds(const Model& model) {
#define PALPATE_STAGE(name, function, shown, what) \
  std::printf("bound %s %.0f\n", #function, model.stage_cost[static_cast<int>(Stage::name)].instructions);
  PALPATE_STAGES(PALPATE_STAGE)
#undef PALPATE_STAGE
}

void play(const char* path) {
  play_counted(
      path, print_bounds, [] { CALLGRIND_TOGGLE_COLLECT; },
      [](int i, const Output& output) {
        CALLGRIND_TOGGLE_COLLECT;
        char label[64];
        std::snprintf(label, sizeof(label), "tick %d contacts %d regions %d", i, output.contacts, output.regions);
        CALLGRIND_DUMP_STATS_AT(label);
      });
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  return palpate::test::main_of_image("tick_instructions", argc, argv, palpate::test::play);
}
