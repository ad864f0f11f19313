// Plays the scripted hand in baked scenes and prints, per scene, one line that must be the same from every compiler and
// optimisation level: scene, ticks, and a hash over every tick's state hash and output. Also checks, within one build,
// that a copy of the state continues with the same bits and that stale memory has no influence.
// Usage: state_hash IMAGE...   Exit status 1 when a check within the build fails.
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <string>

#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

// All that a run leaves behind, in memory filled with `poison` before it is laid out and reset.
struct Memory {
  Memory(const Model& model, int poison) : state(nullptr), scratch(nullptr) {
    void* block = new_block(state_bytes(model));
    std::memset(block, poison, state_bytes(model));
    state = StatePtr(&create_state(model, block));
    block = new_block(scratch_bytes(model));
    std::memset(block, poison, scratch_bytes(model));
    scratch = ScratchPtr(&create_scratch(model, block));
  }
  StatePtr state;
  ScratchPtr scratch;
  Output output;
};

std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9E3779B97F4A7C15ull;
  return hash ^ (hash >> 29);
}

template <class T>
std::uint64_t mix_words(std::uint64_t hash, const T& value) {
  static_assert(sizeof(T) == 4 || sizeof(T) % 8 == 0, "no padding may get in");
  std::uint64_t word[(sizeof(T) + 7) / 8] = {};
  std::memcpy(word, &value, sizeof(T));
  for (const std::uint64_t w : word) hash = mix(hash, w);
  return hash;
}

// Everything the host or the device sees of a tick.
std::uint64_t hash_output(std::uint64_t hash, const Output& o) {
#define PALPATE_FIELD(type, name, stage, meaning) hash = mix_words(hash, o.name);
  PALPATE_OUTPUT_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return hash;
}

struct Summary {
  std::uint64_t hash = 0;
  int ticks_in_contact = 0;
  int most_regions = 0;
};

// One run of the script. From `swap_tick` on, the run goes on in `other`.
Summary play(const Model& model, Memory&& memory, int swap_tick = -1, Memory* other = nullptr) {
  Summary summary;
  ScriptedHand hand(model);
  Memory* now = &memory;
  for (int i = 0; i < kScriptTicks; ++i) {
    if (i == swap_tick) {
      copy_state(*memory.state, *other->state);
      other->output = memory.output;
      now = other;
    }
    const Input input = hand.next(now->output);
    tick(model, *now->state, *now->scratch, input, now->output);
    summary.hash = hash_output(mix(summary.hash, hash_state(*now->state)), now->output);
    summary.ticks_in_contact += now->output.contacts > 0 ? 1 : 0;
    if (now->output.regions > summary.most_regions) summary.most_regions = now->output.regions;
  }
  return summary;
}

bool run_scene(const std::string& path) {
  const ImageFile image(path);
  const Model& model = image.model();
  const Summary first = play(model, Memory(model, 0x00));
  std::printf("%s %d %016llx %d %d\n", model.name, kScriptTicks, static_cast<unsigned long long>(first.hash),
              first.ticks_in_contact, first.most_regions);
  const Summary poisoned = play(model, Memory(model, 0xA5));
  if (poisoned.hash != first.hash) std::fprintf(stderr, "%s: memory left from before the reset matters\n", model.name);
  Memory other(model, 0x5A);
  const Summary moved = play(model, Memory(model, 0x00), kScriptTicks / 2, &other);
  if (moved.hash != first.hash) std::fprintf(stderr, "%s: a copied state does not continue alike\n", model.name);
  return poisoned.hash == first.hash && moved.hash == first.hash;
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: state_hash IMAGE...\n");
    return 2;
  }
  bool alike = true;
  try {
    for (int i = 1; i < argc; ++i) alike = palpate::test::run_scene(argv[i]) && alike;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "state_hash: %s\n", error.what());
    return 2;
  }
  return alike ? 0 : 1;
}
