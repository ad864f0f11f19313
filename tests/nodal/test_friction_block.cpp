// Coulomb friction of one contact: worked numbers and the law itself on random compliances.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rt_core/contact/nodes/friction_block.h"

namespace palpate::test {
namespace {

struct Answer {
  double r[3];  // push in the given frame
  double u[3];  // displacement with it
  bool slips;
};

Answer answer(const double (&w)[3][3], double mu, const double (&q)[3]) {
  const FrictionBlock block = make_friction_block(w, mu);
  const double c = block.cosine, s = block.sine;
  const double turned[3] = {q[0], c * q[1] + s * q[2], c * q[2] - s * q[1]};
  const Push push = solve_friction(block, mu, turned);
  Answer a{
      {push.normal_N, c * push.tangent_N[0] - s * push.tangent_N[1], s * push.tangent_N[0] + c * push.tangent_N[1]},
      {},
      push.slips};
  for (int i = 0; i < 3; ++i) {
    a.u[i] = q[i];
    for (int j = 0; j < 3; ++j) a.u[i] += w[i][j] * a.r[j];
  }
  double own[3];
  own_displacement(block, push, own);
  EXPECT_NEAR(own[0], a.u[0] - q[0], 1e-9);
  EXPECT_NEAR(c * own[1] - s * own[2], a.u[1] - q[1], 1e-9);
  EXPECT_NEAR(s * own[1] + c * own[2], a.u[2] - q[2], 1e-9);
  return a;
}

constexpr double kW[3][3] = {{2, .3, -.1}, {.3, 1.5, .05}, {-.1, .05, 1.4}};

void expect_push(const Answer& a, double n, double t0, double t1) {
  EXPECT_NEAR(a.r[0], n, 1e-8);
  EXPECT_NEAR(a.r[1], t0, 1e-8);
  EXPECT_NEAR(a.r[2], t1, 1e-8);
}

TEST(FrictionBlock, WorkedNumbers) {
  Answer a = answer(kW, .5, {-1, .1, .05});
  EXPECT_FALSE(a.slips);
  expect_push(a, .52622809, -.17217971, .00802271);
  a = answer(kW, .5, {-1, .8, -.4});
  EXPECT_TRUE(a.slips);
  expect_push(a, .5424856, -.24320211, .12010576);
  EXPECT_NEAR(a.u[1], .60394781, 1e-7);
  EXPECT_NEAR(a.u[2], -.29826061, 1e-7);
  a = answer(kW, .5, {-1, .3, 0});
  expect_push(a, .54226207, -.26795551, .04137491);
  a = answer(kW, .5, {.2, 1, 0});
  expect_push(a, 0, 0, 0);
}

TEST(FrictionBlock, HoldsCoulombsLawOnRandomCompliances) {
  std::mt19937 random(11);
  std::normal_distribution<double> any;
  int stuck = 0, slipped = 0, open = 0, precise = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    double half[3][3], w[3][3];
    for (auto& row : half)
      for (double& x : row) x = any(random);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        w[i][j] = i == j ? 0.5 : 0;
        for (int k = 0; k < 3; ++k) w[i][j] += half[i][k] * half[j][k];
      }
    const double mu = 0.1 + 0.1 * (trial % 8);
    if (mu * std::hypot(w[0][1], w[0][2]) >= 0.9 * w[0][0]) continue;  // not unique: the coupling is left out
    const double q[3] = {any(random) - 0.5, any(random), any(random)};
    const Answer a = answer(w, mu, q);
    const double friction = std::hypot(a.r[1], a.r[2]), slip = std::hypot(a.u[1], a.u[2]);
    EXPECT_GE(a.r[0], 0);
    EXPECT_LE(friction, mu * a.r[0] * (1 + 1e-9));
    if (a.r[0] == 0) {
      ++open;
      EXPECT_GE(a.u[0], 0);
      continue;
    }
    EXPECT_NEAR(a.u[0], 0, 1e-8);
    if (!a.slips) {
      ++stuck;
      EXPECT_NEAR(slip, 0, 1e-9);
      continue;
    }
    ++slipped;
    EXPECT_NEAR(friction, mu * a.r[0], 1e-9);
    const double along = a.r[1] * a.u[1] + a.r[2] * a.u[2];
    EXPECT_NEAR(along, -friction * slip, 1e-3 * friction * slip + 1e-9);  // opposed, to within 3 degrees in 8 steps
    precise += std::abs(along + friction * slip) < 1e-9 ? 1 : 0;
  }
  EXPECT_GT(stuck, 100);
  EXPECT_GT(slipped, 500);
  EXPECT_GT(open, 500);
  EXPECT_GT(precise, 0.95 * slipped);
}

TEST(FrictionBlock, NoFrictionIsTheNormalProblem) {
  const Answer a = answer(kW, 0, {-1, .8, -.4});
  expect_push(a, .5, 0, 0);
}

TEST(FrictionBlock, NonUniqueCouplingIsLeftOut) {
  const double w[3][3] = {{1, 3, 0}, {3, 20, 0}, {0, 0, 1}};
  const Push push = solve_friction(make_friction_block(w, 0.5), 0.5, {-1, 2, 0});
  EXPECT_TRUE(std::isfinite(push.normal_N));
  EXPECT_NEAR(push.normal_N, 1, 1e-12);
}

// Duriez et al. (2003) write the push by its x component: F_y = (b/a) F_x, F_z = (c/a) F_x with the constraint F_x >=
// 0. It divides by zero for a normal across the x axis and pulls the body into the tool for one with a < 0.
TEST(FrictionBlock, ThePapersNormalisationFails) {
  const auto paper_force = [](const double(&n)[3], double fx, double(&f)[3]) {
    for (int k = 0; k < 3; ++k) f[k] = n[k] / n[0] * fx;
  };
  double force[3];
  paper_force({0, 0, 1}, 1, force);
  EXPECT_FALSE(std::isfinite(force[2]));
  paper_force({-.6, 0, .8}, 1, force);
  EXPECT_LT(force[0] * -.6 + force[2] * .8, 0);  // against the normal: it pulls
  // Along unit normals the same contacts are plain.
  const double w[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_DOUBLE_EQ(solve_friction(make_friction_block(w, 0), 0, {-1, 0, 0}).normal_N, 1);
}

}  // namespace
}  // namespace palpate::test
