// What regions carry over to one another by the beams between them: CouplingLaw::kMutualPaper (Luo & Xiao 2006, VI).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "rt_core/contact/points/point_laws.h"
#include "rt_core/skeleton/mutual_skeleton.h"
#include "sim_host/view/anchors.h"
#include "tests/deform/deform_scene.h"
#include "tests/support/roomy.h"

namespace palpate {
namespace {

using deform_test::ellipsoid_point;
using deform_test::make_region;
using deform_test::Scene;

class Mutual : public ::testing::Test {
 protected:
  void SetUp() override {
    deform_test::make_ellipsoid(scene_);
    model().params.coupling_law = CouplingLaw::kMutualPaper;
  }
  Model& model() { return scene_.model; }
  std::int32_t anchors() { return static_cast<std::int32_t>(scene_.anchors.size()); }

  std::vector<Real> added(const std::vector<Region>& regions) {
    place(regions);
    std::vector<Real> sum(regions.size());
    all_carried_ =
        add_mutual_forces(model(), state_, slot_.data(), static_cast<std::int32_t>(slot_.size()), sum.data());
    return sum;
  }
  void place(const std::vector<Region>& regions) {
    reset(state_);
    slot_.clear();
    for (std::size_t i = 0; i < regions.size(); ++i) {
      slot_.push_back(static_cast<std::int32_t>(15 - 3 * i));  // the order is the caller's, not the slots'
      state_.region[slot_.back()] = regions[i];
    }
  }
  // The definition: the 3 x 3 matrices of all beams summed, one dense solve in long double, and the share of the beam
  // between the two contacts. (A single beam's stiffness along and across is tested in
  // tests/deform/test_straight_beam.cpp.)
  Real expected(const Region& from, const Region& to) {
    deform_test::Dense sum(3, deform_test::Row(3, 0)), between;
    for (std::size_t a = 0; a <= scene_.anchors.size(); ++a) {
      const bool is_between = a == scene_.anchors.size();
      const Anchor& section = scene_.anchors[is_between ? 0 : a];
      const deform_test::Dense k = matrix(is_between ? to.centre_w : section.position_m, from.centre_w,
                                          section_of(section), 2 * section.section_radius_m);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) sum[i][j] += k[i][j];
      if (is_between) between = k;
    }
    const Vec3 f = from.normal_force_N * from.normal_w;
    const deform_test::Row d =
        deform_test::solve_dense(sum, {deform_test::wide(f.x), deform_test::wide(f.y), deform_test::wide(f.z)});
    long double along = 0;
    for (int i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        along +=
            deform_test::wide(deform_test::component(to.normal_w, i)) * between[static_cast<std::size_t>(i)][j] * d[j];
    return static_cast<Real>(std::fabs(along));
  }
  deform_test::Dense matrix(Vec3 end, Vec3 contact, const BeamSection& section, Real least_m) {
    const Vec3 way = contact - end;
    const StraightBeam beam = make_straight_beam(skeleton_setup(model()).material, section, end, contact, {0, 0, 1},
                                                 BeamTheory::kTimoshenko, least_m);
    const Real length = std::sqrt(dot(way, way));
    const Vec3 x = (1 / length) * way;
    deform_test::Dense k(3, deform_test::Row(3, 0));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const Real xx = deform_test::component(x, i) * deform_test::component(x, j);
        k[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
            deform_test::wide(beam.axial_N_per_m * xx + beam.bending_N_per_m * ((i == j ? 1.0 : 0.0) - xx));
      }
    return k;
  }
  Skeleton skeleton_of(std::int32_t from) {
    Skeleton s;
    const Region& region = state_.region[slot_[static_cast<std::size_t>(from)]];
    EXPECT_TRUE(solve_mutual_skeleton(model(), state_, slot_, from, region.normal_force_N * region.normal_w, s));
    return s;
  }

  Scene scene_;
  const StatePtr memory_ = test::roomy_state();
  State& state_ = *memory_;
  std::vector<std::int32_t> slot_;
  bool all_carried_ = true;
  const Region top_ = make_region(1, 10, ellipsoid_point(0.4, 0.3), {0, 0, 1}, 5);
  const Region side_ = make_region(2, 20, ellipsoid_point(1.2, 2.5), {0, 1, 0}, 8);
};

TEST_F(Mutual, MatchesItsDefinitionByDenseSolve) {
  const std::vector<Real> sum = added({side_, top_});
  EXPECT_TRUE(all_carried_);
  EXPECT_NEAR(sum[0], expected(top_, side_), 1e-12);
  EXPECT_NEAR(sum[1], expected(side_, top_), 1e-12);
  EXPECT_GT(sum[0], 1e-3);  // both ways, unlike the temporal rule
  EXPECT_GT(sum[1], 1e-3);
}

// Nobody came first: the order in which regions are given is no part of the law.
TEST_F(Mutual, HasNoOrder) {
  Region third = top_;
  third.id = 9;
  third.centre_w = ellipsoid_point(0.9, 2.0);
  const std::vector<Real> one = added({top_, side_, third}), other = added({third, top_, side_});
  EXPECT_NEAR(one[0], other[1], 1e-14);
  EXPECT_NEAR(one[1], other[2], 1e-14);
  EXPECT_NEAR(one[2], other[0], 1e-14);
}

// By stiffness the beams of a skeleton carry its force between them, those to other contacts included.
TEST_F(Mutual, BeamsCarryTheForceTogether) {
  place({top_, side_});
  const Skeleton s = skeleton_of(0);
  ASSERT_EQ(s.count, anchors() + 1);
  Vec3 sum;
  for (std::int32_t b = 0; b < s.count; ++b) sum += s.force_w[b];
  EXPECT_LT(norm(sum - top_.normal_force_N * top_.normal_w), 1e-12);
}

// The printed ratios: eq. 6 along the beams by S/l, eq. 7 across them by I/l^3, for the beam between contacts as for
// any.
TEST_F(Mutual, SharesByThePrintedRatios) {
  model().params.skeleton_law = SkeletonLaw::kPaper;
  place({top_, side_});
  const Skeleton s = skeleton_of(0);
  const BeamSection section = section_of(scene_.anchors[0]);
  const auto ratios = [&](std::int32_t b, Vec3 end) {
    const Vec3 way = top_.centre_w - end;
    const Real length = norm(way);
    const Vec3 x = (1 / length) * way, d = top_.normal_w;
    const Real along = dot(s.force_w[b], x) / (section.area_m2 / length * dot(d, x));
    const Vec3 across = d - dot(d, x) * x;
    const Real bend =
        dot(s.force_w[b], across) / (section.inertia_m4 / (length * length * length) * dot(across, across));
    return std::pair{along, bend};
  };
  const auto [alpha, beta] = ratios(0, scene_.anchors[0].position_m);
  const auto [alpha_between, beta_between] = ratios(mutual_beam(model(), 0, 1), side_.centre_w);
  EXPECT_NEAR(alpha_between, alpha, 1e-9 * std::abs(alpha));
  EXPECT_NEAR(beta_between, beta, 1e-9 * std::abs(beta));
}

// The nearer a contact, the stiffer the beam to it.
TEST_F(Mutual, NearContactsGetMore) {
  Region near = top_, far = top_;
  near.id = 5;
  near.centre_w = ellipsoid_point(0.4, 0.9);
  far.id = 6;
  far.centre_w = ellipsoid_point(0.4, 3.4);
  EXPECT_GT(added({near, top_})[0], added({far, top_})[0]);
}

TEST_F(Mutual, OneRegionGetsNothing) {
  EXPECT_EQ(added({top_})[0], 0);
  EXPECT_TRUE(all_carried_);
}

// As many regions as there can be, on as many anchors as are allowed: within the skeleton's beams. One anchor more is
// refused by baker and loader; here it carries nothing.
TEST_F(Mutual, FullHouse) {
  std::vector<Anchor> many(kMaxMutualAnchors, scene_.anchors[0]);
  for (std::size_t a = 0; a < many.size(); ++a)
    many[a].position_m = ellipsoid_point(0.2 + 0.15 * static_cast<double>(a), 0.7 * static_cast<double>(a));
  model().anchor = many;
  reset(state_);
  slot_.clear();
  for (std::int32_t i = 0; i < kMaxRegions; ++i) {
    slot_.push_back(i);
    state_.region[i] = make_region(static_cast<std::uint32_t>(i + 1), static_cast<std::uint32_t>(i),
                                   ellipsoid_point(0.3 + 0.15 * i, 1.1 * i), {0, 0, 1}, 1 + i);
  }
  Skeleton s;
  ASSERT_TRUE(solve_mutual_skeleton(model(), state_, slot_, 3, {0, 0, 1}, s));
  EXPECT_EQ(s.count, kMaxAnchors);
  std::vector<Real> sum(slot_.size());
  EXPECT_TRUE(add_mutual_forces(model(), state_, slot_.data(), kMaxRegions, sum.data()));
  for (const Real one : sum) EXPECT_GT(one, 0);
  many.push_back(many[0]);
  model().anchor = many;
  EXPECT_FALSE(add_mutual_forces(model(), state_, slot_.data(), kMaxRegions, sum.data()));
}

// Two contacts in one place: the printed ratios have no beam between them, and say so.
TEST_F(Mutual, TwoContactsInOnePlaceAreDegenerate) {
  model().params.skeleton_law = SkeletonLaw::kPaper;
  const std::vector<Real> sum = added({top_, top_});
  EXPECT_FALSE(all_carried_);
  EXPECT_EQ(sum[0], 0);
  EXPECT_EQ(sum[1], 0);
}

// What is drawn stands on the same beams: the anchors get what the beam between the contacts leaves them.
TEST_F(Mutual, DrawnAnchorsLoseWhatTheOtherContactsCarry) {
  const auto pull_on_anchors = [&] {
    Vec3 sum;
    const AnchorField field = anchors_of(model(), state_);
    for (std::int32_t a = 0; a < field.count; ++a) sum += field.anchor[a].force_w;
    return sum;
  };
  place({top_, side_});
  Vec3 between =
      skeleton_of(0).force_w[mutual_beam(model(), 0, 1)] + skeleton_of(1).force_w[mutual_beam(model(), 1, 0)];
  const Vec3 both = -(top_.normal_force_N * top_.normal_w + side_.normal_force_N * side_.normal_w);
  EXPECT_LT(norm(pull_on_anchors() - (both + between)), 1e-12);
  model().params.coupling_law = CouplingLaw::kNone;
  EXPECT_LT(norm(pull_on_anchors() - both), 1e-12);
}

}  // namespace
}  // namespace palpate
