// Shipped tissues relax as their sources say.
#include <gtest/gtest.h>

#include <cmath>

#include "rt_core/tick.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/tick_memory.h"

namespace palpate {
namespace {

// A tip pressed 2 mm in at once and held: the force falls as 1 - 0.450 (1 - exp(-t / 0.5 s)) - 0.365 (1 - exp(-t / 50
// s)) (Miller & Chinzei 2002). The step counts as one tick old when its force is first told, so T / tau_1 = 0.2 % may
// be missing.
TEST(Tissues, BrainRelaxesAsMeasured) {
  const std::string scenes = PALPATE_SOURCE_DIR "/config/scenes/";
  SceneOverlays overlays;
  overlays.file = {scenes + "tissues/brain.toml"};
  const SceneModel brain(scenes + "tools_on_layer.toml", overlays);
  const StatePtr state = make_state(brain.model());
  const ScratchPtr scratch = make_scratch(brain.model());
  Input input;
  Output output;
  input.drive = Drive::kTool;
  input.pose_w = {brain.scene()->path.point.front().position_m, {}};
  double first_N = 0;
  for (int i = 0; i < 200 && first_N == 0; ++i) {  // down to the surface, from where the scene's path begins
    input.pose_w.position_m.y -= 1e-4;
    tick(brain.model(), *state, *scratch, input, output);
    if (output.contacts > 0) first_N = norm(output.contact_w.force_N);
  }
  ASSERT_GT(first_N, 0);
  reset(*state);
  input.pose_w.position_m.y -= 2e-3;
  for (int i = 1; i <= 5000; ++i) {
    tick(brain.model(), *state, *scratch, input, output);
    const double force_N = norm(output.contact_w.force_N), t = 1e-3 * i;
    if (i == 1) first_N = force_N;
    const double left = 1 - 0.450 * (1 - std::exp(-t / 0.5)) - 0.365 * (1 - std::exp(-t / 50));
    EXPECT_NEAR(force_N / first_N, left, 0.002) << t;
  }
}

}  // namespace
}  // namespace palpate
