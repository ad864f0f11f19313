// What the mouse, keys and sliders of a viewer tell a run: the hand's fingers and single joints, and where its handle
// is pulled; and that the tick moves them no faster than it moves what anybody tells it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <thread>

#include "config/scene/child_program.h"
#include "rt_core/tick.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/run/joint_script.h"
#include "sim_host/tick_memory.h"
#include "sim_host/view/live_run.h"
#include "sim_host/view/steering.h"
#include "tests/support/replayed.h"

namespace palpate {
namespace {

constexpr char kHandScene[] = PALPATE_SOURCE_DIR "/config/scenes/grasp_cylinder_2.toml";
constexpr std::size_t kIndexFlexion = 6;

const Model& hand() {
  static const SceneModel scene(kHandScene);
  return scene.model();
}
const Joint& joint(std::size_t j) { return hand().joint[j]; }

TEST(Steering, MovesOneFingerOrAll) {
  Steering steering;
  EXPECT_FALSE(steering.told(false));
  ASSERT_TRUE(steering.told(true));
  EXPECT_EQ(steering.told(true)->closing[0], 0);
  steering.close_by(1, 0.25);
  steering.close_by(-1, 0.5);
  steering.close_by(4, -0.75);
  steering.close_by(1, 0.75);
  const JointCommand command = steering.told(false).value();
  const float expected[kMaxFingers] = {0.5f, 1, 0.5f, 0.5f, 0};
  for (std::int32_t f = 0; f < kMaxFingers; ++f) EXPECT_EQ(command.closing[f], expected[f]) << f;
}

TEST(Steering, TheDeviceReadsWhereTheMousePulls) {
  Steering steering;
  std::string error;
  const SharedMemory device = SharedMemory::open_peer(dup(steering.fd()), sizeof(HandTargetRegion), error);
  ASSERT_TRUE(device) << error;
  const auto& region = *static_cast<const HandTargetRegion*>(device.data());
  HandWish wish;
  EXPECT_FALSE(read_hand_target(region, wish)) << "nothing was pulled yet";
  steering.pull({{0.01, 0.02, 0.03}, {}});
  ASSERT_TRUE(read_hand_target(region, wish));
  EXPECT_EQ(wish.kind, HandWish::kPull);
  EXPECT_EQ(wish.pose.position_m, (Vec3{0.01, 0.02, 0.03}));
  steering.pull({{std::nan(""), 0, 0}, {}});
  wish.pose.position_m = {1, 2, 3};
  EXPECT_FALSE(read_hand_target(region, wish)) << "no place to go to";
  EXPECT_EQ(wish.pose.position_m, (Vec3{1, 2, 3}));
}

TEST(Steering, OneJointMovesWhileTheOthersGoWithTheirFingers) {
  Steering steering;
  steering.take_up(hand());
  steering.close_by(1, 0.5);
  steering.move_joint(kIndexFlexion, 0.1);
  const JointCommand command = steering.told(false).value();
  EXPECT_EQ(command.direct, 1u << kIndexFlexion);
  EXPECT_EQ(command.closing[1], 0.5f);
  const Joint& index = joint(kIndexFlexion);
  // From where its finger had it, a tenth of its range on.
  EXPECT_NEAR(static_cast<double>(command.target[kIndexFlexion]),
              index.open + 0.5 * (index.closed - index.open) + 0.1 * (index.highest - index.lowest), 1e-6);
  steering.free_joint(kIndexFlexion);
  EXPECT_EQ(steering.told(false)->direct, 0u);
  steering.move_joint(hand().joint.size(), 1);  // there is none
  EXPECT_EQ(steering.told(false)->direct, 0u);
}

TEST(Steering, NoJointIsToldToPassItsLimit) {
  for (const double way : {1.0, -1.0}) {
    Steering steering;
    steering.take_up(hand());
    for (std::size_t j = 0; j < hand().joint.size(); ++j)
      for (int i = 0; i < 3; ++i) steering.move_joint(j, 0.7 * way);
    const JointCommand command = steering.told(false).value();
    EXPECT_EQ(command.direct, (1u << hand().joint.size()) - 1);
    for (std::size_t j = 0; j < hand().joint.size(); ++j) {
      const auto target = static_cast<double>(command.target[j]);
      EXPECT_GE(target, joint(j).lowest) << j;
      EXPECT_LE(target, joint(j).highest) << j;
      const bool up = (joint(j).closed >= joint(j).open) == (way > 0);
      EXPECT_NEAR(target, up ? joint(j).highest : joint(j).lowest, 1e-6) << j;  // a float's rounding
    }
  }
}

TEST(Steering, AJointMovedByItselfGoesAlongAndComesBackWithTheHand) {
  Steering steering;
  steering.take_up(hand());
  const Joint& index = joint(kIndexFlexion);
  const double start = index.open + 0.2 * (index.closed - index.open);
  steering.put_joint(kIndexFlexion, start);
  steering.close_by(-1, 0.25);
  EXPECT_NEAR(static_cast<double>(steering.told(false)->target[kIndexFlexion]),
              start + 0.25 * (index.closed - index.open), 1e-6);
  steering.close_by(-1, -0.75);  // no farther than open
  EXPECT_NEAR(static_cast<double>(steering.told(false)->target[kIndexFlexion]), start, 1e-6);
  EXPECT_EQ(steering.told(false)->closing[1], 0);
}

TEST(Steering, FingersGoOnFromWhereTheRunHasThemAndBeginOpenInANewScene) {
  Steering steering;
  steering.take_up(hand());
  const double closing[kMaxFingers] = {0.1, 0.2, 0.3, 0.4, 0.5};
  steering.begin_from(closing);
  EXPECT_FALSE(steering.told(false)) << "nobody asked for anything yet";
  steering.close_by(2, 0.1);
  EXPECT_FLOAT_EQ(steering.told(false)->closing[2], 0.4f);
  EXPECT_FLOAT_EQ(steering.told(false)->closing[4], 0.5f);
  const double none[kMaxFingers] = {};
  steering.begin_from(none);
  EXPECT_FLOAT_EQ(steering.told(false)->closing[2], 0.4f) << "somebody has moved them";
  steering.put_joint(kIndexFlexion, 0.3);
  steering.take_up(hand());
  EXPECT_EQ(steering.told(false)->closing[2], 0);
  EXPECT_EQ(steering.told(false)->direct, 0u);
}

// A slider that jumps is no joint that jumps.
TEST(Steering, TheTickMovesTheJointAtItsOwnSpeedAndNoOther) {
  Steering steering;
  steering.take_up(hand());
  const StatePtr state = make_state(hand());
  const ScratchPtr scratch = make_scratch(hand());
  Input input;
  input.drive = Drive::kTool;
  input.pose_w.position_m = {-0.3, 0.3, 0};  // far from the body
  Output output;
  tick(hand(), *state, *scratch, input, output);
  const double target = joint(kIndexFlexion).open + 0.6;
  steering.put_joint(kIndexFlexion, target);
  input.joints = steering.told(false).value();
  const double fastest = joint(kIndexFlexion).speed_max * hand().params.period_s;
  const auto ticks = static_cast<int>(std::ceil(0.6 / fastest)) + 1;
  for (int i = 0; i < ticks; ++i) {
    const std::vector<double> before(state->articulation.joint.begin(), state->articulation.joint.end());
    tick(hand(), *state, *scratch, input, output);
    EXPECT_EQ(output.status & Status::kJointLimited, 0u);
    for (std::size_t j = 0; j < before.size(); ++j) {
      const double step = state->articulation.joint[static_cast<std::int32_t>(j)] - before[j];
      if (j == kIndexFlexion)
        ASSERT_LE(std::abs(step), fastest * (1 + 1e-9)) << i;
      else
        ASSERT_EQ(step, 0) << j;
    }
  }
  EXPECT_NEAR(state->articulation.joint[static_cast<std::int32_t>(kIndexFlexion)], target, 1e-6);
}

// As a person does it: a run goes on, one joint's slider is moved, and the recording has it.
TEST(SteeredRun, OneJointIsRecordedAndReplaysToTheBit) {
  const TemporaryFolder folder("palpate-steered");
  RunOptions options;
  options.scene = kHandScene;
  options.image = folder.file("scene.pal");
  options.record = folder.file("run.plr");
  options.quiet = true;
  options.duration_s = 60;
  options.time = RunTime::kVirtual;
  options.program_folder = sibling_program("../bin");
  StartedRun run(options, true);
  ASSERT_NE(run.steering(), nullptr);
  const double target = joint(kIndexFlexion).open + 0.3;
  run.steering()->put_joint(kIndexFlexion, target);
  const std::shared_ptr<const LiveScene> scene = run.scene();
  std::size_t told = 0;  // ticks that were told
  for (std::size_t seen = 0; run.goes_on() && told < 2000; std::this_thread::yield())
    for (; seen < scene->track.size() && told < 2000; ++seen)
      told += scene->track.at(seen).input.joints.direct == 1u << kIndexFlexion ? 1U : 0U;
  run.stop();
  EXPECT_EQ(run.result().summary.fault, 0u);
  ASSERT_EQ(told, 2000u);
  TrackStates states(scene->image.model(), scene->track, copy_of(*scene->initial));
  const State& last = states.go_to(scene->track.size() - 1, scene->track.size());
  EXPECT_NEAR(last.articulation.joint[static_cast<std::int32_t>(kIndexFlexion)], target, 1e-6);
  EXPECT_EQ(test::replayed(options.record), "identical");
}

}  // namespace
}  // namespace palpate
