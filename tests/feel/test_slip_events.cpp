// How often a tool breaks loose is the object's and the hand's, not the loop's: the same slide at four tick periods and
// with four encoders.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "config/bake/time_params.h"
#include "rt_core/tick.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/feel/feel.h"
#include "sim_host/tick_memory.h"

namespace palpate {
namespace {

// How often the tool, having stuck for a tenth of a second at least, breaks loose in the manoeuvre `slide`. An encoder
// of 0.1 mm tells a hand that sets out, and one that turns round, as standing still for up to 80 ms.
int breaks_loose(const Model& model, const SceneDesc& scene) {
  FeelSetup setup = feel_setup(scene, model, {});
  set_manoeuvre(Manoeuvre::kSlide, touch_place_of(model, scene), setup);
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  const int rest_ticks = static_cast<int>(std::lround(0.1 / model.params.period_s));
  int events = 0, stuck = 0;
  run_feel_loop(
      setup, [&](const Input& input, Output& output) { tick(model, *state, *scratch, input, output); },
      [&](const FeelTick&) {
        bool slips = false, touches = false;
        for (const Region& region : state->region) {
          touches = touches || region.is_live();
          slips = slips || (region.is_live() && region.friction == FrictionMode::kSlip);
        }
        events += slips && stuck >= rest_ticks ? 1 : 0;
        stuck = touches && !slips ? stuck + 1 : 0;
      });
  return events;
}

class SlipEvents : public testing::TestWithParam<const char*> {};

TEST_P(SlipEvents, AreThoseOfTheObjectWhateverThePeriodAndTheEncoder) {
  const auto baked = [](const std::string& period_ms) {
    SceneOverlays overlays;
    // A coupling that every one of them admits: 2 f_c / Delta with 0.1 mm is 1200 N/m.
    overlays.setting = {"device.coupling_N_per_m=1000", "device.period_ms=" + period_ms};
    return SceneModel(std::string(PALPATE_SOURCE_DIR "/config/scenes/") + GetParam() + ".toml", overlays);
  };
  const SceneModel usual = baked("1");
  const int events = breaks_loose(usual.model(), *usual.scene());
  std::printf("  %s: %d;", GetParam(), events);
  EXPECT_GE(events, 2);  // there and back
  for (const char* period_ms : {"0.25", "0.5", "2"}) {
    const SceneModel other = baked(period_ms);
    const int now = breaks_loose(other.model(), *other.scene());
    std::printf(" %s ms %d", period_ms, now);
    EXPECT_LE(std::abs(now - events), 1) << period_ms << " ms";
  }
  for (const double encoder_m : {0.0, 1e-5, 1e-4}) {
    SceneDesc scene = *usual.scene();
    scene.device.encoder_step_m = encoder_m;
    Model model = usual.model();
    set_times(scene, model.params);
    const int now = breaks_loose(model, scene);
    std::printf(" %g um %d", 1e6 * encoder_m, now);
    EXPECT_LE(std::abs(now - events), 1) << 1e6 * encoder_m << " um";
  }
  std::printf("\n");
}

INSTANTIATE_TEST_SUITE_P(Shipped, SlipEvents,
                         testing::Values("ellipsoid_mallet", "ellipsoid_mallet_springs", "tools_on_cylinder"),
                         [](const testing::TestParamInfo<const char*>& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace palpate
