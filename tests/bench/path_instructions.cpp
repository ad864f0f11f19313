// Plays a scene's own path for callgrind, the one that `palpate run` and the laboratory follow: simulated hand and
// device, wire, control loop, ticks counted alone like those of tick_instructions.cpp.
// Usage: valgrind --tool=callgrind --instr-atstart=no --collect-atstart=no ... path_instructions IMAGE SCENE.toml
#include <valgrind/callgrind.h>

#include <atomic>
#include <cstdio>
#include <exception>
#include <memory>

#include "hal/loop/loop.h"
#include "sim_host/tick_memory.h"
#include "tests/bench/dearest_ticks.h"
#include "tests/support/image_file.h"
#include "tests/support/scene_hand.h"

namespace palpate::test {
namespace {

// Plays the first time to see what ticks cost by their work, the second time to have the dearest and a sample counted.
class CountedController {
 public:
  CountedController(const Model& model, TickPrices& prices, const std::vector<bool>* dear)
      : model_(model), prices_(prices), dear_(dear) {}
  void step(const Input& input, Output& output, const StageProbe&) {
    const bool sampled = is_sampled(ticks_);
    const bool counts = dear_ && (sampled || (*dear_)[static_cast<std::size_t>(ticks_)]);
    if (counts) CALLGRIND_TOGGLE_COLLECT;
    tick(model_, *state_, *scratch_, input, output);
    if (counts) dump(output, sampled);
    if (!dear_) prices_.add(scratch_->work);
    ticks_ += 1;
  }
  void fill(const Input&, const Output&, TickRecord&) {}

 private:
  void dump(const Output& output, bool sampled) const {
    CALLGRIND_TOGGLE_COLLECT;
    char label[96];
    std::snprintf(label, sizeof(label), "tick %d contacts %d regions %d%s", ticks_, output.contacts, output.regions,
                  sampled ? "" : " chosen");
    CALLGRIND_DUMP_STATS_AT(label);
  }

  const Model& model_;
  TickPrices& prices_;
  const std::vector<bool>* dear_;  // none: the first time
  StatePtr state_ = make_state(model_);
  ScratchPtr scratch_ = make_scratch(model_);
  int ticks_ = 0;
};

void play_once(const Model& model, const SceneDesc& scene, std::uint64_t ticks, TickPrices& prices,
               const std::vector<bool>* dear) {
  VirtualClock clock;
  SceneHand hand(scene, clock);
  CountedController controller(model, prices, dear);
  NoSink sink;
  ArmedHost host;
  const std::atomic<bool> stop{false};
  LoopOptions options;
  options.ticks = ticks;
  Loop(hand, clock, controller, sink, host, CartesianKinematics{}, options, stop).run();
}

void play(const char* image_path, const char* scene_path) {
  const ImageFile image(image_path);
  const SceneDesc scene = load_scene(scene_path);
  const auto ticks = static_cast<std::uint64_t>(scene.path.point.back().time_s / scene.device.period_s);
  TickPrices prices;
  play_once(image.model(), scene, ticks, prices, nullptr);
  std::vector<bool> dear(ticks, false);
  prices.choose_dearest(kDearest, dear);
  CALLGRIND_START_INSTRUMENTATION;
  play_once(image.model(), scene, ticks, prices, &dear);
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: path_instructions IMAGE SCENE.toml\n");
    return 2;
  }
  try {
    palpate::test::play(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "path_instructions: %s\n", error.what());
    return 2;
  }
  return 0;
}
