// Soak from random states: a live state of every shipped scene, spoilt at random, goes on under an adversary as long as
// the check that a recording's first state must pass accepts it. Whatever it holds, no tick may leave the limits of
// force, step and work.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include "config/bake/adversary.h"
#include "rt_core/stage_cost.h"
#include "rt_core/tick.h"
#include "sim_host/record/state_check.h"
#include "sim_host/status_text.h"
#include "sim_host/tick_memory.h"
#include "tests/scenes/scene_names.h"
#include "tests/support/image_file.h"

namespace palpate::test {
namespace {

class Soak : public testing::TestWithParam<std::string> {
 protected:
  // Bytes of the fields, of the pools or of whole numbers anywhere; half of what is spoilt is one number only.
  void spoil(State& state) {
    auto* bytes = reinterpret_cast<unsigned char*>(&state);
    const std::size_t reach = random_() % 2 == 0 ? sizeof(State) : state.bytes;
    const bool whole = random_() % 2 == 0;
    const int changes = whole ? 1 : 1 + static_cast<int>(random_() % 4);
    for (int i = 0; i < changes; ++i) {
      if (!whole) {
        bytes[random_() % reach] = static_cast<unsigned char>(random_());
        continue;
      }
      const double values[] = {0, -1, 1e-300, 1e300, 1e6, unit_(random_), 1e-3 * unit_(random_)};
      std::memcpy(bytes + random_() % (reach / 8) * 8, &values[random_() % std::size(values)], 8);
    }
  }
  // After a state was spoilt its last output may lie anywhere: the step counts from the second tick on.
  void check(const Output& output, const Wrench& before, bool steps, int i) {
    const ModelParams& p = model_.params;
    ASSERT_TRUE(is_finite(output.device_w.force_N) && is_finite(output.device_w.torque_Nm)) << i;
    ASSERT_TRUE(is_finite(output.tool_w) && is_finite(output.penetration_m)) << i;
    for (int s = 0; s < kStageCount; ++s) {
      const auto stage = static_cast<Stage>(s);
      ASSERT_LE(counted_instructions(scratch_->work, stage), most_stage_cost(model_, stage)) << stage_name(stage) << i;
    }
    if (drive_ != Drive::kDevice) return;
    ASSERT_LE(norm(output.device_w.force_N), p.force_max_N * (1 + 2e-9)) << i;
    ASSERT_LE(norm(output.device_w.torque_Nm), p.torque_max_Nm * (1 + 2e-9)) << i;
    const Vec3 step_N = output.device_w.force_N - before.force_N;
    ASSERT_TRUE(!steps || norm(step_N) <= kOutputStepShare * p.force_max_N * (1 + 1e-9)) << i << ": " << norm(step_N);
  }

  ImageFile image_{std::string(PALPATE_IMAGE_DIR) + "/" + GetParam() + ".pal"};
  const Model& model_ = image_.model();
  ScratchPtr scratch_ = make_scratch(model_);
  std::mt19937_64 random_{23};
  std::uniform_real_distribution<double> unit_{-1, 1};
  Drive drive_ = Drive::kDevice;
};

// PALPATE_SOAK_TICKS: over all scenes; ./run test --long asks for a hundred million.
TEST_P(Soak, NoStateLeavesTheLimits) {
  const char* asked = std::getenv("PALPATE_SOAK_TICKS");
  const auto ticks =
      static_cast<int>((asked != nullptr ? std::atof(asked) : 1e6) / static_cast<double>(scene_names().size()));
  Adversary adversary(model_, 29);
  StatePtr state = make_state(model_);
  Output output;
  int refused = 0, accepted = 0, since = 0;
  for (int i = 0; i < ticks; ++i) {
    bool forgets = false;
    Input input = adversary.next(output, forgets);
    if (i / 64 % 2 == 0) input.drive = Drive::kDevice;
    if (forgets) reset(*state), since = 0;
    if (random_() % 8 == 0) {
      StatePtr spoilt = copy_of(*state);
      spoil(*spoilt);
      if (check_state(model_, *spoilt).field == nullptr) {
        state = std::move(spoilt);
        accepted += 1;
        since = 0;
      } else {
        refused += 1;
      }
    }
    const bool was_device = drive_ == Drive::kDevice;
    drive_ = input.drive;
    const Wrench before = output.device_w;
    tick(model_, *state, *scratch_, input, output);
    ASSERT_NO_FATAL_FAILURE(check(output, before, since > 0 && was_device, i));
    since += 1;
  }
  std::printf("  %s: %d ticks from %d random states, %d refused\n", GetParam().c_str(), ticks, accepted, refused);
  EXPECT_GT(accepted, ticks / 100);
  EXPECT_GT(refused, ticks / 200);
}

INSTANTIATE_TEST_SUITE_P(Shipped, Soak, testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace palpate::test
