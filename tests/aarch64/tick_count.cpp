// Plays the scripted hand in one baked scene, each tick between two system calls that do nothing, for count_plugin.c.
// Usage: qemu-aarch64 -plugin COUNT_PLUGIN.so tick_count IMAGE
#include <unistd.h>

#include "tests/support/counted_run.h"

namespace palpate::test {
namespace {

void play(const char* path) {
  const auto mark = [](auto&&...) { static_cast<void>(getppid()); };
  play_counted(
      path, [](const Model&) {}, mark, mark);
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) { return palpate::test::main_of_image("tick_count", argc, argv, palpate::test::play); }
