// The scripted hand in one baked scene, for programs under which something counts each tick's instructions.
#pragma once

#include <cstdio>
#include <exception>

#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {

// Calls opened(model) once, then begins(i) right before each tick and ends(i, output, its work) right after it.
template <class Opened, class Begins, class Ends>
void play_counted(const char* path, Opened opened, Begins begins, Ends ends) {
  const ImageFile image(path);
  const Model& model = image.model();
  const auto state = make_state(model);
  const auto scratch = make_scratch(model);
  reset(*state);
  Output output;
  opened(model);
  ScriptedHand hand(model);
  for (int i = 0; i < kScriptTicks; ++i) {
    const Input input = hand.next(output);
    begins(i);
    tick(model, *state, *scratch, input, output);
    ends(i, output, scratch->work);
  }
}

// The main function of a program that takes one image: 2 and why where it cannot be played.
template <class Play>
int main_of_image(const char* program, int argc, char** argv, Play play) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s IMAGE\n", program);
    return 2;
  }
  try {
    play(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 2;
  }
  return 0;
}

}  // namespace palpate::test
