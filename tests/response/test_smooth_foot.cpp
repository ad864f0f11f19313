// The foot on the smooth surface: worked values, continuity across edges, depth on curved bodies, hard cases.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "config/body/procedural.h"
#include "config/response/corner_normals.h"
#include "rt_core/surface/smooth_foot.h"
#include "rt_core/surface/triangle.h"

namespace palpate {
namespace {

// A model of nothing but a surface with its smooth normals.
struct Surface {
  std::vector<Vec3> vertex;
  std::vector<Triangle> triangle;
  std::vector<CornerNormals> normal;
  Model model;

  void close() {
    model.vertex_m = vertex;
    model.triangle = triangle;
    model.corner_normal = normal;
  }
  Surface(const BodyDesc& body, const SurfaceMesh& mesh) : vertex(mesh.vertex_m), triangle(linked_triangles(mesh)) {
    normal = corner_normals(body, vertex, triangle);
    close();
  }
  Surface(const Vec3 (&v)[3], const Vec3 (&u)[3]) : vertex(v, v + 3) {
    Triangle one;
    for (int k = 0; k < 3; ++k) {
      one.vertex[k] = k;
      one.adjacent[k] = -1;
    }
    triangle.push_back(one);
    normal.push_back({{u[0], u[1], u[2]}});
    close();
  }
  // From the facet nearest to p: what the collision stage starts from.
  SmoothFoot foot(Vec3 p) const {
    std::int32_t nearest = 0;
    double distance = kHuge;
    for (std::size_t t = 0; t < triangle.size(); ++t) {
      const Vec3 at = closest_on_triangle(p, vertex[static_cast<std::size_t>(triangle[t].vertex[0])],
                                          vertex[static_cast<std::size_t>(triangle[t].vertex[1])],
                                          vertex[static_cast<std::size_t>(triangle[t].vertex[2])])
                          .point;
      if (squared_norm(p - at) >= distance) continue;
      distance = squared_norm(p - at);
      nearest = static_cast<std::int32_t>(t);
    }
    return smooth_foot(model, p, nearest);
  }
};

// One triangle with turned normals; b, c, t and the foot were computed independently, and the depth is t |N| plus half
// the sag of the facet.
TEST(SmoothFoot, WorkedTriangle) {
  const Surface surface({{0, 0, 0}, {10, 0, 0}, {0, 10, 0}}, {{0, 0, 1}, {0.6, 0, 0.8}, {0, 0, 1}});
  const Vec3 tip{3, 2, -2};
  const SmoothFoot foot = smooth_foot(surface.model, tip, 0);
  ASSERT_EQ(foot.state, FootState::kFound);
  EXPECT_NEAR(foot.weight[1], 0.34438289, 1e-8);
  EXPECT_NEAR(foot.weight[2], 0.2, 1e-14);
  // sum n_i (V_i - X).U_i / 2: only the second corner's normal leans along its facet.
  const double sag = 0.5 * 0.34438289 * (10 - 3.443829) * 0.6;
  EXPECT_NEAR(-foot.height_m, 2.048654 + sag, 1e-6);
  // The gradients are those of the coordinates.
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 h = axis == 0 ? Vec3{1e-6, 0, 0} : axis == 1 ? Vec3{0, 1e-6, 0} : Vec3{0, 0, 1e-6};
    const SmoothFoot up = smooth_foot(surface.model, tip + h, 0), down = smooth_foot(surface.model, tip - h, 0);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR((up.weight[k] - down.weight[k]) / 2e-6, dot(foot.gradient_per_m[k], 1e6 * h), 1e-7);
  }
}

BodyDesc sphere_body(double radius) {
  BodyDesc body;
  body.shape = BodyShape::kSphere;
  body.radius_m = radius;
  return body;
}

TEST(SmoothFoot, DepthUnderASphereAndACylinder) {
  const double radius = 0.05;
  const Surface sphere(sphere_body(radius), make_ellipsoid({radius, radius, radius}, 3000));
  BodyDesc body;
  body.shape = BodyShape::kCylinder;
  body.radius_m = radius;
  body.height_m = 0.1;
  const Surface cylinder(body, make_cylinder(radius, 0.1, 3000));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  double worst_sphere = 0, worst_cylinder = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 direction = unit_or({unit(random), unit(random), unit(random)}, {1, 0, 0});
    const double depth = 0.004 + 0.006 * unit(random);  // -2 to 10 mm
    const SmoothFoot a = sphere.foot(Vec3{0, radius, 0} + (radius - depth) * direction);
    ASSERT_EQ(a.state, FootState::kFound);
    worst_sphere = std::max(worst_sphere, std::abs(a.height_m + depth));
    EXPECT_GT(dot(a.normal_w, direction), 1 - 1e-5);
    const Vec3 around = unit_or({unit(random), 0, unit(random)}, {1, 0, 0});
    const SmoothFoot b = cylinder.foot(Vec3{0, 0.05 + 0.03 * unit(random), 0} + (radius - depth) * around);
    ASSERT_EQ(b.state, FootState::kFound);
    worst_cylinder = std::max(worst_cylinder, std::abs(b.height_m + depth));
  }
  std::printf("  depth error: sphere %.3g um, cylinder %.3g um\n", 1e6 * worst_sphere, 1e6 * worst_cylinder);
  // The facets stand off by 40 um (sphere, 3000 triangles) and 21 um: the smooth surface by a hundredth of it.
  EXPECT_LT(worst_sphere, 1e-6);
  EXPECT_LT(worst_cylinder, 1e-6);
}

// The foot, its normal and its height are continuous across every edge, for tips inside and outside; the nearest facet
// point jumps there by depth times the turn of the edge.
TEST(SmoothFoot, ContinuousAcrossEdges) {
  const double radius = 0.05;
  const Surface surface(sphere_body(radius), make_ellipsoid({radius, radius, radius}, 500));
  for (const double depth : {-5e-3, 0.0, 5e-3, 1e-2}) {
    SmoothFoot last;
    double place = 0, turn = 0, height = 0;
    const double step = 2e-6;
    const int steps = 30000;
    for (int i = 0; i <= steps; ++i) {
      const double angle = i * step / (radius - depth), tilt = 0.3 * angle;
      const Vec3 direction{std::sin(angle) * std::cos(tilt), std::cos(angle), std::sin(angle) * std::sin(tilt)};
      const SmoothFoot foot = surface.foot(Vec3{0, radius, 0} + (radius - depth) * direction);
      ASSERT_EQ(foot.state, FootState::kFound);
      if (i > 0) {
        place = std::max(place, norm(foot.foot_w - last.foot_w));
        turn = std::max(turn, norm(foot.normal_w - last.normal_w));
        height = std::max(height, std::abs(foot.height_m - last.height_m));
      }
      last = foot;
    }
    EXPECT_LT(place, 2 * step * radius / (radius - depth));
    EXPECT_LT(turn, 4 * step / (radius - depth));
    EXPECT_LT(height, 0.02 * step);
  }
}

TEST(SmoothFoot, LosesItselfOnlyWhereItMust) {
  const double radius = 0.05;
  const Surface sphere(sphere_body(radius), make_ellipsoid({radius, radius, radius}, 3000));
  // (1 - d/R)^2 = 0.2 at d = 0.553 R.
  EXPECT_EQ(sphere.foot({0, 2 * radius - 0.50 * radius, 1e-4}).state, FootState::kFound);
  EXPECT_EQ(sphere.foot({0, 2 * radius - 0.60 * radius, 1e-4}).state, FootState::kFocal);
  EXPECT_EQ(sphere.foot({0, radius, 0}).state, FootState::kFocal);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(smooth_foot(sphere.model, {nan, 0, 0}, 0).state, FootState::kFocal);
  EXPECT_EQ(smooth_foot(sphere.model, {0, 0, 0}, -1).state, FootState::kFocal);
  EXPECT_EQ(smooth_foot(sphere.model, {0, 0, 0}, 1 << 20).state, FootState::kFocal);
  // A box is flat up to its sharp edges, and ends there.
  BodyDesc body;
  body.shape = BodyShape::kBox;
  const Surface box(body, make_box({0.06, 0.06, 0.06}, 500));
  const SmoothFoot flat = box.foot({0.0299, 0.0599, 0});
  ASSERT_EQ(flat.state, FootState::kFound);
  EXPECT_NEAR(norm(flat.normal_w), 1, 1e-14);
  EXPECT_NEAR(flat.height_m, -1e-4, 1e-15);
  EXPECT_EQ(box.foot({0.031, 0.061, 0}).state, FootState::kEdge);
  EXPECT_EQ(box.foot({0.0, 0.061, 0}).state, FootState::kFound);
}

TEST(SmoothFoot, StartingTriangleHardlyMatters) {
  const double radius = 0.05;
  const Surface surface(sphere_body(radius), make_ellipsoid({radius, radius, radius}, 3000));
  const Vec3 p = Vec3{0, radius, 0} + 0.047 * unit_or({0.3, 0.8, -0.2}, {});
  const SmoothFoot reference = surface.foot(p);
  ASSERT_EQ(reference.state, FootState::kFound);
  int found = 0;
  for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
    const SmoothFoot foot = smooth_foot(surface.model, p, static_cast<std::int32_t>(t));
    if (foot.state != FootState::kFound) continue;
    if (dot(foot.normal_w, reference.normal_w) < 0) continue;  // the far side of the sphere
    found += 1;
    EXPECT_LT(norm(foot.foot_w - reference.foot_w), 1e-12);
    EXPECT_NEAR(foot.height_m, reference.height_m, 1e-13);
  }
  EXPECT_GT(found, 50);  // those within kFootWalk edges; the collision stage starts within one
}

}  // namespace
}  // namespace palpate
