// Plays a scene's own path for callgrind, the one that `palpate run` and the laboratory follow: simulated hand and
// device, wire, control loop, every tick counted alone like those of tick_instructions.cpp.
// Usage: valgrind --tool=callgrind --collect-atstart=no ... path_instructions IMAGE SCENE.toml
#include <valgrind/callgrind.h>

#include <atomic>
#include <cstdio>
#include <exception>
#include <memory>

#include "hal/loop/loop.h"
#include "sim_host/tick_memory.h"
#include "tests/support/image_file.h"
#include "tests/support/scene_hand.h"

namespace palpate::test {
namespace {

class CountedController {
 public:
  explicit CountedController(const Model& model) : model_(model) {}
  void step(const Input& input, Output& output, const StageProbe&) {
    CALLGRIND_TOGGLE_COLLECT;
    tick(model_, *state_, *scratch_, input, output);
    CALLGRIND_TOGGLE_COLLECT;
    char label[96];
    std::snprintf(label, sizeof(label), "tick %d contacts %d regions %d", ticks_, output.contacts, output.regions);
    CALLGRIND_DUMP_STATS_AT(label);
    ticks_ += 1;
  }
  void fill(const Input&, const Output&, TickRecord&) {}

 private:
  const Model& model_;
  StatePtr state_ = make_state(model_);
  ScratchPtr scratch_ = make_scratch(model_);
  int ticks_ = 0;
};

void play(const char* image_path, const char* scene_path) {
  const ImageFile image(image_path);
  const SceneDesc scene = load_scene(scene_path);
  VirtualClock clock;
  SceneHand hand(scene, clock);
  CountedController controller(image.model());
  NoSink sink;
  ArmedHost host;
  const std::atomic<bool> stop{false};
  LoopOptions options;
  options.ticks = static_cast<std::uint64_t>(scene.path.point.back().time_s / scene.device.period_s);
  Loop(hand, clock, controller, sink, host, CartesianKinematics{}, options, stop).run();
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
