// Several tips on one body in the tick against large-strain finite elements that feel both.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "rt_core/contact/regions.h"
#include "rt_core/status.h"
#include "tests/elastic/elastic_tick_scene.h"
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

TEST(ElasticCoupled, TwoBallsOnAnArchFeelOneAnotherAsElementsDo) {
  const BakedScene scene(pair_scene());
  Bench bench(scene.model());
  double off = 0, whole = 0;
  PairState at{-5e-4, 0};
  for (std::size_t i = 0; i < kPairStates.size(); ++i) {
    move_bar(bench, at, kPairStates[i]);
    at = kPairStates[i];
    ASSERT_EQ(bench.output.regions, 2);
    EXPECT_EQ(bench.output.status & Status::kNotConverged, 0u);
    const PairForces felt = forces_of(bench), solved = kPairReference[i];
    off += squared_norm(felt.right_N - solved.right_N) + squared_norm(felt.left_N - solved.left_N);
    whole += squared_norm(solved.right_N) + squared_norm(solved.left_N);
    for (const auto& [side, f, r] :
         {std::tuple{"right_", felt.right_N, solved.right_N}, {"left_", felt.left_N, solved.left_N}})
      RecordProperty(std::string(side) + std::to_string(i), std::to_string(100 * (norm(f) / norm(r) - 1)) + " %");
  }
  RecordProperty("rms", std::to_string(100 * std::sqrt(off / whole)) + " %");
  EXPECT_LT(std::sqrt(off / whole), 0.05);
}

}  // namespace
}  // namespace palpate::test
