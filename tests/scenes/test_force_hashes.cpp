// The forces of every shipped scene, as bits: forces.txt holds a hash of each image and of all that the scripted hand
// gets from it in eight seconds. A change of one bit anywhere in the baker or in the tick fails here, so that none is
// silent.
#include <gtest/gtest.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/scenes/scene_names.h"
#include "tests/support/image_file.h"
#include "tests/support/output_hash.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

constexpr char kFile[] = PALPATE_SOURCE_DIR "/tests/scenes/forces.txt";
constexpr char kHead[] =
    "# scene, hash of its image, hash of the outputs of 8000 scripted ticks: tests/scenes/test_force_hashes.cpp.\n"
    "# Renew after a change that is meant, and name its cause in CHANGELOG.md:\n"
    "#   PALPATE_WRITE_HASHES=1 build/release/tests/scenes/test_scenes --gtest_filter='ForceHashes*'\n";

struct Hashes {
  std::string image, forces;
  bool operator==(const Hashes&) const = default;
};
using Table = std::map<std::string, Hashes>;

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, value);
  return text;
}

Hashes hashes_of(const std::string& scene) {
  const ImageFile image(std::string(PALPATE_IMAGE_DIR) + "/" + scene + ".pal");
  const StatePtr state = make_state(image.model());
  const ScratchPtr scratch = make_scratch(image.model());
  Output output;
  ScriptedHand hand(image.model());
  OutputHash hash;
  for (int i = 0; i < kScriptTicks; ++i) {
    tick(image.model(), *state, *scratch, hand.next(output), output);
    add(output, hash);
  }
  return {hex(image.model().scene_hash), hex(hash.value())};
}

Table stored() {
  Table table;
  std::ifstream file(kFile);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string scene;
    Hashes hashes;
    if (line.starts_with("#") || !(words >> scene >> hashes.image >> hashes.forces)) continue;
    table[scene] = hashes;
  }
  return table;
}

TEST(ForceHashes, OfEveryShippedSceneAreAsStored) {
  Table now;
  for (const std::string& scene : scene_names()) now[scene] = hashes_of(scene);
  if (std::getenv("PALPATE_WRITE_HASHES") != nullptr) {
    std::ofstream file(kFile);
    file << kHead;
    for (const auto& [scene, hashes] : now) file << scene << ' ' << hashes.image << ' ' << hashes.forces << '\n';
  }
  const Table before = stored();
  EXPECT_EQ(before.size(), now.size()) << "a scene came or went: renew " << kFile << " as its head says";
  for (const auto& [scene, hashes] : now) {
    const auto found = before.find(scene);
    ASSERT_NE(found, before.end()) << scene << " is not in " << kFile << "; its head says how to renew it";
    EXPECT_TRUE(hashes == found->second)
        << scene << ": "
        << (hashes.image != found->second.image ? "the baker makes another image" : "the image is the same")
        << (hashes.forces != found->second.forces ? ", its forces differ" : ", its forces are the same")
        << ". If that is meant, renew tests/scenes/forces.txt as its head says and name the cause in CHANGELOG.md";
  }
}

}  // namespace
}  // namespace palpate::test
