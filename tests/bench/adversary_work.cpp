// Plays the adversary in one baked scene for callgrind and counts the ticks that its work makes dear: what they counted
// of themselves is printed beside, stage by stage, and adversary_work.sh holds one against the other. Of other ticks
// only what the chosen ones begin with is kept.
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
#include "tests/support/work_text.h"

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
  std::printf(" units%s\n", work_text(work).c_str());
}

// What a tick begins with.
struct Begin {
  int tick;
  StatePtr state;
  Input input;
};

// Plays the adversary, always the same: begins(tick, state, input) before every tick, ends(work) after it.
template <class Begins, class Ends>
void play(const Model& model, std::uint64_t seed, int ticks, Begins&& begins, Ends&& ends) {
  const auto state = make_state(model);
  const auto scratch = make_scratch(model);
  reset(*state);
  Adversary adversary(model, seed);
  Output output;
  for (int t = 0; t < ticks; ++t) {
    bool forgets = false;
    const Input input = adversary.next(output, forgets);
    if (forgets) reset(*state);
    begins(t, *state, input);
    tick(model, *state, *scratch, input, output);
    ends(scratch->work);
  }
}

// The dearest ticks of each stage and of all together, and some between.
std::vector<Begin> choose(const Model& model, std::uint64_t seed, int ticks, int counted) {
  TickPrices prices;
  play(
      model, seed, ticks, [](int, const State&, const Input&) {}, [&](const Work& work) { prices.add(work); });
  std::vector<bool> chosen(static_cast<std::size_t>(ticks), false);
  prices.choose_dearest(static_cast<std::size_t>(counted / (kStageCount + 1)), chosen);
  for (int k = 1; k < counted; ++k)
    chosen[static_cast<std::size_t>(static_cast<std::int64_t>(k) * ticks / counted)] = true;
  std::vector<Begin> begins;
  play(
      model, seed, ticks,
      [&](int t, const State& state, const Input& input) {
        if (chosen[static_cast<std::size_t>(t)]) begins.push_back({t, copy_of(state), input});
      },
      [](const Work&) {});
  return begins;
}

// Callgrind plays a hundred times slower where it counts, so no other tick is played there.
void count(const Model& model, const std::vector<Begin>& begins) {
  const auto scratch = make_scratch(model);
  CALLGRIND_START_INSTRUMENTATION;
  for (const Begin& begin : begins) {
    Output output;
    CALLGRIND_TOGGLE_COLLECT;
    tick(model, *begin.state, *scratch, begin.input, output);
    CALLGRIND_TOGGLE_COLLECT;
    char label[64];
    std::snprintf(label, sizeof(label), "tick %d contacts %d regions %d", begin.tick, output.contacts, output.regions);
    CALLGRIND_DUMP_STATS_AT(label);
    print(begin.tick, scratch->work);
  }
}

void play_and_count(const char* path, int ticks, int counted, std::uint64_t seed) {
  const ImageFile image(path);
  const Model& model = image.model();
  for (int i = 0; i < kStageCount; ++i)
    std::printf("bound %s %.0f\n", kStageFunctions[i], model.stage_cost[static_cast<std::size_t>(i)].instructions);
  count(model, choose(model, seed, ticks, counted));
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: adversary_work IMAGE TICKS COUNTED [SEED]\n");
    return 2;
  }
  try {
    palpate::test::play_and_count(argv[1], std::atoi(argv[2]), std::atoi(argv[3]),
                                  argc > 4 ? static_cast<std::uint64_t>(std::atoll(argv[4])) : 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "adversary_work: %s\n", error.what());
    return 2;
  }
  return 0;
}
