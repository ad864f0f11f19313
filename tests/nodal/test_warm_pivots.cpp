// How many active sets block principal pivoting tries per tick on the matrices of real bodies, started from the last
// tick's contacts: the paper's clip, the pinched block, a plate on a block (redundant nodes), a ball on a block. With
// friction a tick solves the normal problem twice, and both are counted. Bounds: measured 2026-11-21, see
// docs/models_contact_lcp.md, section 3.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "config/scene/scene.h"
#include "tests/nodal/nodal_scene.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

// Active sets tried in ticks that begin with contacts.
class Count {
 public:
  void add(const Scratch& scratch, const Output& output) {
    const int tried = problem_of(scratch).normal.pivots;
    contacts_ = std::max(contacts_, static_cast<int>(problem_of(scratch).count));
    if (warm_ && problem_of(scratch).count > 0) {
      ticks_ += 1;
      sum_ += tried;
      most_ = std::max(most_, tried);
      above_three_ += tried > 3 ? 1 : 0;
    }
    warm_ = output.contacts > 0;
    status_ |= output.status;
  }
  void report(const std::string& name) const {
    std::printf("%-34s %5d warm ticks, up to %2d nodes: mean %.2f, most %d, above three in %.2f %%\n", name.c_str(),
                ticks_, contacts_, static_cast<double>(sum_) / ticks_, most_, 100.0 * above_three_ / ticks_);
  }
  void expect(int most, double above_three) const {
    EXPECT_GE(ticks_, 40);
    EXPECT_LE(most_, most);
    EXPECT_LE(above_three_, above_three * ticks_);
    EXPECT_EQ(status_ & Status::kNotConverged, 0u);
  }

 private:
  bool warm_ = false;
  int ticks_ = 0, sum_ = 0, most_ = 0, above_three_ = 0, contacts_ = 0;
  std::uint64_t status_ = 0;
};

CondensedBody block(std::array<std::int32_t, 3> cells) {
  const TetMesh mesh = make_box_tets({0.024, 0.024, 0.024}, cells);
  return condense(mesh, {2e5, 0.45}, hold_where(mesh, [](Vec3 x) { return x.y < 1e-9; }), "block");
}
NodalSceneOptions soft(double mu) {
  NodalSceneOptions options;
  options.young_Pa = 2e5;
  options.mu = mu;
  return options;
}

// In and out again at 10 um a tick (10 mm/s), and at ten times that.
void press(NodalScene& scene, Vec3 from, Vec3 to, const std::string& name, int most, double above_three = 0) {
  for (const double step_m : {1e-5, 1e-4}) {
    scene.restart();
    Count count;
    const int ticks = static_cast<int>(std::lround(norm(to - from) / step_m));
    for (int k = 0; k <= 2 * ticks; ++k) {
      const double s = 1 - std::abs(static_cast<double>(k) / ticks - 1);
      scene.tick_at(from + s * (to - from));
      count.add(scene.scratch(), scene.output());
    }
    count.report(name + (step_m < 5e-5 ? ", 10 mm/s" : ", 100 mm/s"));
    count.expect(most, above_three);
  }
}

TEST(WarmPivots, ClipOverItsTube) {
  for (const double mu : {0.0, 0.2}) {
    const TetMesh mesh = make_clip_mesh(1);
    NodalSceneOptions options;
    options.young_Pa = 2e9;
    options.poisson = 0;
    options.mu = mu;
    NodalScene scene(condense(mesh, {2e9, 0}, clip_supports(mesh), "clip"), {cylinder_piece(0.010, 0.040, 0.001)},
                     options);
    const Vec3 from{0, 0.0142, 0}, to{0, 0.0002, 0};
    mu > 0 ? press(scene, from, to, "clip, mu 0.2", 6, 0.03) : press(scene, from, to, "clip", 3);
  }
}

TEST(WarmPivots, BallOnABlock) {
  for (const double mu : {0.0, 0.5}) {
    NodalScene scene(block({4, 4, 4}), {sphere_piece(0.010)}, soft(mu));
    const Vec3 from{0, 0.0341, 0}, to{0.001, 0.030, 0.0005};
    mu > 0 ? press(scene, from, to, "ball on a block, mu 0.5", 5, 0.03) : press(scene, from, to, "ball on a block", 3);
  }
}

TEST(WarmPivots, PlateOnABlock) {
  PieceDesc plate;
  plate.shape = PieceShape::kBox;
  plate.size_m = {0.060, 0.010, 0.060};
  plate.margin_m = 1e-3;
  plate.points = 8;
  for (const double mu : {0.0, 0.5}) {
    NodalScene scene(block({3, 3, 3}), {plate}, soft(mu));
    const Vec3 from{0, 0.0291, 0}, to{0, 0.027, 0};
    // All nodes of the face arrive at once; its rim then opens and closes.
    mu > 0 ? press(scene, from, to, "plate on a block, mu 0.5", 10, 0.30)
           : press(scene, from, to, "plate on a block", 4, 0.01);
  }
}

TEST(WarmPivots, PinchedBlock) {
  for (const bool rough : {false, true}) {
    SceneDesc desc = load_scene(PALPATE_SOURCE_DIR "/config/scenes/pinch_block_nodal.toml");
    if (!rough) desc.friction.law = FrictionLaw::kNone;
    const BakedScene scene(desc);
    Bench bench(scene.model());
    Count count;
    for (int k = 0; k < 3000; ++k) {
      bench.tick_at({{0, 0.020, 0}, {}}, closing_all(k < 1500 ? 1 : 0));
      count.add(*bench.scratch, bench.output);
    }
    count.report(rough ? "pinched block, mu 0.6" : "pinched block");
    rough ? count.expect(6, 0.01) : count.expect(3, 0);
  }
}

}  // namespace
}  // namespace palpate::test
