// Hulls as rigid pieces against finite-element nodes: their gap against boxes, the distance search and itself, and the
// forces of ticks against those of the closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "rt_core/tool/shapes.h"
#include "tests/nodal/nodal_scene.h"
#include "tests/support/convex_distance.h"

namespace palpate::test {
namespace {

constexpr double kHalf[3] = {0.011, 0.006, 0.008};
constexpr double kMargin_m = 0.001;
const double kPi2 = 2 * std::acos(-1.0);

PieceDesc hull_piece(std::vector<Vec3> corner, double margin_m = kMargin_m) {
  PieceDesc piece;
  piece.shape = PieceShape::kHull;
  piece.vertices_m = std::move(corner);
  piece.margin_m = margin_m;
  piece.points = 8;
  return piece;
}
// Outer sides 2 (half + margin), as of a box.
PieceDesc box_piece() {
  PieceDesc piece;
  piece.shape = PieceShape::kBox;
  piece.size_m = {2 * (kHalf[0] + kMargin_m), 2 * (kHalf[1] + kMargin_m), 2 * (kHalf[2] + kMargin_m)};
  piece.margin_m = kMargin_m;
  piece.points = 26;
  return piece;
}
std::vector<Vec3> box_corners() {
  std::vector<Vec3> corner;
  for (const double x : {-kHalf[0], kHalf[0]})
    for (const double y : {-kHalf[1], kHalf[1]})
      for (const double z : {-kHalf[2], kHalf[2]}) corner.push_back({x, y, z});
  return corner;
}
// About z, between which and its inscribed circle of radius r lies r (1 / cos(pi / n) - 1).
std::vector<Vec3> prism_corners(int n, double radius_m, double half_m) {
  std::vector<Vec3> corner;
  for (int k = 0; k < n; ++k)
    for (const double z : {-half_m, half_m}) {
      const double turn = kPi2 * (k + 0.5) / n, r = radius_m / std::cos(0.5 * kPi2 / n);
      corner.push_back({r * std::cos(turn), r * std::sin(turn), z});
    }
  return corner;
}
std::vector<Vec3> random_corners(std::mt19937& random, int n) {
  std::normal_distribution<double> any;
  std::vector<Vec3> corner;
  for (int k = 0; k < n; ++k) {
    const Vec3 u = unit_or({any(random), any(random), any(random)}, {1, 0, 0});
    corner.push_back({0.012 * u.x, 0.007 * u.y, 0.009 * u.z});
  }
  return corner;
}

TEST(HullGap, OfABoxsCornersIsTheBoxs) {
  const Tool hull = make_tool({hull_piece(box_corners())}), box = make_tool({box_piece()});
  EXPECT_EQ(hull.piece[0].face_count, 12);
  EXPECT_EQ(hull.piece[0].plane_count, 6);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-0.02, 0.02);
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 p{any(random), any(random), any(random)};
    const PieceGap a = piece_gap(hull.piece[0], p, hull.hull_face), b = piece_gap(box.piece[0], p);
    ASSERT_NEAR(a.gap_m, b.gap_m, 1e-16);
    ASSERT_NEAR(norm(a.normal - b.normal), 0, 1e-13);
  }
}

// Against GJK, which knows nothing of faces; the bound below which the node search skips a node is never above.
TEST(HullGap, IsTheDistanceOfItsCornersHull) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> any(-0.02, 0.02);
  for (const int corners : {4, 5, 8, 13, 30, 64}) {
    const Tool tool = make_tool({hull_piece(random_corners(random, corners))});
    Model model;
    model.hull_vertex_m = tool.hull_vertex_m;
    const ToolPiece& piece = tool.piece[0];
    EXPECT_EQ(piece.face_count, 2 * corners - 4);
    int outside = 0;
    for (int trial = 0; trial < 3000; ++trial) {
      const Vec3 p{any(random), any(random), any(random)};
      const ConvexDistance search = distance_piece_triangle(model, piece, Pose{}, {p, p, p});
      const PieceGap gap = piece_gap(piece, p, tool.hull_face);
      EXPECT_LE(least_gap(piece, p, tool.hull_face), gap.gap_m + 1e-15);
      if (search.overlap) {
        EXPECT_LE(gap.gap_m, -piece.margin_m + 1e-9);
        continue;
      }
      ++outside;
      // The search's stop, and the shift by which the baker splits coplanar corners.
      ASSERT_NEAR(gap.gap_m, search.distance_m - piece.margin_m, 2e-9);
    }
    EXPECT_GT(outside, 500);
  }
}

TEST(HullGap, FourAtATimeHaveTheBitsOfOne) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> any(-0.02, 0.02);
  const Tool tool = make_tool({hull_piece(random_corners(random, 20))});
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 p[4] = {{any(random), any(random), any(random)}, {0, 0, any(random)}, {}, {any(random), 0, 0}};
    const PieceGapOf<Vec3x4> four = piece_gap(tool.piece[0], load4(p), tool.hull_face);
    const Double4 least = least_gap(tool.piece[0], load4(p), tool.hull_face);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const PieceGap one = piece_gap(tool.piece[0], p[k], tool.hull_face);
      EXPECT_EQ(four.gap_m[k], one.gap_m);
      EXPECT_EQ(four.normal[k], one.normal);
      EXPECT_EQ(least[k], least_gap(tool.piece[0], p[k], tool.hull_face));
    }
  }
}

// A block of 60 x 30 x 60 mm on its foot, whose mesh is its own mirror image.
CondensedBody block() {
  const TetMesh mesh = make_mirrored_box_tets({0.060, 0.030, 0.060}, {8, 4, 8});
  return condense(mesh, {3e5, 0.45}, hold_where(mesh, [](Vec3 x) { return x.y < 1e-9; }), "block");
}
constexpr double kTop_m = 0.030;

class HullOnBlock : public testing::Test {
 protected:
  static void SetUpTestSuite() { body_ = new CondensedBody(block()); }
  static void TearDownTestSuite() { delete body_; }
  static const CondensedBody& body() { return *body_; }

 private:
  static inline CondensedBody* body_ = nullptr;
};

// Down, aside with friction, tilted and out again: the same forces as the box, through a coupling and without.
TEST_F(HullOnBlock, PressesSlidesAndTiltsAsTheBoxDoes) {
  NodalSceneOptions options;
  options.mu = 0.3;
  for (const Drive drive : {Drive::kTool, Drive::kDevice}) {
    NodalScene box(body(), {box_piece()}, options), hull(body(), {hull_piece(box_corners())}, options);
    const double above = kTop_m + kHalf[1] + kMargin_m;
    double largest_N = 0, apart_N = 0;
    for (int k = 0; k < 400; ++k) {
      const double depth = 0.003 * std::sin(0.5 * kPi2 * k / 400.0), aside = 0.004 * k / 400.0, tilt = 0.1 * k / 400.0;
      const Vec3 at{0.001 + aside, above - depth + 1e-4, -0.002};
      const Quat turn = normalised({1, 0.5 * tilt, 0, 0.3 * tilt});
      const Vec3 a = box.tick_at(at, drive, turn).contact_w.force_N,
                 b = hull.tick_at(at, drive, turn).contact_w.force_N;
      largest_N = std::max(largest_N, norm(a));
      apart_N = std::max(apart_N, norm(a - b));
      ASSERT_EQ(box.output().contacts, hull.output().contacts) << "tick " << k;
    }
    std::printf("hull of a box: %.3f N, apart by %.1e N\n", largest_N, apart_N);
    EXPECT_GT(largest_N, 1);
    EXPECT_LT(apart_N, 1e-9 * largest_N);
  }
}

// What the body's nodes get is what the tool gives, force and moment.
TEST_F(HullOnBlock, ActionIsReaction) {
  std::mt19937 random(14);
  NodalSceneOptions options;
  options.mu = 0.4;
  NodalScene scene(body(), {hull_piece(random_corners(random, 24))}, options);
  const Vec3 down{0.002, kTop_m + 0.004, 0.001};
  scene.move({0.002, kTop_m + 0.010, 0.001}, down, 40);
  scene.move(down, down + Vec3{0.002, 0, 0.001}, 40);
  const ContactProblem& p = problem_of(scene.scratch());
  Vec3 force, torque;
  for (std::int32_t i = 0; i < p.count; ++i) {
    force += p.node[i].force_w;
    torque += cross(p.node[i].arm_w, p.node[i].force_w);
  }
  const Output& out = scene.output();
  EXPECT_GT(norm(out.contact_w.force_N), 0.5);
  EXPECT_LT(norm(force + out.contact_w.force_N), 1e-6 * norm(force));
  EXPECT_LT(norm(torque + out.contact_w.torque_Nm), 1e-6 * 0.01 * norm(force));
}

// The tool's mirror image at the mirror image of its place feels the mirror image of the force.
TEST_F(HullOnBlock, MirrorImagesFeelMirrorImages) {
  std::mt19937 random(15);
  std::vector<Vec3> corner = random_corners(random, 16), mirrored = corner;
  for (Vec3& v : mirrored) v.x = -v.x;
  NodalScene left(body(), {hull_piece(corner)}, {}), right(body(), {hull_piece(mirrored)}, {});
  double largest_N = 0;
  for (int k = 0; k < 120; ++k) {
    const Vec3 at{0.003, kTop_m + 0.009 - 5e-5 * k, 0.002};
    const Vec3 a = left.tick_at(at).contact_w.force_N, b = right.tick_at({-at.x, at.y, at.z}).contact_w.force_N;
    largest_N = std::max(largest_N, norm(a));
    ASSERT_LT(norm(a - Vec3{-b.x, b.y, b.z}), 1e-7 * std::max(largest_N, 0.01)) << "tick " << k;
  }
  EXPECT_GT(largest_N, 0.5);
}

// Prisms around a cylinder approach its force from above, no farther than the corners stand out times the stiffness.
TEST_F(HullOnBlock, PrismsApproachTheirCylinder) {
  constexpr double kRadius_m = 0.008, kLength_m = 0.030;
  NodalScene round(body(), {cylinder_piece(kRadius_m + kMargin_m, kLength_m + 2 * kMargin_m, kMargin_m)}, {});
  const Vec3 start{0, kTop_m + kRadius_m + kMargin_m + 1e-4, 0}, end{0, start.y - 0.002, 0};
  round.move(start, end, 40);
  const double force_N = round.output().contact_w.force_N.y;
  const double stiff_N_per_m = round.state().contact_stiffness[7];
  ASSERT_GT(force_N, 1);
  double last = kHuge;
  for (const int n : {8, 16, 32}) {
    NodalScene prism(body(), {hull_piece(prism_corners(n, kRadius_m, 0.5 * kLength_m))}, {});
    prism.move(start, end, 40);
    const double more = prism.output().contact_w.force_N.y - force_N;
    const double stands_out_m = kRadius_m * (1 / std::cos(0.5 * kPi2 / n) - 1);
    std::printf("prism of %d sides: %.4f N beyond the cylinder's %.4f N\n", n, more, force_N);
    EXPECT_GT(more, -1e-9);
    EXPECT_LT(more, 1.5 * stiff_N_per_m * stands_out_m);
    EXPECT_LE(more, last);
    last = more;
  }
}

}  // namespace
}  // namespace palpate::test
