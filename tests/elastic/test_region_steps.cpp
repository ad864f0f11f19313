// Steps of the region solver that know how laws bend: two lines in one body against bisection, and how soon they end.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>

#include "rt_core/contact/elastic/elastic_load.h"
#include "rt_core/contact/region_solve.h"

namespace palpate {
namespace {

constexpr double kRadius_m = 0.01, kModulus_Pa = 2e9, kMostDeep_m = 2e-5;
// What a clip's arm gives under a tube that slips on it, and under the other arm's newton.
constexpr double kOwn_m_per_N = 1.4e-4, kOther_m_per_N = -4e-5;

// Two tubes' sides, of which the second leans, and with `apart` a third that is a millimetre off.
struct Sides {
  ElasticLoad load;
  std::array<ElasticRow, 3> row{};
  std::array<Real, kMaxRegions> before{}, bend{}, change{};
  RegionSystem system{};

  Sides(double depth_m, double other_m, double before_N, bool apart) {
    load.n = apart ? 3 : 2;
    load.region = load.tip_of;
    load.before_N = before.data();
    load.own_bend_m_per_N = bend.data();
    load.change_N = change.data();
    load.pair = {};
    load.pair.c_m_per_N[0][1] = load.pair.c_m_per_N[1][0] = kOther_m_per_N;
    const std::array<double, 3> depth = {depth_m, other_m, -1e-3};
    for (std::int32_t r = 0; r < load.n; ++r) {
      const auto i = static_cast<std::size_t>(r);
      load.law[r] = PlacedLaw{};
      load.law[r].is_line = true;
      load.law[r].line =
          LineLaw({kRadius_m, 0.03, 0.03, 1, 1, r == 1 ? 1e-5 : 0.0, 0, 0, true}, kModulus_Pa, kMostDeep_m);
      row[i].told = load.law[r].line.at(kTold * kMostDeep_m + load.law[r].line.touches_at_m());
      load.placed[r] = &row[i];
      load.tip[r] = Tip{};
      load.tip[r].place = &load.law[r].terms;
      load.tip[r].become(load.law[r].line);
      load.tip[r].depth_m = depth[i];
      load.own[r].far = {kOwn_m_per_N, 0, kHuge};
      load.tip_of[r] = {&load.tip[r], 1, load.own[r].far};
      before[i] = r < 2 ? before_N : 0.0;
    }
  }
  // Second order of what the first two give to each other.
  void couple(double h_m_per_N2) {
    for (const int i : {0, 1}) load.pair.h_m_per_N2[i][1 - i] = load.pair.h_across_m_per_N2[1 - i][i] = h_m_per_N2;
  }
  RegionSolution solve() { return solve_regions(load, load.n, system); }
  double law_N(std::int32_t r, double e_m) const { return load.law[r].line.at(e_m).force_N; }

  // The force of one under the other's: e + c F + c' F' = depth.
  double under_N(std::int32_t r, double other_N) const {
    double low = load.law[r].line.touches_at_m(), high = load.tip[r].depth_m - kOther_m_per_N * other_N;
    if (!(high > low)) return 0;
    const double room = high;
    for (int i = 0; i < 200; ++i) {
      const double e = 0.5 * (low + high);
      (e + kOwn_m_per_N * law_N(r, e) > room ? high : low) = e;
    }
    return law_N(r, low);
  }
  // Each pushes the other out: the more one has, the more has the other, by a seventh.
  std::array<double, 2> by_bisection() const {
    double low = 0, high = 100;
    for (int i = 0; i < 200; ++i) {
      const double f = 0.5 * (low + high);
      (under_N(0, under_N(1, f)) > f ? low : high) = f;
    }
    return {low, under_N(1, low)};
  }
};

// From a touch that begins, and from forces far from the answer: 3 to 6 looks at the laws; Newton's own steps, halved
// where they went too far, took 6 to 29 (2026-11-26).
TEST(RegionSteps, FindTheForcesInAFewSteps) {
  for (const double depth : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    for (const double part : {0.0, 0.01, 0.5, 1.0, 3.0}) {
      Sides sides(depth, 0.8 * depth, 0, false);
      const std::array<double, 2> asked = sides.by_bisection();
      Sides begun(depth, 0.8 * depth, part * asked[0], false);
      const RegionSolution found = begun.solve();
      EXPECT_LE(found.residual_m, kTravelTolerance_m) << depth << " " << part;
      EXPECT_LE(found.evaluations, 6) << depth << " " << part;
      // A step of 1e-5 of the dent by tangents errs by the square of that; a solve ends at a picometre.
      for (std::size_t r = 0; r < 2; ++r)
        EXPECT_NEAR(begun.system.force_N[r], asked[r], 1e-7 * asked[r] + 1e-12 / kOwn_m_per_N) << depth << " " << part;
    }
  }
}

// Two regions are written out, three are taken by lanes.
TEST(RegionSteps, AThirdThatIsApartChangesNothing) {
  for (const double depth : {1e-6, 1e-4}) {
    Sides two(depth, 0.7 * depth, 0.1, false), three(depth, 0.7 * depth, 0.1, true);
    two.solve();
    three.solve();
    EXPECT_EQ(three.system.force_N[2], 0);
    for (int r = 0; r < 2; ++r)
      EXPECT_NEAR(two.system.force_N[r], three.system.force_N[r], 1e-9 * two.system.force_N[r]) << depth << " " << r;
  }
}

// Three in touch of whose pairs the second order asks for more than all of them resist: I + g H g has no factor.
struct Runaway : Sides {
  Runaway() : Sides(1e-4, 8e-5, 0, true) {
    load.tip[2].depth_m = 9e-5;
    load.evaluate(system.shift_m, system);
    const double resists_m_per_N = 1 / (system.root_tangent[0] * system.root_tangent[1]) + kOwn_m_per_N;
    couple(-2 * resists_m_per_N / system.force_N[0]);
  }
};

// The step is then Newton's with what the pairs give at first order, and is bent as the laws are.
TEST(RegionSteps, WithoutAFactorTheStepLeavesOutTheSecondOrder) {
  Runaway bodies;
  ElasticLoad& load = bodies.load;
  RegionSystem& s = bodies.system;
  load.evaluate(s.shift_m, s);
  FactorLanes lanes;
  ASSERT_FALSE(load.factor(s, 1, lanes));
  ASSERT_TRUE(load.newton_step(s));
  Eigen::Matrix3d gives = Eigen::Matrix3d::Zero();
  Eigen::Vector3d root, rest;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) gives(i, j) = load.pair.c_m_per_N[i][j];
    gives(i, i) = kOwn_m_per_N;
    root[i] = s.root_tangent[i];
    rest[i] = s.residual_m[i];
  }
  const Eigen::Matrix3d system = Eigen::Matrix3d::Identity() + root.asDiagonal() * gives * root.asDiagonal();
  const Eigen::Vector3d more_N = root.asDiagonal() * system.ldlt().solve(-root.cwiseProduct(rest));
  RegionSystem asked = s;
  for (int r = 0; r < 3; ++r) {
    EXPECT_NEAR(load.change_N[r], more_N[r], 1e-12 * more_N.norm()) << r;
    asked.step_m[r] = rest[r] + gives.row(r).dot(more_N);
    EXPECT_NEAR(s.step_m[r], load.bent_step_m(r, asked), 1e-12 * rest.norm()) << r;
  }
}

// Two whose energy has no least: the more they push, the more they give. The second order is dropped, and the forces
// are those of the pairs' first.
TEST(RegionSteps, AnEnergyWithoutALeastIsSolvedWithoutItsSecondOrder) {
  Sides bodies(1e-3, 8e-4, 0, false);
  const std::array<double, 2> asked = bodies.by_bisection();
  bodies.couple(-kOwn_m_per_N / asked[0]);
  RegionSolution given_up;
  const RegionSolution found = bodies.load.solve(bodies.system, ElasticLoad::kEnough_m, false, given_up);
  EXPECT_GT(given_up.residual_m, ElasticLoad::kNoAnswer_m);
  EXPECT_LE(found.residual_m, kTravelTolerance_m);
  EXPECT_EQ(bodies.load.pair.h_m_per_N2[0][1], 0);
  for (std::size_t r = 0; r < 2; ++r) EXPECT_NEAR(bodies.system.force_N[r], asked[r], 1e-7 * asked[r]) << r;

  Sides sane(1e-3, 8e-4, 0, false);
  RegionSolution none;
  EXPECT_LE(sane.load.solve(sane.system, ElasticLoad::kEnough_m, false, none).residual_m, kTravelTolerance_m);
  EXPECT_EQ(none.evaluations, 0);
}

// Laws that no step brings nearer: their solve ends after so many looks at them, whatever steps and halvings are left.
struct Stubborn {
  static constexpr std::int32_t kIterations = ElasticLoad::kIterations;
  static constexpr Real kEnough_m = 1e-14, kTolerance_m = 1e-9;
  std::int32_t evaluations_left = kTipEvaluations;
  mutable std::int32_t looks = 0;
  mutable Real shift_m = 0;
  Real start(std::int32_t) const PALPATE_RT { return 0; }
  LawPoint load(std::int32_t, Real shift) const PALPATE_RT {
    looks += 1;
    shift_m = shift;
    return {1, 0};
  }
  Real shift_under(const Real*, std::int32_t) const PALPATE_RT { return shift_m + 1; }
  Real curvature(const Real*, std::int32_t, std::int32_t) const PALPATE_RT { return 0; }
};

TEST(RegionSteps, ASolveThatNoStepBringsNearerEnds) {
  const Stubborn laws;
  RegionSystem system;
  const RegionSolution result = solve_regions(laws, 1, system);
  EXPECT_EQ(laws.looks, kTipEvaluations);
  EXPECT_EQ(result.evaluations, kTipEvaluations);
  EXPECT_GT(result.residual_m, Stubborn::kTolerance_m);
}

}  // namespace
}  // namespace palpate
