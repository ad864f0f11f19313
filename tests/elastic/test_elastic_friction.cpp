// Friction between a tip and a body that gives way: what the hand feels when it drags, and what holds a slender body
// up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rt_core/contact/friction.h"
#include "rt_core/status.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

// A square column, 70 mm of it free, under a sphere on its upper face.
constexpr double kSide_m = 0.01, kFree_m = 0.07, kModulus_Pa = 3e6, kRadius_m = 8e-3;
constexpr double kBending_Nm2 = kModulus_Pa * kSide_m * kSide_m * kSide_m * kSide_m / 12;
// Euler: clamped below, free above; clamped below, held sideways above.
constexpr double kFreeEuler_N = std::numbers::pi * std::numbers::pi * kBending_Nm2 / (4 * kFree_m * kFree_m);
constexpr double kHeldEuler_N = 20.19 * kBending_Nm2 / (kFree_m * kFree_m);
constexpr Vec3 kTop{0, 0.08 + kRadius_m, 0};

std::string column(const std::string& friction, double mu) {
  std::string scene =
      elastic_scene("shape = \"box\"\nsize_mm = [10, 80, 10]\ntriangles = 2000\n", 10, 5, 1e3 * kRadius_m, 4, friction);
  if (mu > 0) scene.replace(scene.find("[[tool"), 0, "mu_ref = " + number(mu) + "\n");
  return scene;
}
BakedScene baked_column(const std::string& friction, double mu) {
  return BakedScene(parse_scene(column(friction, mu), "test.toml"));
}

// A tip that sticks to the end of a cantilever and drags it aside feels 3 E I / L^3, softened by the load on it as a
// column is: 1 - P / P_Euler.
TEST(ElasticFriction, DragOnAColumnFeelsItsBending) {
  const BakedScene scene = baked_column("presliding", 0.8);
  Bench bench(scene.model());
  const Vec3 pressed = kTop - Vec3{0, 1e-4, 0};
  move_to(bench, kTop, pressed, 5e-6);
  const Vec3 before = bench.output.contact_w.force_N;
  constexpr double kAside_m = 4e-4;
  for (const Vec3 along : {Vec3{1, 0, 0}, Vec3{0, 0, -1}}) {
    move_to(bench, pressed, pressed + kAside_m * along, 5e-6);
    const double felt = -dot(bench.output.contact_w.force_N - before, along) / kAside_m;
    const double beam =
        3 * kBending_Nm2 / (kFree_m * kFree_m * kFree_m) * (1 - bench.output.contact_w.force_N.y / kFreeEuler_N);
    RecordProperty(along.x > 0 ? "of_the_beam_along_x" : "of_the_beam_along_z", std::to_string(felt / beam));
    // Shear gives 1.8 %, the clamp's stiffened root takes about as much back; 0.98 measured on 2026-11-22.
    EXPECT_NEAR(felt / beam, 1, 0.05);
    move_to(bench, pressed + kAside_m * along, pressed, 5e-6);
  }
}

// Without friction the ball's force follows the upper face and acts where the ball touches it, which holds the column
// beyond its free Euler load: cos z + z (1 + R/L) sin z = 0, P = z^2 EI / L^2 = 4.1 N. With friction the tip holds it
// until it buckles as a column held at both ends. (The slippery one leans out of its ball of amplitudes beyond 2 mm,
// stands there still, by the tangents of V, and says so; until steps that go to and fro were damped, on 2026-11-29,
// rounding said where between 1.8 and 2.3 mm it was thrown aside.)
TEST(ElasticFriction, TheTipHoldsASlenderBodyUp) {
  constexpr Vec3 kAside{3e-4, 0, 0};
  const auto output = [&](const BakedScene& scene, double depth_m) {
    Bench bench(scene.model());
    return move_to(bench, kTop + kAside, kTop + kAside - Vec3{0, depth_m, 0}, 5e-6);
  };
  const auto press = [&](const BakedScene& scene, double depth_m) {
    return output(scene, depth_m).contact_w.force_N.y;
  };
  const BakedScene slippery = baked_column("none", 0), rough = baked_column("presliding", 0.5);
  EXPECT_GT(press(slippery, 1e-3), 2 * kFreeEuler_N);  // 3.17 N
  EXPECT_EQ(output(slippery, 1.6e-3).status & Status::kDepthBeyondRange, 0u);
  EXPECT_NE(output(slippery, 2.4e-3).status & Status::kDepthBeyondRange, 0u);
  EXPECT_GT(press(rough, 2.2e-3), 0.6 * kHeldEuler_N);  // 7.2 N of 10.3
}

// Deeper, the column goes out from under a tip without friction: a snap. No tick of it says more than the column can
// carry held at both ends; before a place's law was bounded by its width single ticks said up to 2.6e5 N (2026-11-25).
TEST(ElasticFriction, AColumnThatSnapsFromUnderATipThrowsNoForce) {
  const BakedScene slippery = baked_column("none", 0);
  for (const double aside_m : {5e-5, 3e-4, 1e-3, 2e-3}) {
    Bench bench(slippery.model());
    const Vec3 top = kTop + Vec3{aside_m, 0, 0};
    double most_N = 0;
    for (int i = 0; i <= 700; ++i)
      most_N = std::max(most_N, norm(bench.tick_at({top - Vec3{0, 5e-6 * i, 0}, {}}, {}).contact_w.force_N));
    EXPECT_GT(most_N, kFreeEuler_N) << aside_m;
    EXPECT_LT(most_N, kHeldEuler_N) << aside_m;  // 6.8 to 8.4 N of 10.3
  }
}

// Below 0.35 N, where the column sways from under a tip that slides.
TEST(ElasticFriction, ASlidingTipKeepsSliding) {
  constexpr double kMu = 0.02;
  const BakedScene scene = baked_column("presliding", kMu);
  Bench bench(scene.model());
  const Vec3 pressed = kTop - Vec3{2e-3, 1e-4, 0};
  move_to(bench, kTop - Vec3{2e-3, 0, 0}, pressed, 5e-6);
  const FrictionParameters law = friction_parameters(scene.model().params);
  double x = -2e-3, most = 0;
  for (const double step : {1e-5, -1e-5, 1e-5}) {
    for (int i = 0; i < 400; ++i) {
      bench.tick_at({{x += step, pressed.y, 0}, {}}, {});
      if (i < 100) continue;  // it turns round
      const Region& region = bench.state->region[0];
      EXPECT_EQ(region.friction, FrictionMode::kSlip) << i;
      EXPECT_LT(region.friction_force_w.x * step, 0);
      const double limit = static_limit_N(law, region.normal_force_N);
      most = std::max(most, std::abs(norm(region.friction_force_w) / limit - 1));
    }
  }
  EXPECT_LT(most, 1e-9);
}

// While it sticks nothing is lost: a loop returns its work, within what is stored by the drag.
TEST(ElasticFriction, AStickingLoopReturnsItsWork) {
  const BakedScene scene = baked_column("presliding", 5);
  Bench bench(scene.model());
  const Vec3 pressed = kTop - Vec3{0, 2e-4, 0};
  move_to(bench, kTop, pressed, 5e-6);
  double work = 0, most = 0;
  const double start = bench.output.energy_J;
  Vec3 before = bench.output.contact_w.force_N, at = pressed;
  constexpr int kSteps = 2000;
  for (int i = 1; i <= kSteps; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSteps;
    const Vec3 next = pressed + 5e-4 * Vec3{1 - std::cos(angle), 0, std::sin(angle)};
    const Output& out = bench.tick_at({next, {}}, {});
    work += 0.5 * dot(before + out.contact_w.force_N, next - at);
    most = std::max(most, out.energy_J - start);
    before = out.contact_w.force_N;
    at = next;
  }
  RecordProperty("of_the_stored_energy", std::to_string(work / most));
  EXPECT_EQ(bench.state->region[0].friction, FrictionMode::kStick);
  EXPECT_LT(std::abs(work), 0.01 * most);
}

// Friction never drives the hand: round any loop it takes energy.
TEST(ElasticFriction, ASlippingLoopTakesEnergy) {
  const BakedScene scene = baked_column("mindlin", 0.1);
  Bench bench(scene.model());
  const Vec3 pressed = kTop - Vec3{0, 2e-4, 0};
  move_to(bench, kTop, pressed, 5e-6);
  Vec3 before = bench.output.contact_w.force_N, at = pressed;
  for (int loop = 0; loop < 3; ++loop) {
    double work = 0;  // done by the body on the tool
    for (int i = 1; i <= 1000; ++i) {
      const double angle = 2 * std::numbers::pi * i / 1000;
      const Vec3 next = pressed + 2e-3 * Vec3{1 - std::cos(angle), 0, std::sin(angle)};
      const Output& out = bench.tick_at({next, {}}, {});
      work += 0.5 * dot(before + out.contact_w.force_N, next - at);
      before = out.contact_w.force_N;
      at = next;
    }
    EXPECT_LT(work, 0);
  }
}

// Stuck and dragged aside, then still: nothing alternates, though the spring is a hundred times stiffer than the body.
TEST(ElasticFriction, AStillTipGetsAStillForce) {
  const BakedScene scene = baked_column("presliding", 0.8);
  Bench bench(scene.model());
  move_to(bench, kTop, kTop - Vec3{0, 3e-4, 0}, 5e-6);
  const Vec3 held = kTop + Vec3{5e-4, -3e-4, 2e-4};
  move_to(bench, kTop - Vec3{0, 3e-4, 0}, held, 1e-4);
  EXPECT_LT(change_while_held_N(bench, {held, {}}, 10), 1e-9);
}

}  // namespace
}  // namespace palpate::test
