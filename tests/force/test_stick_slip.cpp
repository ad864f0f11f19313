// Breaking loose is one event of a slide, whatever the sampling of hand and encoder.
#include <gtest/gtest.h>

#include <cmath>

#include "rt_core/contact/friction.h"

namespace palpate {
namespace {

// Static limit 4 N and sliding force 2.5 N under 5 N, and a spring that breaks loose after half a millimetre or so.
FrictionParameters parameters(FrictionLaw law) {
  FrictionParameters p;
  p.law = law;
  p.k_N = 0.8 * std::pow(5.0, 0.25);
  p.beta = 0.75;
  p.mu_dynamic = 0.5;
  p.mindlin_ratio = 0.7;
  p.contact = {8000, 0, kHuge};
  return p;
}

// Drops by more than 5 % of the sliding force while a hand slides 30 mm at 20 mm/s.
int drops(FrictionLaw law, Real period_s, Real encoder_m) {
  const FrictionParameters p = parameters(law);
  FrictionMemory memory;
  FrictionLoad load;
  load.normal_w = {0, 0, 1};
  load.force_N = 5;
  load.depth_m = 5.0 / 8000;
  load.tangent_N_per_m = 8000;
  Real read = 0, force = 0;
  int count = 0;
  for (int i = 0; i * period_s * 0.02 < 0.03; ++i) {
    const Real hand = 0.02 * i * period_s, now = encoder_m > 0 ? encoder_m * std::floor(hand / encoder_m) : hand;
    load.step_w = {now - read, 0, 0};
    read = now;
    const Real next = norm(friction_step(p, load, memory).force_w);
    count += next < force - 0.05 * 2.5 ? 1 : 0;
    force = next;
  }
  return count;
}

TEST(StickSlip, HappensOnceHoweverHandAndEncoderAreSampled) {
  for (const FrictionLaw law : {FrictionLaw::kReturnMap, FrictionLaw::kMindlin})
    for (const Real period_s : {2.5e-4, 5e-4, 1e-3, 2e-3})
      for (const Real encoder_m : {0.0, 1e-5, 3e-5, 1e-4})
        EXPECT_EQ(drops(law, period_s, encoder_m), 1)
            << word_of(law) << ", " << 1e3 * period_s << " ms, " << 1e6 * encoder_m << " um";
}

// A real stop sticks: when the force has gone, and when the load has grown under a hand at rest.
TEST(StickSlip, ARestUnderMoreLoadOrLessForceSticks) {
  const FrictionParameters p = parameters(FrictionLaw::kReturnMap);
  FrictionLoad load;
  load.normal_w = {0, 0, 1};
  load.force_N = 5;
  const auto slide = [&](FrictionMemory& memory) {
    load.force_N = 5;
    for (int i = 0; i < 300; ++i) {
      load.step_w = {1e-5, 0, 0};
      friction_step(p, load, memory);
    }
    EXPECT_EQ(memory.mode, FrictionMode::kSlip);
  };
  FrictionMemory loaded, released;
  slide(loaded);
  load.step_w = {};
  load.force_N = 10;
  friction_step(p, load, loaded);
  EXPECT_EQ(loaded.mode, FrictionMode::kStick);
  slide(released);
  load.step_w = {-1e-4, 0, 0};  // 0.8 N back of 2.5
  friction_step(p, load, released);
  EXPECT_EQ(released.mode, FrictionMode::kStick);
}

}  // namespace
}  // namespace palpate
