// A hand that slides the tool over the body through the virtual coupling: friction must not set the massless tool
// swinging from one sense of sliding to the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "rt_core/safety/seat.h"
#include "rt_core/tool/virtual_coupling.h"
#include "sim_host/tick_memory.h"
#include "tests/support/baked_scene.h"

namespace palpate {
namespace {

constexpr double kEncoder_m = 30e-6;  // the simulated device's step
constexpr double kPeriod_s = 1e-3;

struct LawCase {
  const char* name;
  const char* contact;
  const char* friction;
};
void PrintTo(const LawCase& c, std::ostream* out) { *out << c.name; }

// The tool's frame is 20 mm above its tip, so that friction also turns it.
std::string scene_with(const LawCase& c) {
  return std::string(
             "name = \"slide\"\n[body]\nshape = \"box\"\nsize_mm = [200, 40, 80]\ntriangles = 2000\n"
             "[body.material]\nyoungs_modulus_Pa = 1e6\npoisson_ratio = 0.47\n[contact]\n") +
         c.contact + "[friction]\n" + c.friction +
         "[[tool.piece]]\nshape = \"sphere\"\nposition_mm = [0, -14, 0]\nradius_mm = 6\n[device]\nname = "
         "\"sim-6dof\"\n";
}

class Handle {
 public:
  explicit Handle(const std::string& scene) : scene_(scene) { reset(*state_); }
  Vec3 at(Vec3 handle_w) {
    Input input;
    input.drive = Drive::kDevice;
    input.commands = Command::kArm;
    input.pose_w.position_m = {kEncoder_m * std::round(handle_w.x / kEncoder_m), handle_w.y, handle_w.z};
    tick(scene_.model(), *state_, *scratch_, input, output_);
    const Wrench pull = coupling_wrench(scene_.model(), coupling_end(*state_), state_->safety.tool_corrected_w);
    return pull.force_N;
  }
  const Region& region() const { return state_->region[0]; }

 private:
  test::BakedScene scene_;
  StatePtr state_ = make_state(scene_.model());
  ScratchPtr scratch_ = make_scratch(scene_.model());
  Output output_;
};

class Sliding : public testing::TestWithParam<LawCase> {};

// From rest to 90 mm/s, the load falling slowly: what the hand feels of friction falls with it, without turning.
TEST_P(Sliding, IsSteady) {
  Handle handle(scene_with(GetParam()));
  for (int i = 0; i < 300; ++i) handle.at({0, 0.06 - 0.0025 * std::min(i / 200.0, 1.0), 0});
  std::vector<double> pull;
  int turns = 0;
  double step_max = 0, sense = -1e9, last_step = 0;
  for (int i = 0; i < 1500; ++i) {
    const double t = i * kPeriod_s;
    const Vec3 f = handle.at({0.03 * t * t, 0.0575 + 1e-4 * t, 0});
    if (i > 1000) {
      const double step = f.x - pull.back();
      step_max = std::max(step_max, std::abs(step));
      if (step * last_step < 0 && std::abs(step) > 0.05 * std::abs(f.x)) ++turns;
      last_step = step;
      sense = std::max(sense, f.x);
    }
    pull.push_back(f.x);
  }
  std::printf("  %-18s pull %.3f N, largest step %.4f N, %d turns, normal %.3f N\n", GetParam().name, pull.back(),
              step_max, turns, handle.region().normal_force_N);
  EXPECT_LT(pull.back(), -0.1);
  EXPECT_LT(sense, 0);  // never pushes the hand forwards
  EXPECT_EQ(turns, 0);
}

// After a jump of the handle back by 3 mm, far more than friction's stretch, and forwards again, as when samples were
// lost, the tool is seated anew: it goes on sliding steadily and pulls no more than before; what it pulls less, a
// quarter here, it pulls again when the tool was lifted and comes down anew.
TEST_P(Sliding, SettlesAfterAJump) {
  Handle handle(scene_with(GetParam()));
  for (int i = 0; i < 300; ++i) handle.at({0, 0.06 - 0.0025 * std::min(i / 200.0, 1.0), 0});
  double before = 0, after_min = 0, after_max = -1e9, again_min = 0, again_max = -1e9;
  for (int i = 0; i < 2600; ++i) {
    const double t = i * kPeriod_s, back = i > 1000 && i < 1010 ? 0.003 : 0;
    const double lifted = 0.004 * std::clamp(std::min(i - 1600, 2100 - i) / 200.0, 0.0, 1.0);
    const Vec3 f = handle.at({0.03 * t - back, 0.0575 + lifted, 0});
    if (i == 999) before = f.x;
    if (i >= 1500 && i < 1600) after_min = std::min(after_min, f.x), after_max = std::max(after_max, f.x);
    if (i >= 2500) again_min = std::min(again_min, f.x), again_max = std::max(again_max, f.x);
  }
  std::printf("  %-18s before %.4f, after %.4f to %.4f, down anew %.4f to %.4f N\n", GetParam().name, before, after_min,
              after_max, again_min, again_max);
  EXPECT_LT(before, -0.1);
  EXPECT_NEAR(after_min, after_max, 0.1 * std::abs(before));
  EXPECT_GT(after_min, 1.01 * before);
  EXPECT_LT(after_max, 0.5 * before);
  EXPECT_NEAR(again_min, before, 0.1 * std::abs(before));
  EXPECT_NEAR(again_max, before, 0.1 * std::abs(before));
}

INSTANTIATE_TEST_SUITE_P(
    Laws, Sliding,
    testing::Values(LawCase{"presliding", "law = \"tool\"\n", "law = \"presliding\"\nmu_ref = 0.5\n"},
                    LawCase{"presliding_paper", "law = \"tool\"\n", "law = \"presliding_paper\"\nmu_ref = 0.5\n"},
                    LawCase{"mindlin", "law = \"tool\"\n", "law = \"mindlin\"\nmu_ref = 0.5\nbeta = 1\n"},
                    LawCase{"return_map", "law = \"hertz\"\n[contact.hertz]\ntool_radius_mm = 6\n",
                            "law = \"return_map\"\nmu_ref = 0.5\nbeta = 1\n"}),
    [](const testing::TestParamInfo<LawCase>& c) { return std::string(c.param.name); });

}  // namespace
}  // namespace palpate
