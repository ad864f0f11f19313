// Plays the scripted hand in baked scenes, its second half with a device later than stated, its last quarter with live
// settings, and prints one hash of all outputs per scene: what effect.sh compares.
// Usage: output_hash IMAGE...
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>

#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/support/image_file.h"
#include "tests/support/output_hash.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

std::uint64_t play(const Model& model) {
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  Output output;
  ScriptedHand hand(model);
  OutputHash hash;
  for (int i = 0; i < kScriptTicks; ++i) {
    Input input = hand.next(output);
    if (i >= kScriptTicks / 2) input.command_lag = 2;  // a device later than it is stated to be
    if (i >= 3 * kScriptTicks / 4) input.live.stiffness = input.live.friction = 0.5F;
    tick(model, *state, *scratch, input, output);
    add(output, hash);
  }
  return hash.value();
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  try {
    for (int i = 1; i < argc; ++i) {
      const palpate::test::ImageFile image(argv[i]);
      std::printf("%s %016llx\n", image.model().name,
                  static_cast<unsigned long long>(palpate::test::play(image.model())));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "output_hash: %s\n", error.what());
    return 2;
  }
  return argc > 1 ? 0 : 2;
}
