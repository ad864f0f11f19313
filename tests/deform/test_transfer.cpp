// What later regions carry over to earlier ones through their skeletons: CouplingLaw::kTemporalPaper.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "rt_core/contact/points/point_laws.h"
#include "rt_core/skeleton/skeleton.h"
#include "tests/deform/deform_scene.h"
#include "tests/support/roomy.h"

namespace palpate {
namespace {

using deform_test::ellipsoid_point;
using deform_test::make_region;
using deform_test::Scene;

class Transfer : public ::testing::Test {
 protected:
  void SetUp() override { deform_test::make_ellipsoid(scene_); }
  Model& model() { return scene_.model; }
  // What the regions, first born first, get from those after them.
  std::vector<Real> added(std::vector<Region> regions) {
    std::vector<std::int32_t> slot;
    reset(state_);
    for (std::size_t i = 0; i < regions.size(); ++i) {
      slot.push_back(static_cast<std::int32_t>(15 - 3 * i));  // the order is the caller's, not the slots'
      state_.region[slot.back()] = regions[i];
    }
    std::vector<Real> sum(regions.size());
    all_carried_ =
        add_transferred_forces(model(), state_, slot.data(), static_cast<std::int32_t>(slot.size()), sum.data());
    return sum;
  }
  // Displacements of the anchors by a region pressing on the anchors moved by `offset_w`.
  std::vector<Vec3> displacements(const Region& region, const std::vector<Vec3>& offset_w) {
    Skeleton s;
    EXPECT_TRUE(solve_skeleton(model(), offset_w, region.centre_w, -region.normal_force_N * region.normal_w, s));
    std::vector<Vec3> moved;
    for (std::int32_t a = 0; a < s.count; ++a)
      moved.push_back(anchor_displacement(s, scene_.anchors[static_cast<std::size_t>(a)], a));
    return moved;
  }
  // The definition: weights of the anchors at `to` by dense elimination of M w = g, shares of `from` on the anchors
  // moved by `offset_w`.
  Real expected(const Region& from, const Region& to, const std::vector<Vec3>& offset_w) {
    Skeleton s;
    EXPECT_TRUE(solve_skeleton(model(), offset_w, from.centre_w, from.normal_force_N * from.normal_w, s));
    deform_test::Dense m(7, deform_test::Row(7, 0));
    deform_test::Row g(7, 1);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        m[i][j] = deform_test::distance(scene_.anchors[i].position_m, scene_.anchors[j].position_m);
      }
      m[i][6] = m[6][i] = 1;
      g[i] = deform_test::distance(scene_.anchors[i].position_m, to.centre_w);
    }
    const deform_test::Row w = deform_test::solve_dense(m, g);
    Vec3 force;
    for (std::size_t i = 0; i < 6; ++i) force += static_cast<double>(w[i]) * s.force_w[i];
    return std::fabs(dot(force, to.normal_w));
  }
  Scene scene_;
  const StatePtr memory_ = test::roomy_state();
  State& state_ = *memory_;
  bool all_carried_ = true;
  const Region top_ = make_region(1, 10, ellipsoid_point(0.4, 0.3), {0, 0, 1}, 5);
  const Region side_ = make_region(2, 20, ellipsoid_point(1.2, 2.5), {0, 1, 0}, 8);
};

TEST_F(Transfer, MatchesItsDefinitionByDenseSolve) {
  for (const SkeletonLaw law : {SkeletonLaw::kStiffness, SkeletonLaw::kPaper}) {
    model().params.skeleton_law = law;
    const std::vector<Real> sum = added({side_, top_});
    EXPECT_NEAR(sum[0], expected(top_, side_, displacements(side_, {})), 1e-12);
    EXPECT_NE(sum[0], 0);
    EXPECT_EQ(sum[1], 0);  // nobody came after it
    EXPECT_TRUE(all_carried_);
  }
}

TEST_F(Transfer, IsOnTheToolSide) {
  // Two presses close together on top: the neighbour adds to the force on the tool.
  Region near = top_;
  near.id = 5;
  near.centre_w = ellipsoid_point(0.5, 0.5);
  const Real once = added({near, top_})[0];
  EXPECT_GT(once, 0);
  EXPECT_LT(once, top_.normal_force_N);
  Region twice = top_;
  twice.normal_force_N = 10;  // linear in the force
  EXPECT_NEAR(added({near, twice})[0], 2 * once, 1e-12);
  // And so does one that presses from the other side, through the body.
  Region below = top_;
  below.id = 6;
  below.normal_w = -1.0 * top_.normal_w;
  EXPECT_GT(added({near, below})[0], 0);
}

TEST_F(Transfer, IsNotReciprocal) {
  Region a = top_, b = side_;
  a.normal_force_N = b.normal_force_N = 1;
  // Hence the paper's rule stores no energy function.
  EXPECT_GT(std::fabs(added({b, a})[0] - added({a, b})[0]), 1e-3);
}

// The region born later stands on the anchors where all the earlier ones moved them in this tick.
TEST_F(Transfer, UsesAnchorsDisplacedByEarlierRegions) {
  Region third = top_;
  third.id = 9;
  third.centre_w = ellipsoid_point(0.9, 2.0);
  const std::vector<Vec3> first = displacements(top_, {});
  std::vector<Vec3> both = displacements(side_, first);
  for (std::size_t a = 0; a < both.size(); ++a) both[a] += first[a];
  const std::vector<Real> sum = added({top_, side_, third});
  EXPECT_NEAR(sum[0], expected(side_, top_, first) + expected(third, top_, both), 1e-12);
  EXPECT_NEAR(sum[1], expected(third, side_, both), 1e-12);
  EXPECT_EQ(sum[2], 0);
  EXPECT_GT(std::fabs(expected(third, side_, both) - expected(third, side_, {})), 1e-6);
}

TEST_F(Transfer, IsZeroWhereItIsUndefined) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(added({side_, top_})[0], 0);
  EXPECT_EQ(added({side_})[0], 0);
  Region bad = top_;
  bad.normal_force_N = nan;
  EXPECT_EQ(added({side_, bad})[0], 0);
  EXPECT_FALSE(all_carried_);
  bad = side_;
  bad.centre_w.y = nan;
  EXPECT_EQ(added({bad, top_})[0], 0);
  EXPECT_FALSE(all_carried_);
  model().sizes.n_rbf = 0;
  EXPECT_EQ(added({side_, top_})[0], 0);
  EXPECT_TRUE(all_carried_);
}

}  // namespace
}  // namespace palpate
