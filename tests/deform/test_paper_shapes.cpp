// The shapes that the circular-beam paper (2009) draws, half shell (Fig. 7) and ring (Fig. 9).
#include <gtest/gtest.h>

#include <cmath>

#include "sim_host/view/surface_shape.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

// The scene with its tool where the path presses it in, and every vertex's displacement there.
struct Pressed {
  Pressed(const std::string& name, const SceneOverlays& laws)
      : scene(load_scene(kScenes + name + ".toml", laws)), baked(scene) {
    constexpr int kTicks = 2000;
    Bench bench(baked.model());
    // The second point of either path is 1 mm clear of the body; 2.4 mm deep is where the device's hand comes to rest.
    const Vec3 from = scene.path.point[1].position_m, to = from - Vec3{0, 0.0034, 0};
    for (int k = 0; k <= kTicks; ++k)
      force_N = norm(bench.tick_at({from + (1.0 * k / kTicks) * (to - from), {}}, {}).contact_w.force_N);
    contact_w = bench.state->region[0].centre_w;
    ShapeField field;
    prepare_shape(baked.model(), *bench.state, field);
    for (std::size_t v = 0; v < baked.model().vertex_m.size(); ++v)
      moved_m.push_back(displacement_at(baked.model(), field, baked.model().vertex_m[v], static_cast<std::int32_t>(v)));
  }
  Vec3 at_m(std::size_t v) const { return baked.model().vertex_m[v]; }

  inline static const std::string kScenes = std::string(PALPATE_SOURCE_DIR) + "/config/scenes/";
  inline static const SceneOverlays kPrinted{{kScenes + "laws/circular_beams_2009.toml"}, {}};
  SceneDesc scene;
  BakedScene baked;
  double force_N = 0;
  Vec3 contact_w;
  std::vector<Vec3> moved_m;
};

// Mean size of the displacement of vertices between two distances from the contact.
double mean_moved_m(const Pressed& pressed, double from_m, double to_m) {
  double sum = 0;
  int count = 0;
  for (std::size_t v = 0; v < pressed.moved_m.size(); ++v) {
    const double away = norm(pressed.at_m(v) - pressed.contact_w);
    if (away < from_m || away >= to_m) continue;
    sum += norm(pressed.moved_m[v]);
    ++count;
  }
  return sum / count;
}

// Fig. 7: a dent under the rod that fades out, and a shell that gives as a whole, less and less away from it; the rim
// stands still.
TEST(PaperShapes, TheHalfShellIsDentedAndGivesAsAWhole) {
  const Pressed pressed("half_shell_paper", {});
  ASSERT_GT(pressed.force_N, 1);
  double before = kHuge;
  for (const double from_m : {0.0, 0.008, 0.016, 0.03, 0.05}) {
    const double moved = mean_moved_m(pressed, from_m, from_m + 0.008);
    EXPECT_LT(moved, before) << from_m;
    EXPECT_GT(moved, 1e-6) << from_m;
    before = moved;
  }
  double rim = 0;
  for (std::size_t v = 0; v < pressed.moved_m.size(); ++v)
    if (pressed.at_m(v).y < 1e-3) rim = std::max(rim, norm(pressed.moved_m[v]));
  EXPECT_LT(rim, 1e-5);
}

// Fig. 9: the top goes down, the sides go outwards, as mirror images.
TEST(PaperShapes, TheRingGetsLowerAndWider) {
  for (const SceneOverlays& laws : {SceneOverlays{}, Pressed::kPrinted}) {
    const Pressed pressed("ring_paper", laws);
    ASSERT_GT(pressed.force_N, 1);
    double top = 0, left = 0, right = 0;
    for (std::size_t v = 0; v < pressed.moved_m.size(); ++v) {
      top = std::min(top, pressed.moved_m[v].y);
      right = std::max(right, pressed.moved_m[v].x);
      left = std::min(left, pressed.moved_m[v].x);
    }
    EXPECT_LT(top, -1e-3);
    EXPECT_GT(right, 1e-6);
    EXPECT_NEAR(right, -left, 1e-9);
  }
}

}  // namespace
}  // namespace palpate::test
