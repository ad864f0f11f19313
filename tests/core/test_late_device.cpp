// A device whose echo shows a longer delay than it was said to have: when that counts, and what the coupling is then.
#include <gtest/gtest.h>

#include <limits>

#include "rt_core/device_profile.h"
#include "rt_core/live_model.h"
#include "rt_core/safety/late_device.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

class Late : public testing::Test {
 protected:
  Late() : state_(roomy_state()) {
    model_.params = tiny_params();
    model_.params.period_s = 1e-3;
    model_.params.delay_s = 5e-4;
    state_->safety.mode = Mode::kForce;
  }
  void show(std::uint32_t lag, int samples) {
    Input input;
    input.command_lag = lag;
    for (int i = 0; i < samples; ++i) watch_delay(model_, input, *state_);
  }
  void press() { state_->safety.last_good_w.force_N = state_->safety.last_device_w.force_N = {0, 3, 0}; }
  // Stiffest spring for that delay over the stiffest for the stated one.
  double admitted(double delay_s) const {
    const auto bound = [&](double tau) {
      return admissible_stiffness(0.5, 0.05, 0, model_.params.period_s, tau).value;
    };
    return bound(delay_s) / bound(model_.params.delay_s);
  }
  Model model_;
  StatePtr state_;
};

TEST_F(Late, CountsWhenAWholeRowOfSamplesShowsIt) {
  show(3, kLateSamples - 1);
  show(0, 1);  // one that shows none: what came before was the bus
  show(3, kLateSamples - 1);
  EXPECT_EQ(state_->late.ticks, 0);
  EXPECT_EQ(state_->late.coupling, 1);
  show(5, 1);
  EXPECT_EQ(state_->late.ticks, 4);                           // all show 3: above 3 ms, below 4
  EXPECT_NEAR(state_->late.coupling, admitted(4e-3), 1e-12);  // at once: it renders nothing
}

TEST_F(Late, AStatedDelayIsNone) {
  show(0, 1000);
  model_.params.delay_s = 3e-3;
  show(3, 1000);
  model_.params.delay_s = 2.8e-3;  // measured to 0.15 ms
  show(3, 1000);
  EXPECT_EQ(state_->late.ticks, 0);
  EXPECT_EQ(state_->late.coupling, 1);
}

TEST_F(Late, MovesTheCouplingByLittleWhileAForceIsFelt) {
  press();
  show(3, kLateSamples);
  EXPECT_NEAR(state_->late.coupling, 1 - kLiveStep, 1e-12);
  EXPECT_EQ(state_->late.moves, 1);
  for (int i = 0; i < 1000; ++i) {
    const double before = state_->late.coupling;
    show(3, 1);
    EXPECT_LE(before - state_->late.coupling, kLiveStep * before * (1 + 1e-9));
  }
  EXPECT_NEAR(state_->late.coupling, admitted(4e-3), 1e-12);
  EXPECT_EQ(state_->late.moves, 0);
}

TEST_F(Late, HoldsForASecondOrUntilTheDeviceIsAtRest) {
  show(3, kLateSamples);
  for (int i = 0; i < 10; ++i) {  // through a phase and out of it
    show(0, kFineSamples - 1);
    show(3, 1);
  }
  EXPECT_EQ(state_->late.ticks, 4);
  show(0, kFineSamples - 1);
  EXPECT_EQ(state_->late.ticks, 4);
  press();
  show(0, 1);
  EXPECT_EQ(state_->late.ticks, 0);
  EXPECT_NEAR(state_->late.coupling, (1 + kLiveStep) * admitted(4e-3), 1e-12);  // back by little steps
  show(0, 1000);
  EXPECT_EQ(state_->late.coupling, 1);
  show(3, kLateSamples);
  EXPECT_EQ(state_->late.ticks, 4);
  show(7, kLateSamples);  // later still
  EXPECT_EQ(state_->late.ticks, 8);
  show(3, 2 * kLateSamples);
  EXPECT_EQ(state_->late.ticks, 8);
  state_->safety.mode = Mode::kIdle;
  show(0, 1);
  EXPECT_EQ(state_->late.ticks, 0);
  EXPECT_EQ(state_->late.coupling, 1);
}

TEST_F(Late, SoftensByTheBoundAndKeepsTheDamping) {
  show(2, kLateSamples);
  ModelParams soft = model_.params;
  soften(state_->late, soft);
  EXPECT_NEAR(soft.coupling_N_per_m, admitted(3e-3) * model_.params.coupling_N_per_m, 1e-9);
  EXPECT_NEAR(soft.coupling_Nm_per_rad, admitted(3e-3) * model_.params.coupling_Nm_per_rad, 1e-9);
  EXPECT_NEAR(soft.delay_s, 3e-3, 1e-15);
  // K (T / 2 + tau) of the one is that of the other.
  EXPECT_NEAR(soft.coupling_N_per_m * (0.5e-3 + 3e-3), model_.params.coupling_N_per_m * 1e-3, 1e-9);
  EXPECT_EQ(soft.coupling_Ns_per_m, model_.params.coupling_Ns_per_m);
}

TEST_F(Late, AsksNothingOfOldSamplesAndOfADeviceWithItsOwnModel) {
  Input input;
  input.command_lag = 5;
  input.stale_ticks = 1;
  for (int i = 0; i < 1000; ++i) watch_delay(model_, input, *state_);
  input.stale_ticks = 0;
  input.commands = Command::kUnheard;  // the loop judges a deaf link
  for (int i = 0; i < 1000; ++i) watch_delay(model_, input, *state_);
  model_.params.local_period_s = 1e-4;
  show(5, 1000);
  EXPECT_EQ(state_->late.ticks, 0);
}

TEST_F(Late, MendsWhatTheMemorySpoilt) {
  state_->late.ticks = -7;
  state_->late.coupling = -1e300;
  show(0, 1);
  EXPECT_EQ(state_->late.ticks, 0);
  EXPECT_EQ(state_->late.coupling, 1);
  state_->late.ticks = 3;
  state_->late.coupling = std::numeric_limits<double>::quiet_NaN();
  press();
  show(0, 1);
  EXPECT_GT(state_->late.coupling, 0);
  EXPECT_LE(state_->late.coupling, 1);
  show(4000000000u, kLateSamples);  // a device that lies
  EXPECT_GT(state_->late.coupling, 0);
}

}  // namespace
}  // namespace palpate::test
