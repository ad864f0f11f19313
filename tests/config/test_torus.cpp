// The torus piece: Pappus' area and volume, an open hole, and a ring pushed over a post that touches nothing.
#include <gtest/gtest.h>

#include "config/bake/tool_points.h"
#include "rt_core/tool/shapes.h"
#include "tests/support/baked_scene.h"

namespace palpate {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kCircle = 0.0075, kTube = 0.0025;

PieceDesc torus() {
  PieceDesc piece;
  piece.shape = PieceShape::kTorus;
  piece.radius_m = kCircle + kTube;
  piece.points = 36;
  return piece;
}

TEST(Torus, AreaAndVolumeArePappus) {
  const Tool tool = make_tool({torus()});
  double area = 0, volume = 0;
  for (const SurfaceSample& s : surface_samples(piece_core(torus()))) {
    area += s.area_m2;
    volume += s.area_m2 * dot(piece_gap(tool.piece[0], s.position_m).normal, s.position_m) / 3;
  }
  EXPECT_NEAR(area, 4 * kPi * kPi * kCircle * kTube, 1e-9 * area);
  EXPECT_NEAR(volume, 2 * kPi * kPi * kCircle * kTube * kTube, 1e-3 * volume);  // 168 bands around the tube
}

TEST(Torus, TheHoleIsOpen) {
  const ToolPiece piece = make_tool({torus()}).piece[0];
  EXPECT_NEAR(piece_gap(piece, {0, 0, 0}).gap_m, kCircle - kTube, 1e-15);
  EXPECT_NEAR(piece_gap(piece, {0.001, 0, 0}).gap_m, kCircle - kTube - 0.001, 1e-15);
  EXPECT_NEAR(piece_gap(piece, {0.001, 0, 0}).normal.x, -1, 1e-12);  // out of the tube, towards the axis
  EXPECT_NEAR(piece_gap(piece, {kCircle, 0, 0}).gap_m, -kTube, 1e-15);
  EXPECT_NEAR(piece_gap(piece, {kCircle, 0, 0.004}).gap_m, 0.004 - kTube, 1e-15);
}

// A post of 3 mm passes through the hole of 10 mm: no contact. Moved aside by 4 mm the ring presses its flank.
TEST(Torus, RingOverAPost) {
  const test::BakedScene scene(
      "name = \"s\"\n[body]\nshape = \"cylinder\"\nradius_mm = 3\nheight_mm = 40\ntriangles = 800\n"
      "[[tool.piece]]\nshape = \"torus\"\nradius_mm = 10\nrotation_deg = [90, 0, 0]\npoints = 36\n");
  test::Bench bench(scene.model());
  for (int i = 0; i < 200; ++i) {
    const Output& out = bench.tick_at({{0, 0.060 - 0.0002 * i, 0}, {}}, {});
    ASSERT_EQ(out.contacts, 0) << "tick " << i;
    ASSERT_EQ(norm(out.contact_w.force_N), 0);
  }
  for (int i = 0; i < 200; ++i) bench.tick_at({{-0.00002 * i, 0.020, 0}, {}}, {});
  EXPECT_GT(bench.output.contacts, 0);
  EXPECT_GT(bench.output.contact_w.force_N.x, 0.01);  // the post pushes the ring back over itself
}

}  // namespace
}  // namespace palpate
