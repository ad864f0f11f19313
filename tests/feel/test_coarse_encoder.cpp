// A device whose friction is too little for its encoder's steps behind its coupling, and enough behind a soft object.
#include <gtest/gtest.h>

#include <string>

#include "sim_host/bake/scene_model.h"
#include "sim_host/feel/device_draw.h"

namespace palpate {
namespace {

// 88 um behind 1278 N/m are 112 mN, for which 70 of friction are 0.62: by its edges a tremor on a heart of 1214 N/m was
// rough by 5.4 mN; on its track, which asks for 0.98 of what coupling and heart make in series, by 1.6 (2026-11-29).
TEST(CoarseEncoder, ATremorOnASoftObjectIsQuiet) {
  const SceneModel compiled(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/heart_compass.toml");
  const TouchPlace place = touch_place_of(compiled.model(), *compiled.scene());
  const DrawnDevice device = draw_device(1, 192);
  for (const DrawnRun& run : run_drawn(compiled.model(), *compiled.scene(), place, device)) {
    EXPECT_EQ(run.failure, "") << run.run.manoeuvre << ", " << device.text();
    if (run.run.manoeuvre != "tremor") continue;
    EXPECT_LT(run.run.figures.noise_N, 2e-3);
  }
}

}  // namespace
}  // namespace palpate
