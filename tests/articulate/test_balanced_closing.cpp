// hand.closing = "balanced": fingers end at the force that is asked of them and the thumb opposes them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "config/bake/compile.h"
#include "config/hand/hand_model.h"
#include "tests/articulate/grasp_scenes.h"
#include "tests/articulate/round_cones.h"
#include "tests/support/refusal.h"

namespace palpate::test {
namespace {

using testing::HasSubstr;

const std::string kFolder = std::string(PALPATE_SOURCE_DIR) + "/config/scenes/";

SceneDesc balanced(const std::string& name, const std::vector<std::string>& set = {}) {
  return load_scene(kFolder + name + ".toml", {{kFolder + "hands/balanced.toml"}, set});
}

std::int32_t fingers_of(const std::string& name) { return name.back() - '0'; }

double total_N(const GraspRun& run) {
  return std::accumulate(std::begin(run.finger_force_N), std::end(run.finger_force_N), 0.0);
}

// The scene's own way in, in its own time. The baker closes the hand in a tenth of the ticks: forces differ by up to
// 2.1e-4 N (2026-11-25). By their own scenes the fingers press with 0.6 to 2.9 N.
TEST(BalancedClosing, EveryFingerPressesWithItsForce) {
  for (const std::string name : kScenes) {
    const PlayedGrasp played(name, {"hands/balanced.toml"});
    for (std::int32_t f = 1; f < kMaxFingers; ++f)
      EXPECT_NEAR(played.run.finger_force_N[f], f < fingers_of(name) ? 1 : 0, 1e-3) << name << " " << finger_name(f);
    // No part is idle but the little finger's root, which does not reach the sphere.
    for (std::size_t part = 1; part <= kHandParts; ++part)
      if (fingers_of(name) == 5 && !(name == "grasp_sphere_5" && part == 12)) {
        EXPECT_GT(played.run.part_force_N[part], 0.05) << name << " " << hand_parts()[part - 1].name;
      }
    EXPECT_LT(played.run.chatter, 1e-9) << name;
    EXPECT_TRUE(played.run.back_at_rest) << name;
  }
}

// Less is left for friction than where fingers close to a depth, in all and of each newton that they press with on the
// cylinder (0.03, 0.06 and 0.10 of them against 0.11, 0.20 and 0.22), and the weight is held with friction to spare, by
// the independent judge as well.
TEST(BalancedClosing, TheThumbOpposesTheFingersAndTheWeightIsHeld) {
  for (const std::string name : kScenes) {
    const PlayedGrasp played(name, {"hands/balanced.toml"});
    const Grasp grasp = played.grasp(), by_depth = grasp_of(scene_named(name).model(), *test::played(name).held);
    const double left_N = left_for_friction_N(grasp), depth_left_N = left_for_friction_N(by_depth);
    std::printf("%s: %.3f of %.2f N left for friction, by depth %.3f of %.2f N\n", name.c_str(), left_N,
                total_N(played.run), depth_left_N, total_N(test::played(name)));
    EXPECT_LT(left_N, 0.8 * depth_left_N) << name;
    if (name.find("cylinder") != std::string::npos) {
      EXPECT_LT(left_N / total_N(played.run), 0.5 * depth_left_N / total_N(test::played(name))) << name;
    }
    EXPECT_TRUE(holds(grasp)) << name;
    EXPECT_LT(left_in_round_cones_N(grasp, 1), 1e-3 * norm(grasp.weight_N)) << name;
  }
}

// Thumb against one finger on a cylinder: their normal forces cancel across the palm's normal, which takes what is
// left.
TEST(BalancedClosing, ThumbAndIndexPressAgainstOneAnother) {
  const PlayedGrasp played("grasp_cylinder_2", {"hands/balanced.toml"});
  const Grasp grasp = played.grasp();
  Vec3 sum;
  for (const GraspContact& finger : grasp.finger) sum += finger.normal_N * finger.push_w;
  const Vec3 out = rotate(played.run.held->tool_w.orientation, {0, 0, -1});
  EXPECT_LT(norm(tangential_part(sum, out)), 0.01) << "of 1 N of the index";
  EXPECT_LT(dot(sum, out), 0) << "onto the palm";
}

TEST(BalancedClosing, EachFingerMayHaveAForceOfItsOwn) {
  const PlayedGrasp played("grasp_cylinder_5", {"hands/balanced.toml"}, {"hand.grip_N=[1, 1.4, 1.2, 0.8, 0.6]"});
  const double asked_N[] = {0, 1.4, 1.2, 0.8, 0.6};
  for (std::int32_t f = 1; f < kMaxFingers; ++f) EXPECT_NEAR(played.run.finger_force_N[f], asked_N[f], 1e-3) << f;
}

// Where the preshape starts from is no part of the answer.
TEST(BalancedClosing, EndsWhereItEndsFromAnotherPreshape) {
  const CompileResult a = compile_scene(balanced("grasp_cylinder_3"));
  const CompileResult b = compile_scene(balanced("grasp_cylinder_3", {"hand.squeeze_mm=2.5"}));
  for (std::size_t f = 0; f < kMaxFingers; ++f) EXPECT_NEAR(a.report.grip_N[f], b.report.grip_N[f], 1e-3) << f;
  EXPECT_NEAR(a.report.grip_left_N, b.report.grip_left_N, 1e-3);
}

std::string warnings_of(const SceneDesc& scene) {
  std::string all;
  for (const std::string& warning : compile_scene(scene).report.warnings) all += warning + '\n';
  return all;
}

// With the hand 60 mm lower the little finger passes below the cylinder.
TEST(BalancedClosing, AFingerThatMeetsNothingIsReported) {
  EXPECT_THAT(warnings_of(balanced("grasp_cylinder_5", {"hand.grasp_mm=[-30, 8, -28]"})),
              HasSubstr("hand: fingers that meet nothing and press with no force: little\n"));
  EXPECT_THAT(warnings_of(balanced("grasp_cylinder_5")), testing::Not(HasSubstr("press with no force")));
}

// The contact law reaches to 4 mm: 20 N are more than an index finger has.
TEST(BalancedClosing, AForceThatIsNotReachedIsReported) {
  EXPECT_THAT(warnings_of(balanced("grasp_cylinder_2", {"hand.grip_N=20"})),
              HasSubstr("hand: hand.grip_N is not reached: thumb"));
}

TEST(BalancedClosing, AForceWithoutItIsRefused) {
  const std::string error = refusal_by([] { load_scene(kFolder + "grasp_cylinder_2.toml", {{}, {"hand.grip_N=2"}}); });
  EXPECT_THAT(error, HasSubstr("hand.grip_N: has no effect on fingers that close to a depth; remove it or state"));
}

}  // namespace
}  // namespace palpate::test
