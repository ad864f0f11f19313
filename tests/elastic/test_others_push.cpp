// A tip that the others' forces bring into contact: the body bulges towards it by its linear modes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rt_core/contact/regions.h"
#include "rt_core/status.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

// A ball presses a block's top, another one of the same tool stands beside the block, a gap from its side at rest.
std::string block_scene(double gap_mm) {
  std::string scene = elastic_scene("shape = \"box\"\nsize_mm = [40, 40, 40]\n", 1, 8, 6, 5);
  const std::size_t tool = scene.find("[[tool.piece]]"), device = scene.find("[device]");
  scene.replace(
      tool, device - tool,
      "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n"
      "position_mm = [" +
          number(28 + gap_mm) + ", -20, 0]\npart = 1\n\n");
  return scene;
}

// Force of the region that is pressed towards +x.
double side_N(const Bench& bench) {
  double force = 0;
  for (const Region& region : bench.state->region)
    if (is_in_contact(region) && region.normal_w.x > 0.7) force = region.normal_force_N;
  return force;
}

// The side comes out by more than the gap as the top is pressed, and the second ball's force grows from nothing: a
// micron of depth is 20 mN at most on the stiffest ball here, of which a tick goes 2 um. Told to touch by the soft
// mode's surface alone, it had no force in the press, and all of it at once in the slide.
TEST(OthersPush, ATipThatTheBodyBulgesTowardsIsTouchedFromNoForceOn) {
  const BakedScene baked(block_scene(0.05));
  Bench bench(baked.model());
  double before = 0, step = 0;
  const auto go = [&](Vec3 from, Vec3 to) {
    const int steps = static_cast<int>(norm(to - from) / 2e-6);
    for (int i = 0; i <= steps; ++i) {
      bench.tick_at({from + (static_cast<double>(i) / steps) * (to - from), {}}, {});
      EXPECT_EQ(bench.output.status & Status::kNotConverged, 0u);
      step = std::max(step, std::abs(side_N(bench) - before));
      before = side_N(bench);
    }
  };
  go({0, 0.0481, 0}, {0, 0.044, 0});
  const double pressed_N = before;
  go({0, 0.044, 0}, {-2e-4, 0.044, 0});
  RecordProperty("pressed_N", std::to_string(pressed_N));
  RecordProperty("slid_N", std::to_string(before));
  RecordProperty("step_N", std::to_string(step));
  EXPECT_GT(pressed_N, 0.02);
  EXPECT_GT(before, pressed_N);
  EXPECT_LT(step, 0.04);
}

}  // namespace
}  // namespace palpate::test
