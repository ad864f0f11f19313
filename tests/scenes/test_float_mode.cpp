// What the caller's floating point is set to changes no bit of a tick, and is as it was afterwards.
#include <gtest/gtest.h>

#include <immintrin.h>

#include "rt_core/float_mode.h"
#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/scenes/scene_names.h"
#include "tests/support/image_file.h"
#include "tests/support/output_hash.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

constexpr unsigned kMasks = 0x1f80, kRoundUp = 0x4000, kTowardsZero = 0x6000, kFlags = 0x3f;

std::uint64_t forces_under(const Model& model, unsigned mode) {
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  Output output;
  ScriptedHand hand(model);
  OutputHash hash;
  for (int i = 0; i < 3000; ++i) {
    const Input input = hand.next(output);
    const unsigned before = _mm_getcsr();
    _mm_setcsr(mode);
    tick(model, *state, *scratch, input, output);
    const unsigned after = _mm_getcsr();
    _mm_setcsr(before);
    EXPECT_EQ(after & ~kFlags, mode & ~kFlags);
    add(output, hash);
  }
  return hash.value();
}

TEST(FloatMode, OfTheCallerChangesNoBit) {
  for (const std::string& scene : scene_names()) {
    const ImageFile image(std::string(PALPATE_IMAGE_DIR) + "/" + scene + ".pal");
    const std::uint64_t usual = forces_under(image.model(), kMasks);
    for (const unsigned mode : {kMasks | kRoundUp, kMasks | kTowardsZero, TickFloatMode::kMode})
      EXPECT_EQ(forces_under(image.model(), mode), usual) << scene << " in mode " << mode;
  }
}

// The guard itself: below the normal range there is nothing, inside it and only there.
TEST(FloatMode, FlushesWhatIsBelowTheNormalRange) {
  volatile double least = 1e-308, half = 0.5, subnormal = 0;
  {
    const TickFloatMode mode;
    subnormal = least * half * half;
    EXPECT_EQ(subnormal, 0);
  }
  EXPECT_GT(least * half * half, 0);
}

}  // namespace
}  // namespace palpate::test
