// A clip touched in parts, in the hand: a tube that two arms hold at once, thrown into a seat as stiff as a wall.
#include <gtest/gtest.h>

#include <string>

#include "sim_host/bake/scene_model.h"
#include "sim_host/feel/feel.h"

namespace palpate {
namespace {

// Before it landed on parts, overloads and pushes of this clip met the seat a tenth of a millimetre deep in one tick
// and were told 900 N; where it was tilted beyond the arms' rims it was lost in every third tick (2026-11-26).
TEST(ClipFeel, EveryManoeuvreIsAsItShouldBe) {
  const SceneModel compiled(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/snap_in.toml");
  const TouchPlace place = touch_place_of(compiled.model(), *compiled.scene());
  for (const ManoeuvreText& text : manoeuvre_texts()) {
    const FeelRun run = run_feel(compiled.model(), *compiled.scene(), place, text.manoeuvre, {}, nullptr);
    EXPECT_EQ(feel_failure(run), "") << text.title;
  }
}

}  // namespace
}  // namespace palpate
