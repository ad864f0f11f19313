// Balance within friction cones and force closure against cases that are known, and against certificates.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "config/hand/cone_combination.h"
#include "sim_host/press/grasp_stability.h"

namespace palpate {
namespace {

// Two fingers squeeze a body of 2 N along x, friction `friction_N` each.
Grasp pinch(double friction_N) {
  Grasp grasp;
  grasp.weight_N = {0, -2, 0};
  grasp.length_m = 0.05;
  grasp.finger = {{{0.02, 0, 0}, {-1, 0, 0}, 3, friction_N}, {{-0.02, 0, 0}, {1, 0, 0}, 3, friction_N}};
  return grasp;
}

// Each finger bears half the weight: friction of 1 N is needed, and up to 1/cos(22.5 degrees) of it by cones of eight
// edges.
TEST(GraspStability, APinchHoldsWhatItsFrictionBears) {
  const GraspStability firm = judge(pinch(2)), weak = judge(pinch(0.9));
  EXPECT_TRUE(firm.holds);
  EXPECT_GT(firm.friction_needed, 0.5 - 1e-3);
  EXPECT_LT(firm.friction_needed, 0.5 / std::cos(kPi / 8) + 1e-3);
  EXPECT_FALSE(weak.holds);
  EXPECT_NEAR(weak.imbalance_N, 0.2 / std::sqrt(2.0), 0.15);  // 2 N less 2 x 0.9, spread over rows of slack
  EXPECT_FALSE(firm.closed);                                  // turns about the line between the fingers
  EXPECT_EQ(judge(Grasp{}).holds, false);
}

TEST(GraspStability, APalmThatOnlyPushesCannotPull) {
  Grasp grasp;
  grasp.weight_N = {0, -2, 0};
  grasp.length_m = 0.05;
  grasp.finger = {{{0, 0.02, 0}, {0, 1, 0}, 5, 0.1}};  // a finger that lifts by more than the weight
  EXPECT_FALSE(judge(grasp).holds);
  grasp.palm = {{{0, 0.01, 0}, {0, 1, 0}, 1, 0.5}};
  EXPECT_FALSE(judge(grasp).holds);  // pushes the same way
  EXPECT_EQ(judge(grasp).friction_needed, kHuge);
  grasp.palm = {{{0, 0.01, 0}, {0, -1, 0}, 1, 0.5}};
  EXPECT_TRUE(judge(grasp).holds);
}

// Four fingers round a ball with friction resist every wrench; without friction none about its centre.
TEST(GraspStability, ForceClosureNeedsFrictionOnABall) {
  for (const double friction_N : {0.0, 0.5}) {
    Grasp grasp;
    grasp.length_m = 0.03;
    for (const Vec3 at : {Vec3{1, 1, 1}, Vec3{1, -1, -1}, Vec3{-1, 1, -1}, Vec3{-1, -1, 1}}) {
      const Vec3 out = unit_or(at, {});
      grasp.finger.push_back({0.03 * out, -out, 1, friction_N});
    }
    const GraspStability s = judge(grasp);
    EXPECT_EQ(s.closed, friction_N > 0);
    if (s.closed) {
      EXPECT_GT(s.quality_least, 0.01);
      EXPECT_LE(s.quality_least, s.quality_most);
    }
  }
}

// Non-negative least squares against its own conditions, which are necessary and sufficient: weights >= 0, no column
// would come nearer, and those that take part are balanced.
TEST(ConeCombination, MeetsTheConditionsOfItsOptimum) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  int inside = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Index n = 2 + trial % 40;
    Eigen::MatrixXd columns(6, n);
    Eigen::VectorXd target(6);
    for (Eigen::Index i = 0; i < 6; ++i) {
      target[i] = normal(random);
      for (Eigen::Index j = 0; j < n; ++j) columns(i, j) = normal(random) + (i == 0 ? 1 : 0);
    }
    const ConeCombination c = cone_combination(columns, target);
    const Eigen::VectorXd slope = columns.transpose() * c.residual;
    EXPECT_GE(c.weight.minCoeff(), 0);
    EXPECT_LE(slope.maxCoeff(), 1e-9);
    EXPECT_NEAR(slope.dot(c.weight), 0, 1e-9);
    EXPECT_LT((columns * c.weight + c.residual - target).norm(), 1e-12);
    inside += c.residual.norm() < 1e-9 ? 1 : 0;
  }
  EXPECT_GT(inside, 50);
  EXPECT_LT(inside, 290);
}

}  // namespace
}  // namespace palpate
