// The drawn surface of an elastic body is the solved one: it meets the tip, is round where the contact is, and keeps
// still where the body is held.
#include <gtest/gtest.h>

#include <cmath>

#include "sim_host/view/deformed_surface.h"
#include "sim_host/view/elastic_surface.h"
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

TEST(ElasticSurface, TheContactIsAsWideAsTheLawSays) {
  Pressed pressed;
  const std::vector<TipDent> dents = tip_dents(pressed.scene.model(), *pressed.bench->state);
  ASSERT_EQ(dents.size(), 1u);
  EXPECT_NEAR(dents[0].across_m, std::sqrt(dents[0].depth_m * kBall_m), 1e-4 * kBall_m);
  const DeformedSurface surface = refined_surface(pressed.scene.model(), *pressed.bench->state);
  double widest = 0;
  for (const Vec3& p : surface.position_m)
    if (norm(p - pressed.centre) - kBall_m < 0.05 * dents[0].depth_m)
      widest = std::max(widest, norm(tangential_part(p - dents[0].foot_w, dents[0].inward)));
  // Beyond the edge the profile leaves the paraboloid by 5 % of the depth at 1.12 a.
  EXPECT_NEAR(widest / dents[0].across_m, 1.1, 0.1);
}

// What lies below the tip on another side of the body is not dented: the inside of a ring's far side faces the tip too.
TEST(ElasticSurface, ADentReachesAsFarAsItsRadius) {
  TipDent dent{{0, 0.1, 0}, {0, -1, 0}, {1, 0, 0}, 0.002, 0.004, 0.004};
  EXPECT_NEAR(norm(dent.at({0, 0.1, 0}, {0, 1, 0})), 0.002, 1e-12);
  EXPECT_NEAR(norm(dent.at({0.004, 0.1, 0}, {0, 1, 0})), 0.001, 1e-12);
  EXPECT_EQ(norm(dent.at({0, 0.02, 0}, {0, 1, 0})), 0);
  EXPECT_EQ(norm(dent.at({0, 0.09, 0}, {0, -1, 0})), 0);
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
