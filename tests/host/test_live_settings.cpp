// Settings that change during a run: what they do to the force, how softly, and that nothing else follows from them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "rt_core/live_model.h"
#include "tests/support/baked_scene.h"

namespace palpate {
namespace {

using test::BakedScene;

// A ball of 10 mm on an ellipsoid, whose lowest point is the origin.
std::string scene_text(const std::string& contact) {
  return "name = \"live\"\n[body]\nshape = \"ellipsoid\"\nhalf_axes_mm = [40, 30, 25]\ntriangles = 2000\n[contact]\n" +
         contact +
         "\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 10\n"
         // A contact that breaks loose does so by its own laws: here without a drop from static to sliding friction.
         "[friction]\nmu_ref = 0.3\nmu_dynamic = 0.3\nbeta = 1\n[device]\nsmooth_encoder = false\nforce_max_N = "
         "8.5\nspeed_max_m_per_s = 5\n";
}
const char* const kPoints = "law = \"cubic\"\n[contact.cubic]\nk1_N_per_m = 300\nk3_N_per_m3 = 1e6";

struct Ticks {
  explicit Ticks(const Model& scene) : model(scene) {}
  const Output& at(double height_m, const LiveSettings& live, Drive drive, double x_m = 0) {
    Input input;
    input.drive = drive;
    input.pose_w.position_m = {x_m, height_m, 0};
    input.live = live;
    // An edge in every second tick until it is armed.
    if (output.mode == Mode::kIdle && state->tick % 2 == 1) input.commands = Command::kArm;
    tick(model, *state, *scratch, input, output);
    return output;
  }
  const Model& model;
  StatePtr state = make_state(model);
  ScratchPtr scratch = make_scratch(model);
  Output output;
};

constexpr double kTouch_m = 0.060 + 0.010;

TEST(LiveSettings, HalfTheStiffnessIsHalfTheForceBitForBit) {
  const BakedScene scene(scene_text(kPoints));
  Ticks as_baked(scene.model()), soft(scene.model());
  const LiveSettings half{0.5f, 1, 1, 1};
  for (int i = 0; i < 400; ++i) soft.at(0.1, half, Drive::kTool), as_baked.at(0.1, {}, Drive::kTool);
  ASSERT_EQ(soft.state->live.stiffness, 0.5);
  double most_N = 0;
  for (int i = 0; i < 600; ++i) {
    const double y_m = kTouch_m + 0.001 - 1e-5 * std::min(i, 300), x_m = 2e-5 * std::max(0, i - 300);
    const Vec3 one = as_baked.at(y_m, {}, Drive::kTool, x_m).contact_w.force_N;
    const Vec3 other = soft.at(y_m, half, Drive::kTool, x_m).contact_w.force_N;
    EXPECT_EQ(other, 0.5 * one) << i;  // 0.5 scales without rounding
    EXPECT_EQ(soft.output.energy_J, 0.5 * as_baked.output.energy_J) << i;
    most_N = std::max(most_N, norm(one));
  }
  EXPECT_GT(most_N, 0.3);
}

TEST(LiveSettings, TheToolComesToTheBalanceOfAnotherSpring) {
  // Coupling and body in series: F = h / (1 / k + 1 / K), for a body of springs whose stiffness is asked of the scene.
  const BakedScene scene(scene_text("law = \"cubic\"\n[contact.cubic]\nk1_N_per_m = 300\nk3_N_per_m3 = 0"));
  for (const LiveSettings live : {LiveSettings{}, {2, 1, 1, 1}, {0.25f, 1, 1, 1}, {1, 1, 1, 0.1f}, {2, 1, 1, 0.1f}}) {
    Ticks run(scene.model());
    for (int i = 0; i < 3000; ++i) run.at(kTouch_m + 0.002 - 4e-6 * std::min(i, 1000), live, Drive::kDevice);
    ASSERT_EQ(run.output.mode, Mode::kForce);
    const double handle_m = kTouch_m - 0.002, tool_m = run.output.tool_w.position_m.y;
    const double K = double{live.coupling} * scene.model().params.coupling_N_per_m;
    const double felt_N = run.output.device_w.force_N.y;
    EXPECT_NEAR(felt_N, K * (tool_m - handle_m), 1e-6 * felt_N);
    EXPECT_NEAR(felt_N, run.output.contact_w.force_N.y, 1e-6 * felt_N);
    // The same tool pressed there by itself.
    Ticks pressed(scene.model());
    pressed.at(tool_m, {}, Drive::kTool);
    EXPECT_NEAR(felt_N, double{live.stiffness} * pressed.output.contact_w.force_N.y, 1e-3 * felt_N);
  }
}

TEST(LiveSettings, NoChangeStepsTheForceByMoreThanOnePercentOfTheLargest) {
  const BakedScene scene(scene_text(kPoints));
  const double most_N = 0.01 * scene.model().params.force_max_N;
  const std::vector<LiveSettings> wishes = {{0.1f, 1, 1, 1},  {2, 1, 1, 1},     {1, 0, 1, 1},
                                            {1, 2, 1, 1},     {1, 1, 0.05f, 1}, {1, 1, 1, 0.05f},
                                            {2, 2, 1, 0.05f}, {2, 0, 1, 1},     {}};
  Ticks run(scene.model());
  double shift_m = 0;
  // Pressed and then moved aside by 1 mm, so that friction holds it; then it stands still.
  for (int i = 0; i < 3000; ++i) {
    shift_m = 1e-6 * std::max(0, std::min(i - 1500, 1000));
    run.at(kTouch_m + 0.002 - 1.2e-5 * std::min(i, 1000), {}, Drive::kDevice, shift_m);
  }
  ASSERT_GT(norm(run.output.device_w.force_N), 3);
  for (const LiveSettings& wish : wishes) {
    Vec3 last = run.output.device_w.force_N;
    double worst_N = 0;
    for (int i = 0; i < 1200; ++i) {
      const Vec3 now = run.at(kTouch_m - 0.010, wish, Drive::kDevice, shift_m).device_w.force_N;
      worst_N = std::max(worst_N, norm(now - last));
      last = now;
    }
    EXPECT_LT(worst_N, most_N) << double{wish.stiffness} << " " << double{wish.friction} << " "
                               << double{wish.force_limit} << " " << double{wish.coupling};
    EXPECT_EQ(run.output.fault, 0u);
    EXPECT_EQ(run.state->live.moves, 0) << "it has arrived";
    EXPECT_LE(norm(last), double{wish.force_limit} * scene.model().params.force_max_N * (1 + 1e-6));
  }
  EXPECT_EQ(run.state->live.changed, 0) << "all is as it was baked";
}

TEST(LiveSettings, WishesThatAreNoneAreNotFollowed) {
  SettingsState live;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const LiveSettings& wish :
       {LiveSettings{nan, nan, nan, nan}, {0, 3, 0, 0}, {-1, -1, 2, 5}, {1e30f, 1e30f, 1e30f, 1e30f}}) {
    EXPECT_FALSE(is_valid(wish));
    follow_settings(wish, live);
    EXPECT_EQ(live.stiffness, 1);
    EXPECT_EQ(live.friction, 1);
    EXPECT_EQ(live.force_limit, 1);
    EXPECT_EQ(live.coupling, 1);
  }
  EXPECT_TRUE(is_valid(LiveSettings{}));
}

TEST(LiveSettings, AStateSpoiltInMemoryIsMended) {
  SettingsState live;
  live.changed = 1;
  live.stiffness = std::numeric_limits<double>::infinity();
  live.friction = -5;
  live.coupling = std::numeric_limits<double>::quiet_NaN();
  follow_settings({}, live);
  EXPECT_EQ(live.stiffness, 1);
  EXPECT_EQ(live.friction, 1);
  EXPECT_EQ(live.coupling, 1);
  EXPECT_EQ(live.changed, 0);
}

}  // namespace
}  // namespace palpate
