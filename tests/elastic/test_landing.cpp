// A tool that comes to several parts of a body at once: its motion is the least of an energy under conditions that only
// push, beside which every choice of them is tried here.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "rt_core/cholesky.h"
#include "rt_core/tool/landing.h"
#include "rt_core/tool/virtual_coupling.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Balls about a tool's origin, each near a part of its own.
struct Parts {
  std::vector<ToolPoint> point;
  std::vector<ToolPiece> piece = std::vector<ToolPiece>(1);
  Model model;
  StatePtr state = roomy_state();
  Eigen::MatrixXd way;  // row i: how far a motion goes from part i
  Eigen::VectorXd gap_m;

  Parts(int count, std::mt19937_64& random) : point(static_cast<std::size_t>(count)), way(count, 6), gap_m(count) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> even(0, 1);
    model.params = tiny_params();
    piece[0].margin_m = 1e9 / model.params.youngs_modulus_Pa;  // what holds the tool gives 3e-9 m/N
    for (int i = 0; i < count; ++i) {
      point[static_cast<std::size_t>(i)].begins_at = 1 + i;
      PointState& at = state->point[i];
      at.triangle = 1 + i;
      at.normal_w = unit_or({normal(random), normal(random), normal(random)}, {1, 0, 0});
      at.closest_w = 0.01 * Vec3{normal(random), normal(random), normal(random)};
      gap_m[i] = at.gap_m = even(random) < 0.3 ? 0 : 1e-4 * even(random);
      const Vec3 n = at.normal_w, turn = cross(at.closest_w, n);
      way.row(i) << n.x, n.y, n.z, turn.x, turn.y, turn.z;
    }
    model.tool_point = point;
    model.piece = piece;
  }
};

Vector6 vector_of(const Twist& t) {
  Vector6 v;
  v << t.translation_m.x, t.translation_m.y, t.translation_m.z, t.rotation_rad.x, t.rotation_rad.y, t.rotation_rad.z;
  return v;
}

// The motion when just those are held which are chosen, as equations; feasible and pushing, it is the answer.
bool is_answer(const Parts& parts, const Matrix6d& stiffness, const Vector6& wanted, unsigned chosen, Vector6& motion) {
  std::vector<int> held;
  for (int i = 0; i < parts.way.rows(); ++i)
    if ((chosen >> i & 1u) != 0) held.push_back(i);
  const Eigen::MatrixXd rows = parts.way(held, Eigen::all);
  const Eigen::MatrixXd give = rows * stiffness.llt().solve(rows.transpose());
  const Eigen::VectorXd over = -rows * wanted - parts.gap_m(held);
  const Eigen::VectorXd force = held.empty() ? Eigen::VectorXd(0) : Eigen::VectorXd(give.fullPivLu().solve(over));
  motion = wanted + stiffness.llt().solve(rows.transpose() * force);
  return (held.empty() || force.minCoeff() > -1e-9) && (parts.way * motion + parts.gap_m).minCoeff() > -1e-12;
}

TEST(Landing, IsTheLeastMotionThatEndsOnThePartsAndIsPulledByNone) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  int landed = 0, several = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Parts parts(1 + trial % 5, random);
    const Matrix6d any = Matrix6d::NullaryExpr([&](Eigen::Index, Eigen::Index) { return normal(random); });
    Vector6 scale;
    scale << 1, 1, 1, 0.01, 0.01, 0.01;  // m against rad
    const Matrix6d stiffness =
        scale.asDiagonal() * (1e4 * any * any.transpose() + 500 * Matrix6d::Identity()) * scale.asDiagonal();
    const Vector6 wrench = scale.asDiagonal() * Vector6::NullaryExpr([&](Eigen::Index) { return normal(random); });
    const Vector6 wanted = stiffness.llt().solve(wrench);
    double factor[36];
    for (int i = 0; i < 36; ++i) factor[i] = stiffness(i / 6, i % 6);
    ASSERT_TRUE(cholesky_factor(factor, 6));
    Twist motion{{wanted[0], wanted[1], wanted[2]}, {wanted[3], wanted[4], wanted[5]}};
    ContactStiffness held;
    const std::int32_t taken = land(parts.model, *parts.state, {}, factor, motion, &held);
    const double trace_N_per_m = held.force[0] + held.force[3] + held.force[5];
    EXPECT_GE(trace_N_per_m, 0);
    EXPECT_TRUE(taken > 0 || trace_N_per_m == 0);
    bool found = false;
    for (unsigned chosen = 0; chosen < 1u << parts.way.rows() && !found; ++chosen) {
      Vector6 exact;
      if (!is_answer(parts, stiffness, wanted, chosen, exact)) continue;
      found = true;
      landed += chosen != 0 ? 1 : 0;
      several += (chosen & (chosen - 1)) != 0 ? 1 : 0;
      // What holds the tool gives by 3e-9 m/N, the body under it by 1e-4 and more.
      EXPECT_LT((parts.way * (vector_of(motion) - exact)).cwiseAbs().maxCoeff(),
                1e-3 * (parts.way * (exact - wanted)).cwiseAbs().maxCoeff() + 1e-9)
          << trial;
    }
    EXPECT_TRUE(found) << trial;
  }
  EXPECT_GT(landed, 100);
  EXPECT_GT(several, 50);
}

}  // namespace
}  // namespace palpate::test
