#include <gtest/gtest.h>

#include <limits>

#include "rt_core/contact/regions.h"
#include "sim_host/view/anchors.h"
#include "tests/deform/deform_scene.h"
#include "tests/support/roomy.h"

namespace palpate {
namespace {

using deform_test::ellipsoid_point;
using deform_test::make_region;
using deform_test::Scene;

class AnchorsOf : public ::testing::Test {
 protected:
  void SetUp() override { deform_test::make_ellipsoid(scene_); }
  Model& model() { return scene_.model; }
  void set(CouplingLaw law) { model().params.coupling_law = law; }
  void set(SkeletonLaw law) { model().params.skeleton_law = law; }
  void run() { field_ = anchors_of(model(), state_); }
  void run(Region first, Region second) {
    reset(state_);
    state_.region[0] = first;
    state_.region[1] = second;
    run();
  }
  std::int32_t anchors() const { return static_cast<std::int32_t>(scene_.anchors.size()); }
  Scene scene_;
  const StatePtr memory_ = test::roomy_state();
  State& state_ = *memory_;
  AnchorField field_;
  const Region top_ = make_region(1, 10, ellipsoid_point(0.4, 0.3), {0, 0, 1}, 5);
  const Region side_ = make_region(2, 20, ellipsoid_point(1.2, 2.5), {0, 1, 0}, 8);
};

TEST_F(AnchorsOf, MatchesTheSkeletonOfTheRegion) {
  for (const SkeletonLaw law : {SkeletonLaw::kStiffness, SkeletonLaw::kPaper}) {
    set(law);
    reset(state_);
    state_.region[3] = top_;
    state_.region[3].friction_force_w = {0.5, -0.25, 0};
    run();
    EXPECT_EQ(field_.degenerate, 0);
    Skeleton s;
    ASSERT_TRUE(solve_skeleton(model(), {}, top_.centre_w, {-0.5, 0.25, -5}, s));
    for (std::int32_t a = 0; a < anchors(); ++a) {
      const Anchor& anchor = scene_.anchors[static_cast<std::size_t>(a)];
      const Vec3 displacement = anchor_displacement(s, anchor, a);
      const BeamStress stress = straight_beam_stress(s.beam[a], section_of(anchor), 0.47, s.force_w[a]);
      EXPECT_EQ(field_.anchor[a].displacement_w, displacement);
      EXPECT_EQ(field_.by_region_w[3][a], displacement);
      EXPECT_EQ(field_.anchor[a].force_w, s.force_w[a]);
      EXPECT_EQ(field_.anchor[a].axial_stress_Pa, stress.axial_Pa);
      EXPECT_EQ(field_.anchor[a].shear_stress_Pa, stress.shear_Pa);
      EXPECT_EQ(field_.anchor[a].stress_Pa, abs_of(stress.axial_Pa) + stress.bending_Pa);
      EXPECT_EQ(norm(displacement) > 0, anchor.fixed == 0);
    }
    EXPECT_LT(dot(field_.anchor[4].displacement_w, {0, 0, 1}), 0);  // the anchor next to the press goes in with it
  }
}

TEST_F(AnchorsOf, SumsDisplacementsAndStresses) {
  run(top_, side_);
  const AnchorField both = field_;
  run(top_, Region{});
  const AnchorField first = field_;
  run(Region{}, side_);
  for (std::int32_t a = 0; a < anchors(); ++a) {
    const AnchorLoad &s1 = first.anchor[a], &s2 = field_.anchor[a], &s = both.anchor[a];
    EXPECT_EQ(s.displacement_w, s1.displacement_w + s2.displacement_w);
    EXPECT_EQ(s.force_w, s1.force_w + s2.force_w);
    EXPECT_EQ(s.stress_Pa, s1.stress_Pa + s2.stress_Pa);
    EXPECT_EQ(s.shear_stress_Pa, s1.shear_stress_Pa + s2.shear_stress_Pa);
    EXPECT_EQ(s.axial_stress_Pa, s1.axial_stress_Pa + s2.axial_stress_Pa);
    EXPECT_EQ(both.by_region_w[0][a], first.by_region_w[0][a]);
    EXPECT_EQ(both.by_region_w[1][a], field_.by_region_w[1][a]);
  }
}

// Temporal order: the region born later stands on anchors the earlier one moved. The paper's property: swapping the
// order changes the answer. Without temporal coupling it does not.
TEST_F(AnchorsOf, TemporalOrderMattersOnlyInTemporalCoupling) {
  for (const CouplingLaw law : {CouplingLaw::kNone, CouplingLaw::kCoupled, CouplingLaw::kTemporalPaper}) {
    set(law);
    run(top_, side_);
    const AnchorField early_top = field_;
    Region late_top = top_;
    late_top.born_tick = 30;
    run(late_top, side_);
    double difference = 0;
    for (std::int32_t a = 0; a < anchors(); ++a) {
      difference = std::max(difference, norm(early_top.anchor[a].displacement_w - field_.anchor[a].displacement_w));
    }
    if (law == CouplingLaw::kTemporalPaper) {
      EXPECT_GT(difference, 1e-7);
    } else {
      EXPECT_EQ(difference, 0);
    }
  }
}

TEST_F(AnchorsOf, TemporalOrderBuildsOnDisplacedAnchors) {
  set(CouplingLaw::kTemporalPaper);
  Region later_in_slot_0 = side_;
  run(later_in_slot_0, top_);  // top is born first but sits in slot 1: order is by birth, not by slot
  Skeleton s;
  ASSERT_TRUE(solve_skeleton(model(), {}, top_.centre_w, {0, 0, -5}, s));
  std::vector<Vec3> offset;
  for (std::int32_t a = 0; a < anchors(); ++a) {
    offset.push_back(anchor_displacement(s, scene_.anchors[static_cast<std::size_t>(a)], a));
    EXPECT_EQ(field_.by_region_w[1][a], offset.back());
  }
  ASSERT_TRUE(solve_skeleton(model(), offset, side_.centre_w, {0, -8, 0}, s));
  for (std::int32_t a = 0; a < anchors(); ++a) {
    EXPECT_EQ(field_.by_region_w[0][a], anchor_displacement(s, scene_.anchors[static_cast<std::size_t>(a)], a));
  }
}

TEST_F(AnchorsOf, OrderIsByBirthThenById) {
  const std::uint32_t born[5] = {7, 3, 7, 1, 3}, id[5] = {9, 8, 2, 5, 4};
  for (int i = 0; i < 5; ++i) state_.region[2 * i] = make_region(id[i], born[i], {}, {0, 0, 1}, 1);
  state_.region[1] = make_region(1, 0, {}, {0, 0, 1}, 1);
  state_.region[1].lost_ticks = 3;  // not in contact
  std::int32_t order[kMaxRegions];
  ASSERT_EQ(contact_order(state_, order), 5);
  const std::int32_t expected[5] = {6, 8, 2, 4, 0};
  for (int i = 0; i < 5; ++i) EXPECT_EQ(order[i], expected[i]);
}

TEST_F(AnchorsOf, LostRegionsLeaveNoTrace) {
  run(top_, side_);
  state_.region[0].lost_ticks = 1;
  state_.region[1] = Region{};
  run();
  for (std::int32_t a = 0; a < anchors(); ++a) {
    EXPECT_EQ(field_.anchor[a].displacement_w, Vec3{});
    EXPECT_EQ(field_.anchor[a].stress_Pa, 0);
    for (const auto& by_region : field_.by_region_w) EXPECT_EQ(by_region[a], Vec3{});
  }
}

TEST_F(AnchorsOf, NoSkeletonOrNoAnchorsIsNotAFault) {
  set(SkeletonLaw::kNone);
  run(top_, side_);
  EXPECT_EQ(field_.degenerate, 0);
  EXPECT_EQ(field_.anchor[0].displacement_w, Vec3{});
  Scene bare;
  bare.model.params = model().params;
  bare.model.params.skeleton_law = SkeletonLaw::kStiffness;
  EXPECT_EQ(anchors_of(bare.model, state_).count, 0);
}

TEST_F(AnchorsOf, DegenerateSkeletonsAreFlaggedAndKeepStill) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Region bad = top_;
  bad.normal_force_N = nan;
  run(bad, side_);  // the other region is rendered all the same
  EXPECT_EQ(field_.degenerate, 1);
  EXPECT_EQ(field_.by_region_w[0][0], Vec3{});
  EXPECT_GT(norm(field_.by_region_w[1][0]), 0);
  bad = top_;
  bad.centre_w = {nan, 0, 0};
  run(bad, Region{});
  EXPECT_EQ(field_.degenerate, 1);
  EXPECT_EQ(field_.anchor[0].displacement_w, Vec3{});
  for (Anchor& a : scene_.anchors) a.section_inertia_m4 = 0;
  for (const SkeletonLaw law : {SkeletonLaw::kStiffness, SkeletonLaw::kPaper}) {
    set(law);
    run(top_, Region{});
    EXPECT_EQ(field_.degenerate, 1);
    EXPECT_EQ(field_.anchor[0].displacement_w, Vec3{});
  }
}

TEST_F(AnchorsOf, ContactAtAnAnchorMovesThatAnchorWithTheSkeleton) {
  Region region = top_;
  region.centre_w = {0, 0, 25e-3};
  run(region, Region{});
  EXPECT_EQ(field_.degenerate, 0);
  Skeleton s;
  ASSERT_TRUE(solve_skeleton(model(), {}, region.centre_w, {0, 0, -5}, s));
  EXPECT_LT(norm(field_.anchor[4].displacement_w - s.displacement_w), 1e-15);
  region.centre_w = {0, 0, -25e-3};  // the fixed one
  run(region, Region{});
  EXPECT_EQ(field_.anchor[5].displacement_w, Vec3{});
}

}  // namespace
}  // namespace palpate
