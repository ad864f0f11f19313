// What the caller's floating point is set to changes no bit of a tick, and is as it was afterwards.
#include <gtest/gtest.h>

#include "rt_core/float_mode.h"
#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/scenes/scene_names.h"
#include "tests/support/image_file.h"
#include "tests/support/output_hash.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

#if defined(__x86_64__)
constexpr FloatMode kUsual = 0x1f80, kRoundUp = 0x4000, kTowardsZero = 0x6000, kFlags = 0x3f;
constexpr bool kFlushesAfterRounding = true;
#else
constexpr FloatMode kUsual = 0, kRoundUp = 1u << 22, kTowardsZero = 3u << 22, kFlags = 0;
constexpr bool kFlushesAfterRounding = false;
#endif

std::uint64_t forces_under(const Model& model, FloatMode mode) {
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  Output output;
  ScriptedHand hand(model);
  OutputHash hash;
  for (int i = 0; i < 3000; ++i) {
    const Input input = hand.next(output);
    const FloatMode before = float_mode();
    set_float_mode(mode);
    tick(model, *state, *scratch, input, output);
    const FloatMode after = float_mode();
    set_float_mode(before);
    EXPECT_EQ(after & ~kFlags, mode & ~kFlags);
    add(output, hash);
  }
  return hash.value();
}

TEST(FloatMode, OfTheCallerChangesNoBit) {
  for (const std::string& scene : scene_names()) {
    const ImageFile image(std::string(PALPATE_IMAGE_DIR) + "/" + scene + ".pal");
    const std::uint64_t usual = forces_under(image.model(), kUsual);
    for (const FloatMode mode : {kUsual | kRoundUp, kUsual | kTowardsZero, TickFloatMode::kMode})
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

// Operands as well: a number below the normal range, times 2^60, is nothing inside.
TEST(FloatMode, FlushesOperands) {
  volatile double subnormal = 0x1p-1030, large = 0x1p60;
  volatile float subnormal_single = 0x1p-130f;
  {
    const TickFloatMode mode;
    EXPECT_EQ(subnormal * large, 0);
    EXPECT_EQ(subnormal + subnormal, 0);
    EXPECT_FALSE(subnormal > 0);
    EXPECT_EQ(static_cast<double>(subnormal_single), 0);
  }
  EXPECT_EQ(subnormal * large, 0x1p-970);
}

// The one case in which the processors differ (docs/determinism.md): a result that only rounding brings into the normal
// range. Intel's manual, volume 1, 11.5.2.3 and 4.9.1.5 (after rounding); Arm's, FPCR.FZ (before rounding).
// (1 + 2^-52)(1 - 2^-52) = 1 - 2^-104 is below 1 by far less than half a unit in its last place.
TEST(FloatMode, WhatRoundingBringsIntoTheNormalRange) {
  volatile double above = 0x1.0000000000001p-511, below = 0x1.ffffffffffffep-512;
  volatile float above_single = 0x1.000002p-63f, below_single = 0x1.fffffcp-64f;
  const TickFloatMode mode;
  EXPECT_EQ(above * below, kFlushesAfterRounding ? 0x1p-1022 : 0);
  EXPECT_EQ(above_single * below_single, kFlushesAfterRounding ? 0x1p-126f : 0);
}

}  // namespace
}  // namespace palpate::test
