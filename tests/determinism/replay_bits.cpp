// Replays recordings and compares every tick, bit for bit, as `palpate replay` does, in a program small enough for
// every compiler of matrix.sh. Usage: replay_bits RECORDING.plr...   each beside its image, RECORDING.pal. Exit status
// 1 when one differs.
#include <cstdio>
#include <exception>
#include <string>

#include "sim_host/record/mapped_file.h"
#include "sim_host/record/replay.h"
#include "tests/support/image_file.h"

namespace palpate::test {
namespace {

bool replays(const std::string& path) {
  const ImageFile image(path.substr(0, path.rfind('.')) + ".pal");
  const MappedFile file(path);
  RecordingReader recording(file.bytes());
  const ReplayResult result = replay(recording, image.model());
  if (result.identical() && result.ticks > 0) {
    std::printf("%s replays, %llu ticks\n", image.model().name, static_cast<unsigned long long>(result.ticks));
    return true;
  }
  std::printf("%s does not replay: tick %llu, %s %s: recorded %s, replayed %s; %llu ticks lost %s\n",
              image.model().name, static_cast<unsigned long long>(result.tick), result.stage.c_str(),
              result.field.c_str(), result.recorded.c_str(), result.replayed.c_str(),
              static_cast<unsigned long long>(result.lost), result.damage.c_str());
  return false;
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: replay_bits RECORDING.plr...\n");
    return 2;
  }
  bool alike = true;
  try {
    for (int i = 1; i < argc; ++i) alike = palpate::test::replays(argv[i]) && alike;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "replay_bits: %s\n", error.what());
    return 2;
  }
  return alike ? 0 : 1;
}
