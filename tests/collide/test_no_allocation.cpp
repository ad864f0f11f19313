// The narrow phase and the region stage never touch the heap, libccd's part included. The whole tick is guarded
// elsewhere; here the rare branches (overlap tests, overflow, truncation) are driven on purpose. Under a sanitizer the
// count stands still.
#include <gtest/gtest.h>

#include <memory>

#include "rt_core/contact/regions.h"
#include "rt_core/surface/overlap.h"
#include "sim_host/run/heap_count.h"
#include "tests/collide/pieces.h"
#include "tests/support/roomy.h"

namespace palpate::test {
namespace {

TEST(NoAllocation, NarrowPhase) {
  const Model model;
  std::mt19937_64 rng(30);
  const long before = heap_calls();
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const ToolPiece& piece = all_pieces()[i % 5];
    const Pose tool{random_vec(rng, 0.02), random_rotation(rng)};
    const Vec3 t[3] = {random_vec(rng, 0.02), random_vec(rng, 0.02), random_vec(rng, 0.02)};
    hits += overlap_piece_triangle(model, piece, tool, t, i % 7 == 0 ? 4 : kGjkSupportBudget).support_calls;
  }
  EXPECT_EQ(heap_calls(), before);
  EXPECT_GT(hits, 0);
}

TEST(NoAllocation, StagesWithOverflowAndLoss) {
  Body body = make_body(ellipsoid({0.03, 0.03, 0.03}, 30));
  body.piece = {all_pieces()[4]};
  body.piece[0].bounding_radius_m = 1;
  body.piece[0].point_count = 100;
  for (int i = 0; i < 100; ++i) body.tool_point.push_back({{1e-3 * (i % 10), 1e-3 * (i / 10), 0}, 5e-3, 1e-6, 1, 0, 0});
  body.bind();
  body.model.params.period_s = 1e-3;
  body.model.params.cluster_distance_m = 2e-4;  // every contact its own region
  const auto state = test::roomy_state();
  const auto scratch = test::roomy_scratch();
  std::uint32_t seen = 0;
  const long before = heap_calls();
  for (int t = 0; t < 300; ++t) {
    state->tool_previous_w = state->tool_w;
    state->tool_w = {{0, 0, 0.04 - 5e-4 * (t % 100)}, {}};
    scratch->status = 0;
    collide(body.model, *state, *scratch);
    group_points(body.model, *state, *scratch, still_touching);
    seen |= scratch->status;
    state->tick += 1;
  }
  EXPECT_EQ(heap_calls(), before);
  EXPECT_TRUE(seen & Status::kContactsDropped);
  EXPECT_TRUE(seen & Status::kRegionsDropped);
}

}  // namespace
}  // namespace palpate::test
