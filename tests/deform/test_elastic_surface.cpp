// The drawn surface of an elastic body is the solved one: it meets the tip, is round where the contact is, and keeps
// still where the body is held.
#include <gtest/gtest.h>

#include <cmath>

#include "sim_host/view/deformed_surface.h"
#include "sim_host/view/elastic_surface.h"
#include "sim_host/view/view_scales.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate {
namespace {

using namespace test;

constexpr double kBall_m = 0.012;

struct Pressed {
  Pressed()
      : scene(elastic_scene("shape = \"box\"\nsize_mm = [50, 40, 50]\ntriangles = 6000\n", 2, 10, 1e3 * kBall_m, 4)) {
    bench = std::make_unique<Bench>(scene.model());
    const Vec3 top{0.002, 0.04 + kBall_m, 0.001};
    centre = top - Vec3{0, 0.003, 0};
    move_to(*bench, top + Vec3{0, 0.001, 0}, centre);
  }
  BakedScene scene;
  std::unique_ptr<Bench> bench;
  Vec3 centre;
};

TEST(ElasticSurface, MeetsTheTipAndNoPointLiesInside) {
  Pressed pressed;
  const DeformedSurface surface = refined_surface(pressed.scene.model(), *pressed.bench->state);
  double deepest = kHuge;
  for (const Vec3& p : surface.position_m) deepest = std::min(deepest, norm(p - pressed.centre) - kBall_m);
  // Of 3 mm of travel; the profile's parabola stands off the sphere by a^4 / 8 R^3, a^2 < R x 3 mm: 0.03 mm here.
  EXPECT_NEAR(deepest, 0, 0.06e-3);
}

// The block's far field is nearly flat under a contact, so that it is Hertz' for the exact ball: half the depth at the
// edge but for what a ball is steeper than a paraboloid.
TEST(ElasticSurface, TheContactIsAsWideAsTheLawSays) {
  Pressed pressed;
  const std::vector<TipDent> dents = elastic_shape(pressed.scene.model(), *pressed.bench->state).dent;
  ASSERT_EQ(dents.size(), 1u);
  EXPECT_NEAR(dents[0].across_m / std::sqrt(dents[0].depth_m * kBall_m), 1, 0.05);
  EXPECT_NEAR(dents[0].along_m / dents[0].across_m, 1, 0.02);
  EXPECT_NEAR(dents[0].edge_m / dents[0].depth_m, 0.5, 0.05);
  EXPECT_NEAR(dents[0].far_m / (2 * dents[0].edge_m), 1, 0.01);
  const DeformedSurface surface = refined_surface(pressed.scene.model(), *pressed.bench->state);
  double widest = 0;
  for (const Vec3& p : surface.position_m)
    if (norm(p - pressed.centre) - kBall_m < 0.05 * dents[0].depth_m)
      widest = std::max(widest, norm(tangential_part(p - pressed.centre, dents[0].now.inward)));
  // Beyond the edge the profile leaves the paraboloid by 5 % of the depth at 1.12 a.
  EXPECT_NEAR(widest / dents[0].across_m, 1.1, 0.1);
}

TipDent dent_at_the_top(double across_m, double along_m) {
  TipDent dent;
  dent.foot_m = {0, 0.1, 0};
  dent.rest = dent.now = {{0, -1, 0}, {1, 0, 0}};
  dent.depth_m = dent.far_m = 0.002;
  dent.edge_m = 0.001;
  dent.across_m = across_m;
  dent.along_m = along_m;
  dent.mean_Pa = 1000;
  return dent;
}

// What lies below the tip on another side of the body is not dented: the inside of a ring's far side faces the tip too.
TEST(ElasticSurface, ADentReachesAsFarAsItsRadius) {
  TipDent dent = dent_at_the_top(0.004, 0.004);
  dent.reach_m = 0.08;
  EXPECT_NEAR(norm(dent.at({0, 0.1, 0}, {0, 1, 0})), 0.002, 1e-12);
  EXPECT_NEAR(norm(dent.at({0.004, 0.1, 0}, {0, 1, 0})), 0.001, 1e-12);
  EXPECT_EQ(norm(dent.at({0, 0.02, 0}, {0, 1, 0})), 0);
  EXPECT_EQ(norm(dent.at({0, 0.09, 0}, {0, -1, 0})), 0);
  EXPECT_DOUBLE_EQ(dent.pressure_Pa({0, 0.1, 0}, {0, 1, 0}), 1500);
  EXPECT_EQ(dent.pressure_Pa({0, 0.1, 0}, {0, -1, 0}), 0);
  EXPECT_EQ(dent.pressure_Pa({0.0041, 0.1, 0}, {0, 1, 0}), 0);
}

// From far away a dent is that of its force at a point, F / (pi E* r), in every direction: an ellipse's too, whatever
// its depth. F = 4/3 E* sqrt(a b) far.
TEST(ElasticSurface, FromFarAwayADentIsThatOfItsForce) {
  TipDent dent = dent_at_the_top(0.002, 0.008);
  dent.edge_m = 0.0013;
  for (const Vec3 to : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0.6, 0, -0.8}}) {
    const double r = 0.2, point_m = 4.0 / 3 * 0.004 * dent.far_m / (kPi * r);
    EXPECT_NEAR(-dent.at(dent.foot_m + r * to, {0, 1, 0}).y / point_m, 1, 2e-3);
  }
}

// A dent turns with the surface that carries it: the same numbers in the frame of now.
TEST(ElasticSurface, ADentTurnsWithItsFrame) {
  TipDent dent = dent_at_the_top(0.004, 0.006);
  dent.drawn_in_m = 0.0002;
  const Vec3 place{0.005, 0.1, 0.003}, before = dent.at(place, {0, 1, 0});
  dent.now = {{1, 0, 0}, {0, 0, 1}};
  const Vec3 after = dent.at(place, {0, 1, 0});
  EXPECT_NEAR(dot(after, dent.now.inward), dot(before, dent.rest.inward), 1e-15);
  EXPECT_NEAR(dot(after, dent.now.along), dot(before, dent.rest.along), 1e-15);
  EXPECT_NEAR(dot(after, dent.now.across()), dot(before, dent.rest.across()), 1e-15);
}

// Towards the middle from all sides, across an ellipse's lines of equal rho; a deep ball pushes out again inside.
TEST(ElasticSurface, AContactDrawsTheSurfaceIn) {
  TipDent dent = dent_at_the_top(0.004, 0.012);
  dent.drawn_in_m = 0.0002;
  const auto along = [&](double x_m, double z_m) { return dent.at({x_m, 0.1, z_m}, {0, 1, 0}); };
  EXPECT_EQ(norm(tangential_part(along(0, 0), {0, 1, 0})), 0);
  EXPECT_NEAR(along(0, 0.004).z, -0.0002, 1e-12);
  EXPECT_NEAR(along(0.012, 0).x, -0.0002, 1e-12);
  EXPECT_NEAR(along(-0.012, 0).x, 0.0002, 1e-12);
  const Vec3 beside = along(0.006, -0.003);
  EXPECT_NEAR(beside.x / beside.z, -0.006 / 0.003 / 9, 1e-9);  // the ellipse is three times as long as wide
  const double before = along(0, 0.0024).z, edge = along(0, 0.004).z;
  dent.spread_m = 0.001;
  EXPECT_GT(along(0, 0.0024).z - before, 0.05 * dent.spread_m);
  EXPECT_NEAR(along(0, 0.004).z, edge, 0.01 * dent.spread_m);
  EXPECT_LT(along(0, 0.006).z, -0.0002 * 0.004 / 0.006);  // around it the surface is drawn down into the dent
}

// Over the drawn surface the pressure adds up to the force, of every method that has one.
double force_of_pressure_N(const DeformedSurface& surface) {
  double sum_N = 0;
  for (const auto& [a, b, c] : surface.triangle) {
    const auto at = [&](std::int32_t v) { return surface.rest_m[static_cast<std::size_t>(v)]; };
    const auto p = [&](std::int32_t v) { return surface.pressure_Pa[static_cast<std::size_t>(v)]; };
    sum_N += 0.5 * norm(cross(at(b) - at(a), at(c) - at(a))) * (p(a) + p(b) + p(c)) / 3;
  }
  return sum_N;
}

TEST(ContactPressure, OfAnElasticBodyAddsUpToTheForce) {
  Pressed pressed;
  const DeformedSurface surface = refined_surface(pressed.scene.model(), *pressed.bench->state);
  const double force_N = pressed.bench->output.contact_w.force_N.y;
  EXPECT_GT(force_N, 1);
  // Triangles of 0.7 mm under a contact of 5 mm.
  EXPECT_NEAR(force_of_pressure_N(surface) / force_N, 1, 0.03);
}

const char* const kTipScene = R"(name = "tip"
[body]
shape = "box"
size_mm = [60, 30, 60]
triangles = 3000
[body.material]
youngs_modulus_Pa = 2e4
poisson_ratio = 0.49
[skeleton]
law = "none"
[contact]
law = "tool"
max_depth_mm = 6
[friction]
law = "none"
[shape]
neighbourhood = "punch"
radius_mm = 15
[[tool.piece]]
shape = "sphere"
radius_mm = 6
)";

TEST(ContactPressure, OfAWholeTipAddsUpToTheForce) {
  const BakedScene scene(kTipScene);
  Bench bench(scene.model());
  move_to(bench, {0, 0.037, 0}, {0.001, 0.0335, 0.002});
  const DeformedSurface surface = refined_surface(scene.model(), *bench.state);
  EXPECT_GT(bench.output.contact_w.force_N.y, 0.05);
  EXPECT_NEAR(force_of_pressure_N(surface) / bench.output.contact_w.force_N.y, 1, 0.03);
}

TEST(ContactPressure, OfNodesIsTheirForceOverTheirArea) {
  const BakedScene scene(
      "name = \"block\"\n[body]\nshape = \"box\"\nsize_mm = [20, 20, 20]\n[body.material]\nyoungs_modulus_Pa = 2e5\n"
      "poisson_ratio = 0.45\n[body.fem]\nedge_mm = 5\n[body.fixed]\nbase_height_mm = 0\n[contact]\nbackend = "
      "\"nodal\"\n[friction]\nlaw = \"none\"\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n");
  Bench bench(scene.model());
  move_to(bench, {0, 0.0285, 0}, {0, 0.0265, 0});
  const DeformedSurface surface = deformed_surface(scene.model(), *bench.state);
  const double force_N = bench.output.contact_w.force_N.y;
  EXPECT_GT(force_N, 0.1);
  // What pushes on nodes pushes along a slope: on a flat top it is the same but for the ball's curvature.
  EXPECT_NEAR(force_of_pressure_N(surface) / force_N, 1, 0.05);
}

TEST(ContactPressure, SpringsAtPointsHaveNone) {
  const BakedScene scene(
      "name = \"points\"\n[body]\nshape = \"ellipsoid\"\nhalf_axes_mm = [40, 30, 25]\ntriangles = 2000\n[contact]\nlaw "
      "= "
      "\"cubic\"\n[contact.cubic]\nk1_N_per_m = 300\nk3_N_per_m3 = 1e6\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm "
      "= "
      "10\n[friction]\nmu_ref = 0.3\n");
  Bench bench(scene.model());
  move_to(bench, {0, 0.072, 0}, {0, 0.068, 0});
  EXPECT_GT(bench.output.contacts, 0);
  EXPECT_TRUE(deformed_surface(scene.model(), *bench.state).pressure_Pa.empty());
  EXPECT_FALSE(solves(scene.model(), SurfaceColour::kPressure));
  EXPECT_STREQ(colour_meaning(scene.model(), SurfaceColour::kPressure), "not solved by this model");
}

TEST(ElasticSurface, WhatIsHeldKeepsStillAndLetGoItIsAtRest) {
  Pressed pressed;
  const DeformedSurface surface = deformed_surface(pressed.scene.model(), *pressed.bench->state);
  double held = 0, most = 0;
  for (std::size_t i = 0; i < surface.rest_m.size(); ++i) {
    most = std::max(most, norm(surface.displacement_m[i]));
    if (surface.rest_m[i].y < 1e-6) held = std::max(held, norm(surface.displacement_m[i]));
  }
  EXPECT_NEAR(most, 0.003, 0.0004);  // the vertex nearest to the deepest place
  EXPECT_LT(held, 0.02 * most);
  move_to(*pressed.bench, pressed.centre, pressed.centre + Vec3{0, 0.02, 0});
  for (const Vec3& u : deformed_surface(pressed.scene.model(), *pressed.bench->state).displacement_m)
    EXPECT_LT(norm(u), 1e-9);
}

}  // namespace
}  // namespace palpate
