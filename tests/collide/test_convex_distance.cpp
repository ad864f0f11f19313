#include "tests/support/convex_distance.h"

#include <gtest/gtest.h>

#include <limits>

#include "rt_core/tool/shapes.h"
#include "tests/collide/pieces.h"

namespace palpate::test {
namespace {

TEST(Support, IsTheFarthestPointOfTheCore) {
  std::mt19937_64 rng(1);
  for (const ToolPiece& piece : all_pieces()) {
    for (int i = 0; i < 200; ++i) {
      const Vec3 d = random_unit(rng);
      const Vec3 s = core_support(piece, {}, 1e3 * d);
      EXPECT_LT(distance_to_core(piece, s), 1e-15);                        // on the core
      EXPECT_NEAR(norm(s - core_support(piece, {}, 1e-6 * d)), 0, 1e-15);  // length of the direction does not matter
      for (int j = 0; j < 50; ++j) {
        Vec3 p = random_vec(rng, 0.012);
        if (distance_to_core(piece, p) > 0) continue;
        EXPECT_LE(dot(p, d), dot(s, d) + 1e-15);
      }
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(is_finite(core_support(piece, {}, {0, 0, 0})));
    EXPECT_TRUE(is_finite(core_support(piece, {}, {nan, nan, nan})));
  }
}

TEST(ConvexDistance, AnalyticCases) {
  const Model model;
  const Vec3 floor[3] = {{-0.1, -0.1, 0}, {0.2, -0.1, 0}, {-0.1, 0.2, 0}};
  const auto distance = [&](const ToolPiece& piece, double height) {
    return distance_piece_triangle(model, piece, {{0, 0, height}, {}}, floor);
  };
  EXPECT_DOUBLE_EQ(distance(all_pieces()[0], 0.02).distance_m, 0.02);
  EXPECT_NEAR(distance(all_pieces()[1], 0.02).distance_m, 0.012, 1e-15);
  EXPECT_NEAR(distance(all_pieces()[2], 0.02).distance_m, 0.011, 1e-15);
  EXPECT_NEAR(distance(all_pieces()[3], 0.02).distance_m, 0.014, 1e-15);
  EXPECT_NEAR(distance(all_pieces()[4], 0.02).distance_m, 0.017, 1e-15);
  EXPECT_TRUE(distance(all_pieces()[4], 0.002).overlap);
  EXPECT_EQ(distance(all_pieces()[4], 0.002).distance_m, 0);
  // Cone tip down: the tip is the nearest point.
  const ConvexDistance tip = distance_piece_triangle(model, all_pieces()[3], {{0, 0, 0.02}, {0, 1, 0, 0}}, floor);
  EXPECT_NEAR(tip.distance_m, 0.014, 1e-15);
  EXPECT_NEAR(norm(tip.on_piece - Vec3{0, 0, 0.014}), 0, 1e-12);
}

TEST(ConvexDistance, MatchesTheNestedSearchOracle) {
  // Bracket of curved cores after 32 steps: below 1e-6 of the distance for every pair of this set.
  const Model model;
  std::mt19937_64 rng(2);
  double worst = 0;
  int overlaps = 0;
  for (const ToolPiece& piece : all_pieces()) {
    for (int i = 0; i < 300; ++i) {
      const Pose pose{random_vec(rng, 0.02), random_rotation(rng)};
      const Vec3 t[3] = {random_vec(rng, 0.02), random_vec(rng, 0.02), random_vec(rng, 0.02)};
      const ConvexDistance d = distance_piece_triangle(model, piece, pose, t);
      const double oracle = distance_oracle(piece, pose, t);
      ASSERT_NEAR(d.distance_m, oracle, 1e-8) << "shape " << word_of(piece.shape) << " pair " << i;
      ASSERT_LE(d.lower_bound_m, oracle + 1e-9);
      ASSERT_LE(d.iterations, kClosestPointIterations);
      if (d.overlap) {
        ++overlaps;
        continue;
      }
      ASSERT_NEAR(norm(d.on_piece - d.on_triangle), d.distance_m, 1e-12);
      ASSERT_LT(distance_to_core(piece, inverse_transform(pose, d.on_piece)), 1e-12);
      worst = std::max(worst, (d.distance_m - d.lower_bound_m) / d.distance_m);
    }
  }
  EXPECT_GT(overlaps, 50);
  EXPECT_LT(worst, 1e-5);
  RecordProperty("worst_bracket", std::to_string(worst));
}

TEST(ConvexDistance, AHullOfABoxIsTheBox) {
  std::mt19937_64 rng(3);
  std::vector<Vec3> corners = box({8e-3, 5e-3, 3e-3}).vertex;
  corners.insert(corners.begin(), Vec3{9, 9, 9});  // another piece's vertex: must not be looked at
  Model model;
  model.hull_vertex_m = corners;
  ToolPiece hull = piece_of(PieceShape::kHull, 0, 0, 0, 1e-3);
  hull.first_hull = 1;
  hull.hull_count = 8;
  for (int i = 0; i < 500; ++i) {
    const Pose pose{random_vec(rng, 0.02), random_rotation(rng)};
    const Vec3 t[3] = {random_vec(rng, 0.02), random_vec(rng, 0.02), random_vec(rng, 0.02)};
    ASSERT_NEAR(distance_piece_triangle(model, hull, pose, t).distance_m,
                distance_piece_triangle(model, all_pieces()[4], pose, t).distance_m, 1e-14);
  }
}

TEST(ConvexDistance, DegenerateAndBadInput) {
  const Model model;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ToolPiece& piece : all_pieces()) {
    const Vec3 p{0.03, 0.01, 0.02};
    const Vec3 point[3] = {p, p, p}, segment[3] = {p, p, {0.04, 0, 0}};
    EXPECT_NEAR(distance_piece_triangle(model, piece, {}, point).distance_m, distance_to_core(piece, p), 1e-12);
    EXPECT_NEAR(distance_piece_triangle(model, piece, {}, segment).distance_m, distance_oracle(piece, {}, segment),
                1e-9);
    const Vec3 bad[3] = {p, {nan, 0, 0}, p};
    EXPECT_EQ(distance_piece_triangle(model, piece, {}, bad).distance_m, kHuge);
    EXPECT_FALSE(distance_piece_triangle(model, piece, {{nan, 0, 0}, {}}, point).overlap);
  }
}

}  // namespace
}  // namespace palpate::test
