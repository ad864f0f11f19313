// An elastic body that is turned, moved, or held elsewhere than on its base.
#include <gtest/gtest.h>

#include "tests/elastic/elastic_tick_scene.h"

namespace palpate {
namespace {

using namespace test;

// A block of 40 x 30 x 40 mm whose lower 2 mm are held, wherever it is put.
std::string block_scene(const std::string& place, const std::string& fixed) {
  std::string text = elastic_scene("shape = \"box\"\nsize_mm = [40, 30, 40]\ntriangles = 800\n" + place, 2, 10, 8, 4);
  const std::size_t from = text.find("[body.fixed]"), to = text.find("[body.fem]");
  return text.replace(from, to - from, fixed);
}

// The elements of a box turn with it: what differs is rounding, which single-precision tables make 1e-6 of the force.
TEST(ElasticPlacement, ATurnedBodyGivesTheTurnedForce) {
  const BakedScene standing(block_scene("", "[body.fixed]\nbase_height_mm = 2\n"));
  // Turned by -90 degrees about z, then moved: what was up is along x.
  const BakedScene lying(
      block_scene("position_mm = [50, 20, 10]\nrotation_deg = [0, 0, -90]\n",
                  "[body.fixed]\nregion = \"box\"\nfrom_mm = [49, -10, -20]\nto_mm = [52, 50, 40]\n"));
  Bench up(standing.model()), along(lying.model());
  const Vec3 place{0.05, 0.02, 0.01};
  const auto turned = [](Vec3 v) { return Vec3{v.y, -v.x, v.z}; };
  const Vec3 from{0.004, 0.038, 0.003}, to{0.004, 0.035, 0.003};
  const Vec3 force = move_to(up, from, to).contact_w.force_N;
  const Vec3 other = move_to(along, place + turned(from), place + turned(to)).contact_w.force_N;
  EXPECT_GT(norm(force), 5);
  EXPECT_LT(norm(other - turned(force)), 1e-4 * norm(force)) << norm(other) << " against " << norm(force);
}

// An arch held at both feet by two boxes is the one held by its base, where the boxes hold the same nodes; without one
// foot it is a hook that gives many times more.
TEST(ElasticPlacement, TwoFeetCarryAnArchAndOneDoesNot) {
  const std::string base = elastic_scene(arch(10), 35, 9, 8, 4);
  const auto held = [&](const std::string& fixed) {
    std::string text = base;
    const std::size_t from = text.find("[body.fixed]"), to = text.find("[body.fem]");
    return text.replace(from, to - from, fixed);
  };
  const std::string left = "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [-40, -1, -40]\nto_mm = [0, 35, 40]\n";
  const std::string right = "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [0, -1, -40]\nto_mm = [40, 35, 40]\n";
  const Vec3 top{0, 0.078, 0};
  const double by_base = press_N(BakedScene(base).model(), top, 2e-3);
  const double by_two = press_N(BakedScene(held(left + right)).model(), top, 2e-3);
  const double by_one = press_N(BakedScene(held(left)).model(), top, 2e-3);
  EXPECT_NEAR(by_two / by_base, 1, 4e-3);  // 1.5e-3 on 2026-11-27: nodes within the feet stand elsewhere
  EXPECT_LT(by_one, 0.5 * by_base);
  EXPECT_GT(by_one, 0);
}

}  // namespace
}  // namespace palpate
