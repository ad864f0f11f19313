// Closed-form gaps of the tool's pieces against the project's own distance search and against their own slope.
#include <gtest/gtest.h>

#include <random>

#include "rt_core/tool/shapes.h"
#include "tests/support/convex_distance.h"

namespace palpate::test {
namespace {

ToolPiece piece_of(PieceShape shape, double a, double b, double c, double margin) {
  ToolPiece piece{};
  piece.shape = shape;
  piece.half_extent_m[0] = a;
  piece.half_extent_m[1] = b;
  piece.half_extent_m[2] = c;
  piece.margin_m = margin;
  return piece;
}

const ToolPiece kPieces[] = {
    piece_of(PieceShape::kSphere, 0, 0, 0, 0.010), piece_of(PieceShape::kCapsule, 0, 0, 0.012, 0.005),
    piece_of(PieceShape::kCylinder, 0.009, 0.009, 0.019, 0.001),
    piece_of(PieceShape::kCone, 0.008, 0.008, 0.010, 0.002), piece_of(PieceShape::kBox, 0.010, 0.006, 0.004, 0.001)};

TEST(PieceGap, IsTheDistanceOutside) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-0.03, 0.03);
  const Model model;
  for (const ToolPiece& piece : kPieces) {
    int outside = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      const Vec3 p{any(random), any(random), any(random)};
      const ConvexDistance search = distance_piece_triangle(model, piece, Pose{}, {p, p, p});
      const PieceGap gap = piece_gap(piece, p);
      EXPECT_NEAR(norm(gap.normal), 1, 1e-12);
      if (search.overlap) {
        EXPECT_LE(gap.gap_m, -piece.margin_m + 1e-9) << word_of(piece.shape);
        continue;
      }
      ++outside;
      // The search's bracket on curved cores is a millionth of the distance.
      EXPECT_NEAR(gap.gap_m, search.distance_m - piece.margin_m, 1e-6 * search.distance_m + 1e-9)
          << word_of(piece.shape);
      EXPECT_NEAR(dot(gap.normal, unit_or(search.on_triangle - search.on_piece, {})), 1, 1e-3) << word_of(piece.shape);
    }
    EXPECT_GT(outside, 500);
  }
}

// The search looks at four nodes at a time: the same bits as one by one, also on axes and bisectors.
TEST(PieceGap, FourAtATimeHaveTheBitsOfOne) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-0.02, 0.02);
  for (const ToolPiece& piece : kPieces) {
    for (int trial = 0; trial < 500; ++trial) {
      Vec3 p[4] = {{any(random), any(random), any(random)}, {0, 0, any(random)}, {}, {any(random), any(random), 0}};
      const PieceGapOf<Vec3x4> four = piece_gap(piece, load4(p));
      for (std::uint32_t k = 0; k < 4; ++k) {
        const PieceGap one = piece_gap(piece, p[k]);
        EXPECT_EQ(four.gap_m[k], one.gap_m) << word_of(piece.shape);
        EXPECT_EQ(four.normal[k], one.normal) << word_of(piece.shape);
      }
    }
  }
}

TEST(PieceGap, NormalIsItsSlopeInsideAndOutside) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> any(-0.02, 0.02);
  constexpr double h = 1e-8;
  for (const ToolPiece& piece : kPieces) {
    int checked = 0;
    for (int trial = 0; trial < 1000; ++trial) {
      const Vec3 p{any(random), any(random), any(random)};
      const PieceGap gap = piece_gap(piece, p);
      const PieceGap beside = piece_gap(piece, p + 1e-5 * Vec3{1, 1, 1});
      if (norm(gap.normal - beside.normal) > 0.01) continue;  // at a bisector the slope jumps
      const auto slope = [&](Vec3 e) {
        return (piece_gap(piece, p + h * e).gap_m - piece_gap(piece, p - h * e).gap_m) / (2 * h);
      };
      const Vec3 numeric{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
      EXPECT_LT(norm(numeric - gap.normal), 1e-5) << word_of(piece.shape);
      ++checked;
    }
    EXPECT_GT(checked, 700);
  }
}

TEST(PieceGap, KnownValues) {
  const PieceGap in_cylinder = piece_gap(kPieces[2], {0.008, 0, 0});
  EXPECT_NEAR(in_cylinder.gap_m, -0.002, 1e-15);  // 8 of 10 mm, margin included
  EXPECT_EQ(in_cylinder.normal, (Vec3{1, 0, 0}));
  EXPECT_NEAR(piece_gap(kPieces[4], {0, 0, 0.002}).gap_m, -0.003, 1e-15);
  EXPECT_NEAR(piece_gap(kPieces[3], {0, 0, 0.013}).gap_m, 0.001, 1e-12);  // above the apex
  EXPECT_EQ(piece_gap(kPieces[0], {}).gap_m, -0.010);                     // at the centre: some direction
}

}  // namespace
}  // namespace palpate::test
