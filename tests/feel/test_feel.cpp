// The bench on a shipped scene: the hand meets the object where the scene's own path does, and what it measures is what
// springs in series say.
#include <gtest/gtest.h>

#include <cmath>

#include "sim_host/bake/scene_model.h"
#include "sim_host/feel/feel.h"

namespace palpate {
namespace {

class FeelScene : public testing::Test {
 protected:
  FeelScene() : compiled_(PALPATE_SOURCE_DIR "/config/scenes/tools_on_cylinder.toml"), scene_(*compiled_.scene()) {}
  FeelRun feel(Manoeuvre manoeuvre, const FeelOptions& options = {}) {
    return run_feel(compiled_.model(), scene_, touch_place_of(compiled_.model(), scene_), manoeuvre, options, nullptr);
  }
  SceneModel compiled_;
  SceneDesc scene_;
};

TEST_F(FeelScene, APressIsQuietAndInSeriesWithTheCoupling) {
  const FeelFigures press = feel(Manoeuvre::kPress).figures;
  EXPECT_LE(press.contacts, 2);  // the surface may be met once more when the hand leaves
  EXPECT_EQ(press.alternations, 0);
  EXPECT_EQ(press.fault, 0u);
  EXPECT_LT(press.lag_m, 8.5 / compiled_.model().params.coupling_N_per_m);
  EXPECT_GT(press.force_max_N, 3);
  EXPECT_LT(press.felt_N_per_m, compiled_.model().params.coupling_N_per_m);  // an object in series
  EXPECT_GT(press.felt_N_per_m, 0.7 * compiled_.model().params.coupling_N_per_m);
}

TEST_F(FeelScene, TapsAreCountedAndLeaveNothingInTheHand) {
  const FeelFigures tap = feel(Manoeuvre::kTap).figures;
  EXPECT_GE(tap.contacts, 6);  // some bounce once
  EXPECT_EQ(tap.hand_J, 0);    // the shipped device swallows what sampling and delay make
}

// A hand that beats the motors presses the object with what they have: before, with 104 N behind motors of 8.5 N.
TEST_F(FeelScene, AHandThatWinsWindsNothingUp) {
  for (const Manoeuvre manoeuvre : {Manoeuvre::kOverload, Manoeuvre::kPush}) {
    const FeelRun run = feel(manoeuvre);
    EXPECT_EQ(feel_failure(run), "") << run.manoeuvre;
    EXPECT_LT(run.figures.model_max_N, 1.1 * 8.5);
    EXPECT_GT(run.figures.force_max_N, 8.4);
  }
}

TEST_F(FeelScene, ADeviceThatSendsTooFewSamplesIsNotRendered) {
  const FeelRun run = feel(Manoeuvre::kSlow);
  EXPECT_EQ(run.figures.fault, Fault::kSamplesSparse);
  EXPECT_LT(run.figures.force_max_N, 1);
}

TEST_F(FeelScene, SaysTheSameTwiceAndInEveryForm) {
  const FeelRun one = feel(Manoeuvre::kHold), two = feel(Manoeuvre::kHold);
  EXPECT_EQ(feel_json({one}), feel_json({two}));
  EXPECT_NE(feel_json({one}).find("\"manoeuvre\": \"hold\""), std::string::npos);
  EXPECT_NE(feel_table({one}).find("hold"), std::string::npos);
  EXPECT_NE(feel_markdown({one}).find("| tools_on_cylinder |"), std::string::npos);
}

TEST_F(FeelScene, RefusesWhatItDoesNotKnow) {
  EXPECT_THROW(manoeuvre_of("tickle"), std::runtime_error);
  FeelOptions options;
  options.hand = "iron";
  EXPECT_THROW(feel(Manoeuvre::kTap, options), std::runtime_error);
  for (const char* text : {"mass_kg", "mass_kg=", "mass_kg=-1", "mass_kg=nan", "colour=1"}) {
    options = {};
    options.device = {text};
    EXPECT_THROW(feel(Manoeuvre::kTap, options), std::runtime_error) << text;
  }
}

TEST(FeelVerdict, NamesWhatFails) {
  FeelRun run{"scene", "push", {}};
  run.figures.force_limit_N = 8.5;
  EXPECT_EQ(feel_failure(run), "");
  run.figures.alternations = 3;
  run.figures.step_share = 0.2;
  run.figures.model_max_N = 104;
  run.figures.fault = Fault::kDeviceSilent;
  EXPECT_EQ(feel_failure(run), "swings in 3 ticks, steps by 20 %, winds up to 104 N, fault DeviceSilent");
}

}  // namespace
}  // namespace palpate
