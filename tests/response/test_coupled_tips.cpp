// Whole tips on an articulated tool, coupled through the body: where their regions lean.
#include <gtest/gtest.h>

#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

// Two balls that close on a rubber block, each with the law of its whole tip.
const char* const kGripTips = R"(
name = "grip_tips"
[body]
shape = "box"
size_mm = [40, 60, 40]
triangles = 1200
[body.material]
youngs_modulus_Pa = 3e6
poisson_ratio = 0.47
[skeleton]
law = "none"
[contact]
law = "tool"
cluster_distance_mm = 8
[coupling]
law = "coupled"
[friction]
law = "none"
[gripper]
closing_s = 0.2
stop_force_N = 5
[[tool.piece]]
shape = "sphere"
position_mm = [-26, 0, 0]
radius_mm = 7
slide_mm = [-20, 0, 0]
[[tool.piece]]
shape = "sphere"
position_mm = [26, 0, 0]
radius_mm = 7
slide_mm = [20, 0, 0]
)";

// Jaws move against one another, so the far field between their regions can only be constant if both lean on the body.
// In the tool's frame the fingers' far field would turn with the palm.
TEST(CoupledTips, OfAGripperLeanOnTheBody) {
  const BakedScene scene{std::string(kGripTips)};
  Bench bench(scene.model());
  const Pose around{{0, 0.01, 0.002}, {}};
  for (int i = 0; i < 400; ++i) bench.tick_at(around, closing_all(1));
  ASSERT_EQ(bench.output.regions, 2);
  Vec3 lean[kMaxRegions];
  int leaning = 0;
  for (int s = 0; s < kMaxRegions; ++s) {
    const Region& region = bench.state->region[s];
    if (region.id == 0) continue;
    lean[s] = region.lean_tool_m;
    leaning += 1;
    // On the block's side, where the tip first touched it, in the world: the tool's origin is 10 mm up.
    EXPECT_NEAR(std::abs(lean[s].x), 0.020, 1e-5);
    EXPECT_NEAR(lean[s].y, 0.01, 1e-4);
    EXPECT_NEAR(lean[s].z, 0.002, 1e-4);
    EXPECT_NEAR(std::abs(region.lean_normal_tool.x), 1, 1e-9);
  }
  EXPECT_EQ(leaning, 2);
  // And stay there when the tool goes elsewhere with them.
  const Pose aside{{0, 0.012, 0.001}, small_rotation({0.05, 0, 0})};
  for (int i = 0; i < 20; ++i) bench.tick_at(aside, closing_all(1));
  for (int s = 0; s < kMaxRegions; ++s) {
    if (bench.state->region[s].id != 0) {
      EXPECT_EQ(bench.state->region[s].lean_tool_m, lean[s]);
    }
  }
}

// Equal tips on opposite sides push equally, coupled through the body or not; the coupling changes by how much.
TEST(CoupledTips, OfAGripperPushEqually) {
  const BakedScene coupled{std::string(kGripTips)};
  std::string text = kGripTips;
  text.replace(text.find("\"coupled\""), 9, "\"none\"");
  const BakedScene alone{text};
  Bench with(coupled.model()), without(alone.model());
  for (int i = 0; i < 400; ++i) {
    with.tick_at({{0, 0.01, 0}, {}}, closing_all(1));
    without.tick_at({{0, 0.01, 0}, {}}, closing_all(1));
    ASSERT_LT(norm(with.output.contact_w.force_N), 1e-9);
  }
  ASSERT_EQ(with.output.regions, 2);
  EXPECT_GT(norm(with.state->articulation.piece_force_tool_N[0]), 0.1);
  EXPECT_NE(norm(with.state->articulation.piece_force_tool_N[0]),
            norm(without.state->articulation.piece_force_tool_N[0]));
}

}  // namespace
}  // namespace palpate::test
