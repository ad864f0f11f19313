// Settings that change during a run, on every shipped scene while its hand presses or holds: no change moves what is
// felt by more than 1 % of the device's largest force in a tick. What a setting lets go jumps by its own laws, and may
// reach the device's slope.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "rt_core/tick.h"
#include "rt_core/tool/virtual_coupling.h"
#include "sim_host/tick_memory.h"
#include "tests/scenes/scene_names.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

struct Wish {
  const char* what;
  LiveSettings live;
  bool lets_go = false;  // friction that held ends
};
// From one end of every range to the other, and back to 1.
const Wish kWishes[] = {{"stiffness 0.1", {0.1f, 1, 1, 1}},
                        {"stiffness 2", {2, 1, 1, 1}},
                        {"back to 1", {}},
                        {"force_limit 0.05", {1, 1, 0.05f, 1}},
                        {"back to 1", {}},
                        {"coupling 0.05", {1, 1, 1, 0.05f}},
                        {"back to 1", {}},
                        {"friction 2", {1, 2, 1, 1}},
                        {"stiff and slippery", {2, 0, 1, 1}, true},
                        {"back to 1", {}}};

class LiveSteps : public testing::TestWithParam<std::string> {};

TEST_P(LiveSteps, StayBelowOnePercentOfTheLargestForce) {
  const ImageFile image(std::string(PALPATE_IMAGE_DIR) + "/" + GetParam() + ".pal");
  const Model& model = image.model();
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  ScriptedHand hand(model);
  Output output;
  Input input;
  const int pressed = model.grasp_w.empty() ? 1000 : 2700;  // ticks: within 0.8 to 1.2 s, or closed and not shaken yet
  for (int i = 0; i < pressed; ++i) tick(model, *state, *scratch, input = hand.next(output), output);
  input.commands = 0;
  for (int i = 0; i < 1500; ++i) tick(model, *state, *scratch, input, output);
  ASSERT_EQ(output.mode, Mode::kForce);
  ASSERT_GT(output.contacts, 0);
  const double most_N = 0.01 * model.params.force_max_N;
  // Under a hand that holds still the coupling lets no jump of the tool move the force by more; rounding adds.
  const double calm_N = kCalmStepShare * model.params.force_max_N * (1 + 1e-9);
  std::printf("  held by %.2f N, %d regions; 1 %% is %.3f N\n", norm(output.device_w.force_N), output.regions, most_N);
  for (const Wish& wish : kWishes) {
    input.live = wish.live;
    double worst_N = 0;
    for (int i = 0; i < 1200; ++i) {
      const Vec3 before_N = output.device_w.force_N;
      tick(model, *state, *scratch, input, output);
      worst_N = std::max(worst_N, norm(output.device_w.force_N - before_N));
    }
    std::printf("  %-18s %.4f N, %.2f %%\n", wish.what, worst_N, 100 * worst_N / model.params.force_max_N);
    // Measured 2026-11-25: 0.45 % at most, 0.96 % where snap_in_paper's clip slips off as the coupling softens.
    EXPECT_LT(worst_N, wish.lets_go ? calm_N : most_N) << wish.what;
    EXPECT_EQ(output.fault, 0u);
    EXPECT_EQ(state->live.moves, 0) << "it has arrived";
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, LiveSteps, testing::ValuesIn(scene_names()),
                         [](const testing::TestParamInfo<std::string>& scene) { return scene.param; });

}  // namespace
}  // namespace palpate::test
