#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "rt_core/skeleton/skeleton.h"
#include "rt_core/skeleton/temporal_order.h"
#include "rt_core/skeleton/transfer.h"
#include "rt_core/stages.h"
#include "tests/deform/deform_scene.h"

namespace palpate {
namespace {

using deform_test::ellipsoid_point;
using deform_test::make_region;
using deform_test::Scene;

class DeformStage : public ::testing::Test {
 protected:
  void SetUp() override { deform_test::make_ellipsoid(scene_); }
  Model& model() { return scene_.model; }
  void set(CouplingLaw law) { model().params.coupling_law = static_cast<std::int32_t>(law); }
  void set(SkeletonLaw law) { model().params.skeleton_law = static_cast<std::int32_t>(law); }
  void run() {
    scratch_.status = 0;
    deform(model(), state_, scratch_);
  }
  void run(Region first, Region second) {
    state_ = {};
    state_.region[0] = first;
    state_.region[1] = second;
    run();
  }
  std::int32_t anchors() const { return static_cast<std::int32_t>(scene_.anchors.size()); }
  Scene scene_;
  State state_;
  Scratch scratch_{};
  const Region top_ = make_region(1, 10, ellipsoid_point(0.4, 0.3), {0, 0, 1}, 5);
  const Region side_ = make_region(2, 20, ellipsoid_point(1.2, 2.5), {0, 1, 0}, 8);
};

TEST_F(DeformStage, MatchesTheSkeletonOfTheRegion) {
  for (const SkeletonLaw law : {SkeletonLaw::kStiffness, SkeletonLaw::kPaper}) {
    set(law);
    state_ = {};
    state_.region[3] = top_;
    state_.region[3].friction_force_w = {0.5, -0.25, 0};
    run();
    EXPECT_EQ(scratch_.status, 0u);
    Skeleton s;
    ASSERT_TRUE(solve_skeleton(model(), {}, top_.centre_w, {-0.5, 0.25, -5}, s));
    for (std::int32_t a = 0; a < anchors(); ++a) {
      const Anchor& anchor = scene_.anchors[static_cast<std::size_t>(a)];
      const SkeletonAnchor expected = skeleton_anchor(s, anchor, 0.47, a);
      EXPECT_EQ(state_.anchor[a].displacement_w, expected.displacement_w);
      EXPECT_EQ(state_.anchor_by_region[3][a], expected.displacement_w);
      EXPECT_EQ(state_.anchor[a].axial_stress_Pa, expected.stress.axial_Pa);
      EXPECT_EQ(state_.anchor[a].shear_stress_Pa, expected.stress.shear_Pa);
      EXPECT_EQ(state_.anchor[a].stress_Pa, abs_of(expected.stress.axial_Pa) + expected.stress.bending_Pa);
      EXPECT_EQ(norm(expected.displacement_w) > 0, anchor.fixed == 0);
    }
    EXPECT_LT(dot(state_.anchor[4].displacement_w, {0, 0, 1}), 0);  // the anchor next to the press goes in with it
  }
}

TEST_F(DeformStage, SumsDisplacementsAndKeepsTheLargestStresses) {
  run(top_, side_);
  const State both = state_;
  run(top_, Region{});
  const State first = state_;
  run(Region{}, side_);
  for (std::int32_t a = 0; a < anchors(); ++a) {
    const AnchorState &s1 = first.anchor[a], &s2 = state_.anchor[a], &s = both.anchor[a];
    EXPECT_EQ(s.displacement_w, s1.displacement_w + s2.displacement_w);
    EXPECT_EQ(s.stress_Pa, std::max(s1.stress_Pa, s2.stress_Pa));
    EXPECT_EQ(s.shear_stress_Pa, std::max(s1.shear_stress_Pa, s2.shear_stress_Pa));
    EXPECT_EQ(std::fabs(s.axial_stress_Pa), std::max(std::fabs(s1.axial_stress_Pa), std::fabs(s2.axial_stress_Pa)));
    EXPECT_EQ(both.anchor_by_region[0][a], first.anchor_by_region[0][a]);
    EXPECT_EQ(both.anchor_by_region[1][a], state_.anchor_by_region[1][a]);
  }
}

// Temporal order: the region born later stands on anchors the earlier one moved. The paper's property: swapping the
// order changes the answer. Without temporal coupling it does not.
TEST_F(DeformStage, TemporalOrderMattersOnlyInTemporalCoupling) {
  for (const CouplingLaw law : {CouplingLaw::kNone, CouplingLaw::kCoupled, CouplingLaw::kTemporal}) {
    set(law);
    run(top_, side_);
    const State early_top = state_;
    Region late_top = top_;
    late_top.born_tick = 30;
    run(late_top, side_);
    double difference = 0;
    for (std::int32_t a = 0; a < anchors(); ++a) {
      difference = std::max(difference, norm(early_top.anchor[a].displacement_w - state_.anchor[a].displacement_w));
    }
    if (law == CouplingLaw::kTemporal) {
      EXPECT_GT(difference, 1e-7);
    } else {
      EXPECT_EQ(difference, 0);
    }
  }
}

TEST_F(DeformStage, TemporalOrderBuildsOnDisplacedAnchors) {
  set(CouplingLaw::kTemporal);
  Region later_in_slot_0 = side_;
  run(later_in_slot_0, top_);  // top is born first but sits in slot 1: order is by birth, not by slot
  const State state = state_;
  Skeleton s;
  ASSERT_TRUE(solve_skeleton(model(), {}, top_.centre_w, {0, 0, -5}, s));
  std::vector<Vec3> offset;
  for (std::int32_t a = 0; a < anchors(); ++a) {
    offset.push_back(skeleton_anchor(s, scene_.anchors[static_cast<std::size_t>(a)], 0.47, a).displacement_w);
    EXPECT_EQ(state.anchor_by_region[1][a], offset.back());
  }
  ASSERT_TRUE(solve_skeleton(model(), offset, side_.centre_w, {0, -8, 0}, s));
  for (std::int32_t a = 0; a < anchors(); ++a) {
    EXPECT_EQ(state.anchor_by_region[0][a],
              skeleton_anchor(s, scene_.anchors[static_cast<std::size_t>(a)], 0.47, a).displacement_w);
  }
}

TEST_F(DeformStage, OrderIsByBirthThenById) {
  const std::uint32_t born[5] = {7, 3, 7, 1, 3}, id[5] = {9, 8, 2, 5, 4};
  for (int i = 0; i < 5; ++i) state_.region[2 * i] = make_region(id[i], born[i], {}, {0, 0, 1}, 1);
  state_.region[1] = make_region(1, 0, {}, {0, 0, 1}, 1);
  state_.region[1].lost_ticks = 3;  // not in contact
  std::int32_t order[kMaxRegions];
  ASSERT_EQ(contact_order(state_, order), 5);
  const std::int32_t expected[5] = {6, 8, 2, 4, 0};
  for (int i = 0; i < 5; ++i) EXPECT_EQ(order[i], expected[i]);
}

TEST_F(DeformStage, LostRegionsLeaveNoTrace) {
  run(top_, side_);
  state_.region[0].lost_ticks = 1;
  state_.region[1] = Region{};
  run();
  for (std::int32_t a = 0; a < anchors(); ++a) {
    EXPECT_EQ(state_.anchor[a].displacement_w, Vec3{});
    EXPECT_EQ(state_.anchor[a].stress_Pa, 0);
    for (const auto& by_region : state_.anchor_by_region) EXPECT_EQ(by_region[a], Vec3{});
  }
}

TEST_F(DeformStage, NoSkeletonOrNoAnchorsIsNotAFault) {
  set(SkeletonLaw::kNone);
  run(top_, side_);
  EXPECT_EQ(scratch_.status, 0u);
  EXPECT_EQ(state_.anchor[0].displacement_w, Vec3{});
  Scene bare;
  bare.model.params = model().params;
  bare.model.params.skeleton_law = static_cast<std::int32_t>(SkeletonLaw::kStiffness);
  deform(bare.model, state_, scratch_);
  EXPECT_EQ(scratch_.status, 0u);
}

TEST_F(DeformStage, DegenerateSkeletonsAreFlaggedAndKeepStill) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Region bad = top_;
  bad.normal_force_N = nan;
  run(bad, side_);  // the other region is rendered all the same
  EXPECT_EQ(scratch_.status, Status::kSkeletonDegenerate);
  EXPECT_EQ(state_.anchor_by_region[0][0], Vec3{});
  EXPECT_GT(norm(state_.anchor_by_region[1][0]), 0);
  bad = top_;
  bad.centre_w = {nan, 0, 0};
  run(bad, Region{});
  EXPECT_EQ(scratch_.status, Status::kSkeletonDegenerate);
  EXPECT_EQ(state_.anchor[0].displacement_w, Vec3{});
  for (Anchor& a : scene_.anchors) a.section_inertia_m4 = 0;
  for (const SkeletonLaw law : {SkeletonLaw::kStiffness, SkeletonLaw::kPaper}) {
    set(law);
    run(top_, Region{});
    EXPECT_EQ(scratch_.status, Status::kSkeletonDegenerate);
    EXPECT_EQ(state_.anchor[0].displacement_w, Vec3{});
  }
}

TEST_F(DeformStage, ContactAtAnAnchorMovesThatAnchorWithTheSkeleton) {
  Region region = top_;
  region.centre_w = {0, 0, 25e-3};
  run(region, Region{});
  EXPECT_EQ(scratch_.status, 0u);
  Skeleton s;
  ASSERT_TRUE(solve_skeleton(model(), {}, region.centre_w, {0, 0, -5}, s));
  EXPECT_LT(norm(state_.anchor[4].displacement_w - s.displacement_w), 1e-15);
  region.centre_w = {0, 0, -25e-3};  // the fixed one
  run(region, Region{});
  EXPECT_EQ(state_.anchor[5].displacement_w, Vec3{});
}

TEST_F(DeformStage, SameInputsGiveTheSameBits) {
  set(CouplingLaw::kTemporal);
  run(top_, side_);
  const State first = state_;
  // Poison what the stage must overwrite; a second run also starts from other anchors.
  for (AnchorState& anchor : state_.anchor) anchor.displacement_w = {1, 2, 3};
  for (auto& by_region : state_.anchor_by_region) {
    for (Vec3& d : by_region) d = {4, 5, 6};
  }
  run();
  for (std::int32_t a = 0; a < anchors(); ++a) {
    EXPECT_EQ(std::memcmp(&first.anchor[a], &state_.anchor[a], sizeof(AnchorState)), 0);
    for (int slot = 0; slot < kMaxRegions; ++slot) {
      EXPECT_EQ(state_.anchor_by_region[slot][a], first.anchor_by_region[slot][a]);
    }
  }
}

// Transfer between regions.
TEST_F(DeformStage, TransferMatchesItsDefinitionByDenseSolve) {
  run(top_, side_);
  Skeleton s;
  ASSERT_TRUE(solve_skeleton(model(), {}, top_.centre_w, {0, 0, 5}, s));
  // Weights of the anchors at the other contact, by dense elimination of M w = g.
  deform_test::Dense m(7, deform_test::Row(7, 0));
  deform_test::Row g(7, 1);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      m[i][j] = deform_test::distance(scene_.anchors[i].position_m, scene_.anchors[j].position_m);
    }
    m[i][6] = m[6][i] = 1;
    g[i] = deform_test::distance(scene_.anchors[i].position_m, side_.centre_w);
  }
  const deform_test::Row w = deform_test::solve_dense(m, g);
  Vec3 expected;
  for (std::size_t i = 0; i < 6; ++i) expected += static_cast<double>(w[i]) * s.force_w[i];
  EXPECT_LT(norm(transferred_force_w(model(), state_, 0, 1) - expected), 1e-12);
}

TEST_F(DeformStage, TransferIsOnTheToolSide) {
  // Two presses close together on top: the neighbour adds to the force on the tool.
  Region near = top_;
  near.id = 5;
  near.centre_w = ellipsoid_point(0.5, 0.5);
  run(top_, near);
  const Vec3 added = transferred_force_w(model(), state_, 0, 1);
  EXPECT_GT(added.z, 0);
  EXPECT_LT(norm(added), top_.normal_force_N);
  // The weights sum to one: a force shared equally by all beams would arrive whole divided by their number.
  state_.region[0].normal_force_N = 10;  // linear in the force
  EXPECT_LT(norm(transferred_force_w(model(), state_, 0, 1) - 2.0 * added), 1e-12);
}

TEST_F(DeformStage, TransferIsNotReciprocal) {
  Region a = top_, b = side_;
  a.normal_force_N = b.normal_force_N = 1;
  run(a, b);
  const double forward = dot(transferred_force_w(model(), state_, 0, 1), b.normal_w);
  const double backward = dot(transferred_force_w(model(), state_, 1, 0), a.normal_w);
  EXPECT_GT(std::fabs(forward - backward), 1e-3);  // hence the paper's rule stores no energy function
}

TEST_F(DeformStage, TransferUsesAnchorsDisplacedByEarlierRegions) {
  run(top_, side_);
  const Vec3 rest = transferred_force_w(model(), state_, 1, 0);
  set(CouplingLaw::kTemporal);
  run(top_, side_);
  const Vec3 displaced = transferred_force_w(model(), state_, 1, 0);
  EXPECT_GT(norm(displaced - rest), 1e-6);
  Region first = side_;
  first.born_tick = 1;  // nobody before it: rest anchors
  run(top_, first);
  EXPECT_EQ(transferred_force_w(model(), state_, 1, 0), rest);
}

// All pairs at once, one skeleton per region: the same bits as pair by pair.
TEST_F(DeformStage, AllTransfersAtOnceAreTheSumOfThePairs) {
  set(CouplingLaw::kTemporal);
  run(top_, side_);
  Region third = top_;
  third.id = 9;
  third.born_tick = 7;
  third.centre_w = ellipsoid_point(0.9, 2.0);
  state_.region[2] = third;
  const std::int32_t slot[] = {0, 1, 2};
  Real added[3] = {};
  add_transferred_forces(model(), state_, slot, 3, added);
  for (int i = 0; i < 3; ++i) {
    Real expected = 0;
    for (int j = i + 1; j < 3; ++j)
      expected += dot(transferred_force_w(model(), state_, slot[j], slot[i]), state_.region[slot[i]].normal_w);
    EXPECT_EQ(added[i], expected) << i;
  }
  EXPECT_NE(added[0], 0);
  EXPECT_EQ(added[2], 0);
}

TEST_F(DeformStage, TransferIsZeroWhereItIsUndefined) {
  run(top_, side_);
  EXPECT_GT(norm(transferred_force_w(model(), state_, 0, 1)), 0);
  EXPECT_EQ(transferred_force_w(model(), state_, 0, 0), Vec3{});
  EXPECT_EQ(transferred_force_w(model(), state_, 0, 7), Vec3{});
  EXPECT_EQ(transferred_force_w(model(), state_, -1, 0), Vec3{});
  EXPECT_EQ(transferred_force_w(model(), state_, 0, kMaxRegions), Vec3{});
  state_.region[1].lost_ticks = 1;
  EXPECT_EQ(transferred_force_w(model(), state_, 0, 1), Vec3{});
  state_.region[1].lost_ticks = 0;
  state_.region[0].normal_force_N = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(transferred_force_w(model(), state_, 0, 1), Vec3{});
  state_.region[0].normal_force_N = 5;
  state_.region[1].centre_w.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(transferred_force_w(model(), state_, 0, 1), Vec3{});
  state_.region[1].centre_w = side_.centre_w;
  EXPECT_GT(norm(transferred_force_w(model(), state_, 0, 1)), 0);
  model().sizes.n_rbf = 0;
  EXPECT_EQ(transferred_force_w(model(), state_, 0, 1), Vec3{});
}

}  // namespace
}  // namespace palpate
