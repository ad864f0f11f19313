// Which contacts of an articulated tool share a region: parts of one finger by distance, with hysteresis; different
// fingers never; one part always.
#include <gtest/gtest.h>

#include <memory>

#include "rt_core/contact/regions.h"
#include "tests/support/roomy.h"

namespace palpate {
namespace {

constexpr double kNear_m = 4e-3;

struct TwoParts {
  Model model;
  StatePtr state = test::roomy_state();
  ScratchPtr scratch = test::roomy_scratch();
  ToolPiece piece[2];
  ToolPoint point[2];

  TwoParts(std::int32_t group_a, std::int32_t group_b) {
    model.params.articulation = Articulation::kHand;
    model.params.cluster_distance_m = kNear_m;
    piece[0].group = group_a;
    piece[1].group = group_b;
    model.piece = piece;
    model.tool_point = point;
    scratch->contact_count = 2;
    for (Contact& contact : scratch->contact) contact = {};
    for (std::int32_t i = 0; i < 2; ++i) place(i, i);
  }
  void place(std::int32_t i, std::int32_t on_piece) {
    scratch->contact[i].row = scratch->contact[i].point = i;
    scratch->contact[i].piece = point[i].piece = on_piece;
  }
  int clusters_at(double gap_m) {
    scratch->contact[1].position_w = {gap_m, 0, 0};
    Clusters clusters;
    find_clusters(model, *scratch, clusters);
    return clusters.count;
  }
};

TEST(FingerRegions, NeighboursOnOneFingerJoinBelowTheDistance) {
  TwoParts parts(1, 1);
  EXPECT_EQ(parts.clusters_at(1.01 * kNear_m), 2);
  EXPECT_EQ(parts.clusters_at(0.99 * kNear_m), 1);
}

TEST(FingerRegions, JoinedOnesPartOnlyBeyondOneAndAHalfTimesIt) {
  TwoParts parts(1, 1);
  parts.scratch->contact[0].previous = parts.scratch->contact[1].previous = 3;
  EXPECT_EQ(parts.clusters_at(1.49 * kNear_m), 1);
  EXPECT_EQ(parts.clusters_at(1.51 * kNear_m), 2);
}

TEST(FingerRegions, DifferentFingersNeverJoin) {
  TwoParts parts(1, 2);
  EXPECT_EQ(parts.clusters_at(1e-6), 2);
  parts.scratch->contact[0].previous = parts.scratch->contact[1].previous = 3;
  EXPECT_EQ(parts.clusters_at(1e-6), 2);
}

TEST(FingerRegions, OnePartIsOneRegionHoweverFarItsPointsAreApart) {
  TwoParts parts(1, 1);
  parts.place(1, 0);
  EXPECT_EQ(parts.clusters_at(10 * kNear_m), 1);
}

TEST(FingerRegions, PiecesOfARigidToolGoByDistanceAlone) {
  TwoParts parts(1, 2);
  parts.model.params.articulation = Articulation::kRigid;
  EXPECT_EQ(parts.clusters_at(0.99 * kNear_m), 1);
}

}  // namespace
}  // namespace palpate
