// Plays the scripted hand in one baked scene for callgrind: ticks are counted alone and dumped alone, so that the worst
// of them can be named. First it plays without counting: the dearest ticks by the work they counted of themselves, no
// price of which is too low (budget.work), and every fortieth are counted in the second play, which does the same. With
// `all`, every tick is. tick_instructions.sh runs it and judges the figures. Usage: valgrind --tool=callgrind
// --collect-atstart=no ... tick_instructions IMAGE [all]
#include <valgrind/callgrind.h>

#include <cstring>

#include "tests/bench/dearest_ticks.h"
#include "tests/support/counted_run.h"

namespace palpate::test {
namespace {

void print_bounds(const Model& model) {
#define PALPATE_STAGE(name, function, shown, what) \
  std::printf("bound %s %.0f\n", #function, model.stage_cost[static_cast<int>(Stage::name)].instructions);
  PALPATE_STAGES(PALPATE_STAGE)
#undef PALPATE_STAGE
}

std::vector<bool> dearest(const char* path) {
  TickPrices prices;
  play_counted(
      path, [](const Model&) {}, [](int) {}, [&](int, const Output&, const Work& work) { prices.add(work); });
  std::vector<bool> chosen(kScriptTicks, false);
  prices.choose_dearest(kDearest, chosen);
  return chosen;
}

void play(const char* path, bool all) {
  const std::vector<bool> dear = all ? std::vector<bool>(kScriptTicks, false) : dearest(path);
  const auto sampled = [&](int i) { return all || is_sampled(i); };
  const auto counts = [&](int i) { return sampled(i) || dear[static_cast<std::size_t>(i)]; };
  play_counted(
      path,
      [](const Model& model) {
        print_bounds(model);
        CALLGRIND_START_INSTRUMENTATION;
      },
      [&](int i) {
        if (counts(i)) CALLGRIND_TOGGLE_COLLECT;
      },
      [&](int i, const Output& output, const Work&) {
        if (!counts(i)) return;
        CALLGRIND_TOGGLE_COLLECT;
        char label[64];
        std::snprintf(label, sizeof(label), "tick %d contacts %d regions %d%s", i, output.contacts, output.regions,
                      sampled(i) ? "" : " chosen");
        CALLGRIND_DUMP_STATS_AT(label);
      });
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  const bool all = argc == 3 && std::strcmp(argv[2], "all") == 0;
  return palpate::test::main_of_image("tick_instructions", all ? 2 : argc, argv,
                                      [=](const char* path) { palpate::test::play(path, all); });
}
