// The shipped scene of two jaws that pinch a block of finite elements, ticked through its own hand path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "config/scene/scene.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

SceneDesc pinch_scene() { return load_scene(PALPATE_SOURCE_DIR "/config/scenes/pinch_block_nodal.toml"); }

struct Seen {
  int both = 0, single = 0;  // ticks with two regions, with one
  double lift_N = 0, sideways_N = 0, squeeze_N = 0;
  double residual_m = 0;
  std::uint64_t status = 0, hash = 0;
};

// The scene's own path, joined by straight lines, the tool held on it.
Seen play(const BakedScene& scene, const SceneDesc& desc) {
  Bench bench(scene.model());
  Seen seen;
  double closing = 0;
  for (std::size_t n = 0; n + 1 < desc.path.point.size(); ++n) {
    const PathPoint &a = desc.path.point[n], &b = desc.path.point[n + 1];
    if (!a.closing.empty()) closing = a.closing[0];
    const double to = b.closing.empty() ? closing : b.closing[0];
    const int ticks = static_cast<int>(std::lround(1e3 * (b.time_s - a.time_s)));
    for (int k = 0; k < ticks; ++k) {
      const double s = static_cast<double>(k) / ticks;
      const Output& o = bench.tick_at({a.position_m + s * (b.position_m - a.position_m), {}},
                                      closing_all(closing + s * (to - closing)));
      seen.both += o.regions == 2 ? 1 : 0;
      seen.single += o.regions == 1 ? 1 : 0;
      seen.status |= o.status;
      seen.residual_m = std::max(seen.residual_m, o.residual_m);
      seen.lift_N = std::max(seen.lift_N, -o.contact_w.force_N.y);
      seen.sideways_N = std::max(seen.sideways_N, -o.contact_w.force_N.x);
      for (std::int32_t j = 0; j < 2; ++j)
        seen.squeeze_N = std::max(seen.squeeze_N, norm(bench.state->articulation.piece_force_tool_N[j]));
    }
  }
  seen.hash = hash_state(*bench.state);
  return seen;
}

TEST(Pinch, TheScenesPathPinchesLiftsAndLetsGo) {
  const SceneDesc desc = pinch_scene();
  const BakedScene scene(desc);
  const Seen seen = play(scene, desc);
  std::printf("pinch: %d ticks with both jaws, squeeze %.2f N, lift %.2f N, sideways %.2f N, residual %.1e m\n",
              seen.both, seen.squeeze_N, seen.lift_N, seen.sideways_N, seen.residual_m);
  EXPECT_GT(seen.both, 3000);
  EXPECT_LT(seen.single, 100);  // both jaws arrive and leave together
  EXPECT_GT(seen.squeeze_N, 3);
  EXPECT_GT(seen.lift_N, 1);  // friction holds the block while it is tugged upwards
  EXPECT_EQ(seen.status & (Status::kNotConverged | Status::kContactsDropped | Status::kRegionsDropped), 0u);
  EXPECT_EQ(seen.hash, play(scene, desc).hash);
}

// One jaw alone pushes the block aside; with the other behind it the same place meets more force: the jaws feel each
// other through the block.
TEST(Pinch, JawsFeelEachOtherThroughTheBlock) {
  SceneDesc alone = pinch_scene();
  alone.piece[1].slide_m.x = -1.0;  // the other jaw stays far away
  double force[2] = {};
  for (int two = 0; two < 2; ++two) {
    const BakedScene scene(two == 0 ? alone : pinch_scene());
    Bench bench(scene.model());
    for (int k = 0; k < 1000; ++k) bench.tick_at({{0, 0.020, 0}, {}}, closing_all(0.8));
    force[two] = norm(bench.state->articulation.piece_force_tool_N[0]);
    EXPECT_EQ(bench.output.regions, 1 + two);
  }
  std::printf("pinch: one jaw %.3f N, both %.3f N each\n", force[0], force[1]);
  EXPECT_GT(force[1], 1.1 * force[0]);
}

}  // namespace
}  // namespace palpate::test
