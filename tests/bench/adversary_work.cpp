// Plays the adversary in one baked scene for callgrind and counts the ticks that its work makes dear: what they counted
// of themselves is printed beside, stage by stage, and adversary_work.sh holds one against the other.
// Usage: valgrind --tool=callgrind --instr-atstart=no --collect-atstart=no ... adversary_work IMAGE TICKS COUNTED
// [SEED]
#include <valgrind/callgrind.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "config/bake/adversary.h"
#include "rt_core/stage_cost.h"
#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/bench/dearest_ticks.h"
#include "tests/support/image_file.h"

namespace palpate::test {
namespace {

const char* const kStageFunctions[] = {
#define PALPATE_STAGE(name, function, shown, what) #function,
    PALPATE_STAGES(PALPATE_STAGE)
#undef PALPATE_STAGE
};

void print(int tick, const Work& work) {
  std::printf("work %d", tick);
  for (int i = 0; i < kStageCount; ++i)
    std::printf(" %s %.0f", kStageFunctions[i], counted_instructions(work, static_cast<Stage>(i)));
  std::printf(" units");
#define PALPATE_UNIT(unit, stage, price, what) \
  if (work.unit != 0) std::printf(" %s %d", #unit, work.unit);
  PALPATE_WORK_UNITS(PALPATE_UNIT)
#undef PALPATE_UNIT
  std::printf("\n");
}

// The dearest ticks of each stage and of all together, and some between.
std::vector<bool> choose(const Model& model, std::uint64_t seed, int ticks, int counted) {
  TickPrices prices;
  const auto state = make_state(model);
  const auto scratch = make_scratch(model);
  reset(*state);
  Adversary adversary(model, seed);
  Output output;
  for (int t = 0; t < ticks; ++t) {
    bool forgets = false;
    const Input input = adversary.next(output, forgets);
    if (forgets) reset(*state);
    tick(model, *state, *scratch, input, output);
    prices.add(scratch->work);
  }
  std::vector<bool> chosen(static_cast<std::size_t>(ticks), false);
  prices.choose_dearest(static_cast<std::size_t>(counted / (kStageCount + 1)), chosen);
  for (int k = 1; k < counted; ++k)
    chosen[static_cast<std::size_t>(static_cast<std::int64_t>(k) * ticks / counted)] = true;
  return chosen;
}

void play(const char* path, int ticks, int counted, std::uint64_t seed) {
  const ImageFile image(path);
  const Model& model = image.model();
  const std::vector<bool> chosen = choose(model, seed, ticks, counted);
  const auto state = make_state(model);
  const auto scratch = make_scratch(model);
  reset(*state);
  Adversary adversary(model, seed);
  Output output;
  for (int i = 0; i < kStageCount; ++i)
    std::printf("bound %s %.0f\n", kStageFunctions[i], model.stage_cost[static_cast<std::size_t>(i)].instructions);
  CALLGRIND_START_INSTRUMENTATION;
  for (int t = 0; t < ticks; ++t) {
    bool forgets = false;
    const Input input = adversary.next(output, forgets);
    if (forgets) reset(*state);
    const bool counts = chosen[static_cast<std::size_t>(t)];
    if (counts) CALLGRIND_TOGGLE_COLLECT;
    tick(model, *state, *scratch, input, output);
    if (!counts) continue;
    CALLGRIND_TOGGLE_COLLECT;
    char label[64];
    std::snprintf(label, sizeof(label), "tick %d contacts %d regions %d", t, output.contacts, output.regions);
    CALLGRIND_DUMP_STATS_AT(label);
    print(t, scratch->work);
  }
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: adversary_work IMAGE TICKS COUNTED [SEED]\n");
    return 2;
  }
  try {
    palpate::test::play(argv[1], std::atoi(argv[2]), std::atoi(argv[3]),
                        argc > 4 ? static_cast<std::uint64_t>(std::atoll(argv[4])) : 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "adversary_work: %s\n", error.what());
    return 2;
  }
  return 0;
}
