// Tool points: on the core, symmetric, areas that sum to the piece's touching surface, and an honest coverage figure.
#include <gtest/gtest.h>

#include <cmath>

#include "config/bake/tool_points.h"
#include "config/scene/config_error.h"

namespace palpate {
namespace {

PieceDesc piece(PieceShape shape, std::int32_t points) {
  PieceDesc p;
  p.shape = shape;
  p.points = points;
  return p;
}
PieceDesc cylinder(double radius, double length, double margin, std::int32_t points) {
  PieceDesc p = piece(PieceShape::kCylinder, points);
  p.radius_m = radius;
  p.length_m = length;
  p.margin_m = margin;
  return p;
}
double area_sum(const Tool& tool) {
  double sum = 0;
  for (const ToolPoint& p : tool.point) sum += p.area_m2;
  return sum;
}

TEST(ToolPoints, SphereIsItsCentre) {
  PieceDesc p = piece(PieceShape::kSphere, 1);
  p.radius_m = 0.005;
  p.position_m = {1, 2, 3};
  const Tool tool = make_tool({p});
  ASSERT_EQ(tool.point.size(), 1u);
  EXPECT_EQ(tool.point[0].position_tool_m, (Vec3{1, 2, 3}));
  EXPECT_DOUBLE_EQ(tool.point[0].margin_m, 0.005);
  EXPECT_NEAR(area_sum(tool), 4 * kPi * 25e-6, 1e-12 * 4 * kPi * 25e-6);
  EXPECT_NEAR(tool.gap_m[0], 0, 1e-12);
  EXPECT_DOUBLE_EQ(tool.piece[0].bounding_radius_m, 0.005);
}

TEST(ToolPoints, CapsuleIsASegment) {
  PieceDesc p = piece(PieceShape::kCapsule, 5);
  p.radius_m = 0.004;
  p.length_m = 0.040;
  const Tool tool = make_tool({p});
  ASSERT_EQ(tool.point.size(), 5u);
  const double exact = 2 * kPi * 0.004 * 0.032 + 4 * kPi * 16e-6;
  EXPECT_NEAR(area_sum(tool), exact, 1e-12 * exact);
  EXPECT_DOUBLE_EQ(tool.point[0].position_tool_m.z, -0.016);
  EXPECT_DOUBLE_EQ(tool.point[4].position_tool_m.z, 0.016);
  EXPECT_NEAR(tool.point[0].area_m2, tool.point[4].area_m2, 1e-12 * exact);
  EXPECT_NEAR(tool.point[1].area_m2, 2 * kPi * 0.004 * 0.008, 0.01 * exact);
  // Midway between spheres 8 mm apart the surface is sqrt(4^2 + 4^2) - 4 mm away; samples are 0.19 mm apart.
  EXPECT_NEAR(tool.gap_m[0], std::sqrt(32e-6) - 0.004, 1e-4);
}

TEST(ToolPoints, OneEndOfACapsuleIsItsHemisphere) {
  PieceDesc p = piece(PieceShape::kCapsule, 1);
  p.radius_m = 0.003;
  p.length_m = 0.060;
  p.touches = TouchingEnd::kMinusZ;
  const Tool tool = make_tool({p});
  ASSERT_EQ(tool.point.size(), 1u);
  EXPECT_NEAR(tool.point[0].position_tool_m.z, -0.027, 1e-15);
  EXPECT_NEAR(area_sum(tool), 2 * kPi * 9e-6, 1e-12 * 2 * kPi * 9e-6);
  EXPECT_NEAR(tool.gap_m[0], 0, 1e-12);
}

// Rounded cylinder: two discs, two quarter tori 2 pi m (r pi/2 + m), and the side.
TEST(ToolPoints, CylinderAreaIsExact) {
  const double r = 0.006, m = 0.006, h = 0.006;
  const Tool tool = make_tool({cylinder(r + m, 2 * (h + m), m, 40)});
  const double end = kPi * r * r + 2 * kPi * m * (r * kPi / 2 + m);
  const double exact = 2 * end + 2 * kPi * (r + m) * 2 * h;
  EXPECT_NEAR(area_sum(tool), exact, 1e-12 * exact);
  EXPECT_LE(tool.point.size(), 40u);
  EXPECT_GE(tool.point.size(), 30u);
  PieceDesc face = cylinder(r + m, 2 * (h + m), m, 19);
  face.touches = TouchingEnd::kMinusZ;
  const Tool one = make_tool({face});
  EXPECT_EQ(one.point.size(), 19u);
  EXPECT_NEAR(area_sum(one), end, 1e-12 * end);
  EXPECT_LT(one.gap_m[0], 0.5e-3);
  for (const ToolPoint& p : one.point) EXPECT_DOUBLE_EQ(p.position_tool_m.z, -h);
}

// A symmetric head pressed straight gives no torque: the area-weighted points balance.
TEST(ToolPoints, FaceIsBalanced) {
  PieceDesc face = cylinder(0.012, 0.024, 0.006, 19);
  face.touches = TouchingEnd::kMinusZ;
  const Tool tool = make_tool({face});
  double x = 0, y = 0;
  for (const ToolPoint& p : tool.point) {
    x += p.area_m2 * p.position_tool_m.x;
    y += p.area_m2 * p.position_tool_m.y;
  }
  EXPECT_LT(std::hypot(x, y) / area_sum(tool), 1e-9);
}

TEST(ToolPoints, BoxIsALattice) {
  PieceDesc p = piece(PieceShape::kBox, 26);
  p.size_m = {0.02, 0.02, 0.02};
  p.margin_m = 0.004;
  const Tool tool = make_tool({p});
  EXPECT_EQ(tool.point.size(), 26u);
  const double a = 0.012, m = 0.004;
  const double exact = 6 * a * a + 12 * a * kPi / 2 * m + 4 * kPi * m * m;
  EXPECT_NEAR(area_sum(tool), exact, 1e-9 * exact);
  EXPECT_NEAR(tool.point[0].area_m2, tool.point[25].area_m2, 1e-12 * exact);  // opposite corners
}

// Cone with its rounding: base disc, two arcs and the slant, each a closed form.
TEST(ToolPoints, ConeAreaIsExact) {
  PieceDesc p = piece(PieceShape::kCone, 20);
  p.radius_m = 0.010;
  p.length_m = 0.030;
  p.margin_m = 0.002;
  const Tool tool = make_tool({p});
  const double r = 0.010, l = 0.030, m = 0.002, slope = std::atan2(r, l), slant = std::hypot(r, l);
  const double base_arc = 2 * kPi * m * (r * (slope + kPi / 2) + m * (std::sin(slope) + 1));
  const double tip_arc = 2 * kPi * m * m * (1 - std::sin(slope));
  const double exact = kPi * r * r + base_arc + 2 * kPi * (r / 2 + m * std::cos(slope)) * slant + tip_arc;
  EXPECT_NEAR(area_sum(tool), exact, 1e-10 * exact);
  PieceDesc tip = p;
  tip.touches = TouchingEnd::kPlusZ;
  const Tool one = make_tool({tip});
  ASSERT_EQ(one.point.size(), 1u);
  EXPECT_DOUBLE_EQ(one.point[0].position_tool_m.z, 0.015);
}

TEST(ToolPoints, HullUsesItsCorners) {
  PieceDesc p = piece(PieceShape::kHull, 8);
  for (const double x : {-0.01, 0.01})
    for (const double y : {-0.01, 0.01})
      for (const double z : {-0.01, 0.01}) p.vertices_m.push_back({x, y, z});
  p.margin_m = 0.002;
  const Tool tool = make_tool({p});
  EXPECT_EQ(tool.point.size(), 8u);
  EXPECT_EQ(tool.hull_vertex_m.size(), 8u);
  const double exact = 6 * 4e-4 + 4 * kPi * 4e-6;
  EXPECT_NEAR(area_sum(tool), exact, 1e-6 * exact);
  EXPECT_EQ(convex_hull(p.vertices_m).size(), 12u);
  EXPECT_NEAR(tool.piece[0].bounding_radius_m, std::sqrt(3) * 0.01 + 0.002, 1e-12);
}

TEST(ToolPoints, PosesAndIndicesFollowThePieces) {
  PieceDesc a = cylinder(0.012, 0.024, 0.006, 9);
  a.rotation_rad = {-kPi / 2, 0, 0};  // z to +y
  a.touches = TouchingEnd::kMinusZ;
  PieceDesc ghost = piece(PieceShape::kSphere, 0);
  ghost.radius_m = 0.01;
  PieceDesc b = piece(PieceShape::kSphere, 1);
  b.radius_m = 0.01;
  const Tool tool = make_tool({a, ghost, b});
  ASSERT_EQ(tool.point.size(), 10u);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(tool.point[i].position_tool_m.y, -0.006, 1e-12);
  EXPECT_EQ(tool.piece[1].point_count, 0);
  EXPECT_EQ(tool.piece[2].first_point, 9);
  EXPECT_EQ(tool.point[9].piece, 2);
}

TEST(ToolPoints, MorePointsCoverBetter) {
  double before = 1;
  for (const std::int32_t n : {8, 16, 32, 64, 128}) {
    const Tool tool = make_tool({cylinder(0.012, 0.060, 0.004, n)});
    EXPECT_LE(static_cast<std::int32_t>(tool.point.size()), n);
    EXPECT_LE(tool.gap_m[0], before + 1e-9);
    before = tool.gap_m[0];
  }
  EXPECT_LT(before, 2e-3);
}

TEST(ToolPoints, RotationVectorsOfAnyLength) {
  const Quat q = rotation_of({0, 0, kPi});
  EXPECT_NEAR(rotate(q, {1, 0, 0}).x, -1, 1e-12);
  EXPECT_EQ(rotation_of({}), Quat{});
}

}  // namespace
}  // namespace palpate
