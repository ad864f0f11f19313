// Capsules that lie along an elastic body: lines with rounded ends.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "rt_core/contact/regions.h"
#include "rt_core/status.h"
#include "tests/elastic/elastic_tick_scene.h"
#include "tests/elastic/pinched_block.h"
#include "tests/elastic/rod_on_a_block.h"

namespace palpate::test {
namespace {

// The jaws of pinch_block, described 3 mm deep, open by 8 mm.
class JawsOnABlock : public testing::TestWithParam<const char*> {};
TEST_P(JawsOnABlock, PressAsLargeStrainElementsDo) {
  std::string text = pinched_block();
  text.replace(text.find("soft_modes = 3"), 14, std::string("soft_modes = ") + GetParam());
  const BakedScene scene(text);
  Bench bench(scene.model());
  const auto close = [&](double closed_m, int ticks) {
    for (int i = 0; i < ticks; ++i) bench.tick_at({{0, kJawHeight_m, 0}, {}}, closing_all((5e-3 + closed_m) / 8e-3));
  };
  close(-1e-3, 1200);
  double at_m = -1e-3;
  for (const BlockState& state : kBlockStates) {
    for (; at_m < state.closed_m; at_m += 2e-5) close(at_m, 1);
    close(state.closed_m, 1200);
    ASSERT_EQ(bench.output.regions, 2);
    for (const Region& region : bench.state->region) {
      if (!is_in_contact(region)) continue;
      const double error = std::abs(region.wrench_w.force_N.x) / state.force_N - 1;
      RecordProperty("at_" + std::to_string(std::lround(1e6 * state.closed_m)) + "_um",
                     std::to_string(100 * error) + " %");
      // -0.4 and 1.0 % with three soft modes; 2.9 and 5.0 with two, which leave the twist out (2026-11-26).
      EXPECT_LT(std::abs(error), std::string(GetParam()) == "3" ? 0.02 : 0.06) << state.closed_m;
    }
  }
  EXPECT_LT(bench.output.residual_m, 1e-12);
}
INSTANTIATE_TEST_SUITE_P(SoftModes, JawsOnABlock, testing::Values("2", "3"));

class RodOnABlock : public testing::Test {
 protected:
  static const Model& model() {
    static const BakedScene baked(parse_scene(rod_on_a_block(), "rod.toml"));
    return baked.model();
  }
  const Output& put(double depth_m, double lean_rad, double along_m = 0) {
    const Vec3 at = rod_middle_m({depth_m, 0, 0}) + Vec3{0, 0, along_m};
    return bench_.tick_at({at, normalised({std::cos(0.5 * lean_rad), std::sin(0.5 * lean_rad), 0, 0})}, {});
  }
  // By so many ticks of equal parts, and some to settle.
  const Output& move(RodState from, RodState to, int ticks, int settle = 40) {
    for (int i = 1; i <= ticks + settle; ++i) {
      const double share = std::min(1.0, static_cast<double>(i) / ticks);
      put(from.depth_m + share * (to.depth_m - from.depth_m), from.lean_rad + share * (to.lean_rad - from.lean_rad));
    }
    return bench_.output;
  }
  Bench bench_{model()};
};

TEST_F(RodOnABlock, PressesAsLargeStrainElementsDo) {
  RodState at{-5e-4, 0, 0};
  for (const RodState& state : kRodStates) {
    const double error = move(at, state, 200).contact_w.force_N.y / state.force_N - 1;
    RecordProperty("at_" + std::to_string(std::lround(1e6 * state.depth_m)) + "_um_" +
                       std::to_string(std::lround(1e3 * state.lean_rad)),
                   std::to_string(100 * error) + " %");
    EXPECT_LT(std::abs(error), 0.05) << state.depth_m << " " << state.lean_rad;
    EXPECT_LT(bench_.output.residual_m, 1e-9);
    at = state;
  }
}

// Level it presses in its middle; leaning, against the lean, and past where one end leaves the face without a step: on
// the way from level to far, 0.25 rad in 1000 ticks, no tick changes force or moment by more than 1 % of the most.
TEST_F(RodOnABlock, ResistsLeaning) {
  const Wrench level = move({-5e-4, 0, 0}, {5e-4, 0, 0}, 200).contact_w;
  EXPECT_NEAR(level.torque_Nm.x, 0, 2e-3 * kRodHalf_m * level.force_N.y);
  Wrench before = level;
  double force_step = 0, torque_step = 0, most = 0, last = 0;
  for (int i = 1; i <= 1000; ++i) {
    const Wrench w = put(5e-4, 2.5e-4 * i).contact_w;
    force_step = std::max(force_step, norm(w.force_N - before.force_N));
    torque_step = std::max(torque_step, norm(w.torque_Nm - before.torque_Nm));
    most = std::max(most, norm(w.torque_Nm));
    before = w;
    // Its +z end goes down and is pushed up: about x.
    if (i == 100) last = w.torque_Nm.x;
  }
  RecordProperty("at_25_mrad_Nm", std::to_string(last));
  EXPECT_LT(last, -0.2 * kRodHalf_m * level.force_N.y);
  EXPECT_LT(force_step, 0.01 * norm(before.force_N));
  EXPECT_LT(torque_step, 0.01 * most);
}

// Down, leaning, deeper, leaning the other way, and back. What is lost is what the place adds: it acts where the line's
// own force does (1.2 %, 2026-11-26; 4.7 % with its terms in powers of the depth instead of the line's force).
TEST_F(RodOnABlock, ALoopReturnsItsWork) {
  const RodState corner[] = {{4e-4, 0.01, 0}, {4e-4, 0.04, 0}, {9e-4, 0.04, 0}, {9e-4, -0.03, 0}, {4e-4, 0.01, 0}};
  move({-5e-4, 0.01, 0}, corner[0], 300);
  double work_J = 0, most_J = 0;
  Wrench before = bench_.output.contact_w;
  for (int side = 0; side < 4; ++side) {
    const RodState &from = corner[side], &to = corner[side + 1];
    for (int i = 1; i <= 800; ++i) {
      const double share = i / 800.0;
      const Wrench w =
          put(from.depth_m + share * (to.depth_m - from.depth_m), from.lean_rad + share * (to.lean_rad - from.lean_rad))
              .contact_w;
      work_J += (0.5 * (w.force_N.y + before.force_N.y) * (to.depth_m - from.depth_m) -
                 0.5 * (w.torque_Nm.x + before.torque_Nm.x) * (to.lean_rad - from.lean_rad)) /
                800;
      most_J = std::max(most_J, bench_.output.energy_J);
      before = w;
    }
  }
  RecordProperty("of_the_energy", std::to_string(work_J / most_J));
  EXPECT_LT(std::abs(work_J), 0.02 * most_J);
}

TEST_F(RodOnABlock, StillRodGetsAStillForce) {
  move({-5e-4, 0.02, 0}, {7e-4, 0.02, 0}, 100, 0);
  Vec3 force;
  double change = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 now = put(7e-4, 0.02).contact_w.force_N;
    if (i > 60) change = std::max(change, norm(now - force));
    force = now;
  }
  EXPECT_LT(change, 1e-9);
}

// Along itself over the block's side, half its length beyond: the force falls as its line gets shorter, and no tick
// of 20 um changes it by more than 1 %.
TEST_F(RodOnABlock, LeavesTheBlockOverItsSideWithoutAStep) {
  move({-5e-4, 0, 0}, {6e-4, 0, 0}, 200);
  const double whole = bench_.output.contact_w.force_N.y;
  Vec3 before = bench_.output.contact_w.force_N;
  double step = 0, half_over = 0;
  for (int i = 1; i <= 1400; ++i) {
    const Vec3 now = put(6e-4, 0, 2e-5 * i).contact_w.force_N;
    step = std::max(step, norm(now - before));
    before = now;
    if (i == 1000) half_over = now.y;  // 20 mm: its middle over the side
  }
  RecordProperty("step_of_the_force", std::to_string(100 * step / whole) + " %");
  RecordProperty("half_over", std::to_string(half_over / whole));
  EXPECT_LT(step, 0.01 * whole);
  EXPECT_LT(half_over, 0.75 * whole);
  EXPECT_GT(half_over, 0.25 * whole);
}

}  // namespace
}  // namespace palpate::test
