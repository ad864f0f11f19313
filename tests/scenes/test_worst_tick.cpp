// The bound that every shipped image states: an adversary who puts the tool anywhere and moves it anyhow keeps within
// it, and the scripted hand never meets it.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "rt_core/stage_cost.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/scenes/scene_names.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

class WorstTick : public testing::TestWithParam<std::string> {
 protected:
  ImageFile image_{std::string(PALPATE_IMAGE_DIR) + "/" + GetParam() + ".pal"};
  const Model& model_ = image_.model();
  StatePtr state_ = make_state(model_);
  ScratchPtr scratch_ = make_scratch(model_);
  Output output_;
};

TEST_P(WorstTick, HoldsUnderAnAdversary) {
  // PALPATE_ADVERSARIAL_TICKS=1000000 for the figure in docs/real_time_rules.md.
  const char* asked = std::getenv("PALPATE_ADVERSARIAL_TICKS");
  const int ticks = asked != nullptr ? std::atoi(asked) : 4000;
  std::mt19937_64 random(51);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double size) { return Vec3{size * unit(random), size * unit(random), size * unit(random)}; };
  const std::int32_t bound = surface_work_share(model_.params) + kMaxQueryWork;
  Input input;
  input.drive = Drive::kTool;
  std::int32_t most = 0;
  int held = 0;
  for (int i = 0; i < ticks; ++i) {
    if (i % 50 == 0) {  // somewhere else, anyhow
      const Vec3 vertex = model_.vertex_m[random() % model_.vertex_m.size()];
      input.pose_w.orientation = normalised({unit(random), unit(random), unit(random), unit(random) + 1e-3});
      const ToolPoint& point = model_.tool_point[random() % model_.tool_point.size()];
      input.pose_w.position_m = vertex - rotate(input.pose_w.orientation, point.position_tool_m) + vector(5e-3);
    }
    input.pose_w.position_m += vector(i % 7 == 0 ? 0.02 : 1e-3);
    input.pose_w.orientation = normalised(small_rotation(vector(0.03)) * input.pose_w.orientation);
    for (float& closing : input.joints.closing) closing = static_cast<float>(0.5 + 0.5 * unit(random));
    tick(model_, *state_, *scratch_, input, output_);
    most = std::max(most, scratch_->surface_work);
    held += (output_.status & Status::kPointsHeld) != 0 ? 1 : 0;
    ASSERT_LE(scratch_->surface_work, bound) << i;
  }
  std::printf("  %s: %d ticks, most looked at %d of %d, points held in %d; worst tick at most %.0f instructions\n",
              GetParam().c_str(), ticks, most, bound, held, worst_tick_instructions(model_));
}

TEST_P(WorstTick, TheScriptedHandNeverMeetsIt) {
  ScriptedHand hand(model_);
  std::uint32_t seen = 0;
  std::int32_t most = 0;
  for (int i = 0; i < kScriptTicks; ++i) {
    tick(model_, *state_, *scratch_, hand.next(output_), output_);
    if (i > 0) seen |= output_.status;  // nothing is known in the first
    if (i > 0) most = std::max(most, scratch_->surface_work);
  }
  EXPECT_EQ(seen & Status::kPointsHeld, 0u);
  EXPECT_LT(most, surface_work_share(model_.params));
}

INSTANTIATE_TEST_SUITE_P(Shipped, WorstTick, testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace palpate::test
