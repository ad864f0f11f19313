#include "rt_core/surface/overlap.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/collide/pieces.h"
#include "tests/support/convex_distance.h"

namespace palpate::test {
namespace {

TEST(Overlap, AgreesWithTheDistanceOn20000RandomPairs) {
  const Model model;
  std::mt19937_64 rng(4);
  int hits = 0, most_calls = 0, inconclusive = 0;
  for (int i = 0; i < 20000; ++i) {
    ToolPiece piece = all_pieces()[i % 5];
    piece.pose_tool = {random_vec(rng, 5e-3), random_rotation(rng)};
    const Pose tool{random_vec(rng, 0.02), random_rotation(rng)};
    const Vec3 t[3] = {random_vec(rng, 0.02), random_vec(rng, 0.02), random_vec(rng, 0.02)};
    const OverlapResult result = overlap_piece_triangle(model, piece, tool, t);
    most_calls = std::max(most_calls, result.support_calls);
    ASSERT_LE(result.support_calls, kGjkSupportBudget + kMostSupportsBeyond);
    const ConvexDistance d = distance_piece_triangle(model, piece, tool * piece.pose_tool, t);
    if (result.overlap == Overlap::kInconclusive) {
      ++inconclusive;
      continue;
    }
    // Within 1 um of touching either answer is right.
    if (abs_of(d.distance_m - piece.margin_m) < 1e-6) continue;
    ASSERT_EQ(result.overlap == Overlap::kHit, d.distance_m < piece.margin_m)
        << "shape " << word_of(piece.shape) << " pair " << i << " distance " << d.distance_m << " margin "
        << piece.margin_m;
    hits += result.overlap == Overlap::kHit ? 1 : 0;
  }
  EXPECT_GT(hits, 3000);
  EXPECT_LT(hits, 16000);
  EXPECT_LE(inconclusive, 2);  // measured 2026-11-21: none
  RecordProperty("most_calls", most_calls);
}

TEST(Overlap, DegeneratePairsStayWithinTheBudget) {
  // Flat and lattice shapes, where libccd's other routines were seen to loop for ever, and pairs far from the origin.
  std::mt19937_64 rng(5);
  std::uniform_int_distribution<int> lattice(-1, 1);
  const auto corner = [&](double s) {
    return s * Vec3{double(lattice(rng)), double(lattice(rng)), double(lattice(rng))};
  };
  std::vector<Vec3> vertex(4);
  Model model;
  model.hull_vertex_m = vertex;
  ToolPiece hull = piece_of(PieceShape::kHull, 0, 0, 0, 0);
  hull.hull_count = 4;
  for (int i = 0; i < 100000; ++i) {
    const double size = i % 4 == 0 ? 9.4433585460113072e-3 : i % 4 == 1 ? 1e-9 : i % 4 == 2 ? 1e3 : 1.0;
    for (Vec3& v : vertex) v = corner(size);
    const Vec3 t[3] = {corner(size), corner(size), corner(size)};
    const OverlapResult result = overlap_piece_triangle(model, hull, {}, t);
    ASSERT_LE(result.support_calls, kGjkSupportBudget + kMostSupportsBeyond);
  }
}

TEST(Overlap, ASpentBudgetIsInconclusiveNeverAMiss) {
  const Model model;
  std::mt19937_64 rng(6);
  int fired = 0;
  for (int i = 0; i < 2000; ++i) {
    const ToolPiece& piece = all_pieces()[i % 5];
    const Pose tool{random_vec(rng, 0.005), random_rotation(rng)};
    const Vec3 t[3] = {random_vec(rng, 0.01), random_vec(rng, 0.01), random_vec(rng, 0.01)};
    const OverlapResult full = overlap_piece_triangle(model, piece, tool, t);
    const OverlapResult tiny = overlap_piece_triangle(model, piece, tool, t, 4);
    ASSERT_LE(tiny.support_calls, 4 + 2);
    if (tiny.overlap == Overlap::kInconclusive) {
      ++fired;
    } else {
      ASSERT_EQ(tiny.overlap, full.overlap);
    }
  }
  EXPECT_GT(fired, 500);
}

TEST(Overlap, BadInputIsInconclusive) {
  const Model model;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3 t[3] = {{0, 0, 0}, {1e-2, 0, 0}, {0, 1e-2, 0}}, bad[3] = {{nan, 0, 0}, {1e-2, 0, 0}, {0, 1e-2, 0}};
  for (const ToolPiece& piece : all_pieces()) {
    EXPECT_EQ(overlap_piece_triangle(model, piece, {{0, nan, 0}, {}}, t).overlap, Overlap::kInconclusive);
    EXPECT_EQ(overlap_piece_triangle(model, piece, {}, bad).overlap, Overlap::kInconclusive);
    EXPECT_EQ(overlap_piece_triangle(model, piece, {{1e11, 0, 0}, {}}, t).overlap, Overlap::kInconclusive);
  }
}

}  // namespace
}  // namespace palpate::test
