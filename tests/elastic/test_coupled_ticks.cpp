// Several tips on one body in the tick against large-strain finite elements that feel both.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

#include "rt_core/contact/regions.h"
#include "rt_core/status.h"
#include "tests/elastic/elastic_tick_scene.h"
#include "tests/elastic/pinched_bodies.h"
#include "tests/elastic/two_balls_on_an_arch.h"

namespace palpate::test {
namespace {

PairForces forces_of(const Bench& bench) {
  PairForces out;
  for (const Region& region : bench.state->region) {
    if (!is_in_contact(region)) continue;
    (region.wrench_w.force_N.x > 0 ? out.right_N : out.left_N) = region.wrench_w.force_N;
  }
  return out;
}

// From state to state, by at most 20 um a tick at either ball.
void move_bar(Bench& bench, const PairState& from, const PairState& to) {
  const double way = std::abs(to.lowered_m - from.lowered_m) + kPairHalf_m * std::abs(to.turn_rad - from.turn_rad);
  const int steps = static_cast<int>(way / 2e-5) + 1;
  for (int i = 1; i <= steps + 3; ++i) {
    const double share = std::min(1.0, static_cast<double>(i) / steps);
    bench.tick_at(pair_pose({from.lowered_m + share * (to.lowered_m - from.lowered_m),
                             from.turn_rad + share * (to.turn_rad - from.turn_rad)}),
                  {});
  }
}

// RMS difference of two series of forces, as a share of the reference; every force's error goes into the report.
double rms_share(const std::vector<PairForces>& felt, const PairForces* reference) {
  double off = 0, whole = 0;
  for (std::size_t i = 0; i < felt.size(); ++i)
    for (const auto& [side, f, r] : {std::tuple{"right_", felt[i].right_N, reference[i].right_N},
                                     {"left_", felt[i].left_N, reference[i].left_N}}) {
      off += squared_norm(f - r), whole += squared_norm(r);
      testing::Test::RecordProperty(side + std::to_string(i), std::to_string(100 * (norm(f) / norm(r) - 1)) + " %");
    }
  const double share = std::sqrt(off / whole);
  testing::Test::RecordProperty("rms", std::to_string(100 * share) + " %");
  return share;
}

// On elements of half the wall and of a third of it, by how much the forces may differ: 6.2 and 1.7 % RMS
// (2026-11-25; 3.7 on 3 mm). Alone on the first, one ball is 3.8 % RMS too soft, on those of 3 mm 1.6; with the width
// law before, the parabola, 1.5 and 4.1: what was nearer on half the wall was not on a finer mesh. The reference
// with 1.3 mm under the balls is 0.3 to 0.5 % lower.
class ElasticCoupled : public testing::TestWithParam<std::tuple<const char*, double>> {};
TEST_P(ElasticCoupled, TwoBallsOnAnArchFeelOneAnotherAsElementsDo) {
  const auto& [edge_mm, most] = GetParam();
  std::string text = pair_scene();
  text.replace(text.find("edge_mm = 6"), 11, std::string("edge_mm = ") + edge_mm);
  const BakedScene scene(text);
  Bench bench(scene.model());
  std::vector<PairForces> felt;
  PairState at{-5e-4, 0};
  for (const PairState& state : kPairStates) {
    move_bar(bench, at, state);
    at = state;
    ASSERT_EQ(bench.output.regions, 2);
    EXPECT_EQ(bench.output.status & Status::kNotConverged, 0u);
    felt.push_back(forces_of(bench));
  }
  EXPECT_LT(rms_share(felt, kPairReference.data()), most);
}
INSTANTIATE_TEST_SUITE_P(Elements, ElasticCoupled, testing::Values(std::tuple{"6", 0.065}, std::tuple{"4", 0.03}));

// From state to state, by 20 um a tick at most.
void move_jaws(Bench& bench, const PinchedBody& body, const PinchState& from, const PinchState& to) {
  const double way = std::abs(to.closed_m - from.closed_m) + std::abs(to.aside_m - from.aside_m);
  const int steps = static_cast<int>(way / 2e-5) + 1;
  for (int i = 1; i <= steps + 20; ++i) {
    const double share = std::min(1.0, static_cast<double>(i) / steps);
    const double closed_m = from.closed_m + share * (to.closed_m - from.closed_m);
    const double aside_m = from.aside_m + share * (to.aside_m - from.aside_m);
    bench.tick_at({{aside_m, body.height_m, 0}, {}}, closing_all(1 - (kPinchDeepest_m - closed_m) / kPinchWay_m));
  }
}
std::vector<PairForces> pinch(const PinchedBody& body) {
  const BakedScene scene(body.scene());
  Bench bench(scene.model());
  PinchState at{-1e-3, 0};
  for (int i = 0; i < 150; ++i)  // until the jaws are there
    bench.tick_at({{0, body.height_m, 0}, {}}, closing_all(1 - (kPinchDeepest_m - at.closed_m) / kPinchWay_m));
  std::vector<PairForces> felt;
  for (const PinchState& state : kPinchStates) {
    move_jaws(bench, body, at, state);
    at = state;
    EXPECT_EQ(bench.output.regions, 2);
    EXPECT_EQ(bench.output.status & Status::kNotConverged, 0u);
    felt.push_back(forces_of(bench));
  }
  return felt;
}

class ElasticPinch : public testing::TestWithParam<PinchedBody> {};
TEST_P(ElasticPinch, IsWhatElementsSay) { EXPECT_LT(rms_share(pinch(GetParam()), GetParam().reference.data()), 0.05); }
// Half the wall is a fifth of the force.
TEST(SlowElasticPinch, HalvingTheWallChangesTheForceAsElementsSay) {
  const PinchedBody &full = kPinchedBodies[1], &half = kPinchedBodies[2];
  const std::vector<PairForces> a = pinch(full), b = pinch(half);
  for (std::size_t i = 0; i < kPinchStates.size(); ++i) {
    const double felt = norm(b[i].right_N) / norm(a[i].right_N);
    const double solved = norm(half.reference[i].right_N) / norm(full.reference[i].right_N);
    RecordProperty("ratio_" + std::to_string(i), std::to_string(100 * (felt / solved - 1)) + " %");
    EXPECT_LT(solved, 0.25) << i;
    EXPECT_NEAR(felt / solved, 1, 0.05) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, ElasticPinch, testing::ValuesIn(kPinchedBodies),
                         [](const auto& body) { return std::string(body.param.name); });

}  // namespace
}  // namespace palpate::test
