// The frictionless contact problem: worked numbers, optimality on random problems, degenerate ones.
#include <gtest/gtest.h>
#include <limits>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "rt_core/contact/nodes/pivoting.h"

namespace palpate::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Matrix = std::vector<std::vector<double>>;

std::unique_ptr<NormalProblem> problem_of(const Matrix& m, const std::vector<double>& q,
                                          const std::vector<double>& guess = {}) {
  auto p = std::make_unique<NormalProblem>();
  std::memset(static_cast<void*>(p.get()), 0xAB, sizeof *p);
  p->n = static_cast<std::int32_t>(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) p->compliance[i][j] = m[i][j];
    p->free_gap_m[i] = q[i];
    p->push_N[i] = guess.empty() ? 0 : guess[i];
  }
  return p;
}

void expect_solution(const NormalProblem& p, const std::vector<double>& push, double tolerance) {
  for (std::size_t i = 0; i < push.size(); ++i) EXPECT_NEAR(p.push_N[i], push[i], tolerance) << i;
}

const Matrix kThree{{4, 1, .5}, {1, 3, 1}, {.5, 1, 2}};

TEST(Pivoting, WorkedNumbers) {
  auto p = problem_of(kThree, {-1, -.5, .2});
  solve_pivoting(*p);
  expect_solution(*p, {.22727273, .09090909, 0}, 1e-8);
  EXPECT_NEAR(p->gap_m[2], .40454545, 1e-8);
  // A contact that penetrates without the others ends open.
  p = problem_of({{4, 2}, {2, 3}}, {-2, -.5});
  solve_pivoting(*p);
  expect_solution(*p, {.5, 0}, 1e-12);
  // Virtual coupling in series: C = 0.2, 1/K = 0.5.
  p = problem_of({{.7}}, {-1});
  solve_pivoting(*p);
  expect_solution(*p, {1.428571}, 1e-6);
}

TEST(Pivoting, SweepsOfGaussSeidel) {
  auto p = problem_of(kThree, {-1, -.5, .2});
  solve_sweeping(*p, 1);
  expect_solution(*p, {.25, .0833333, 0}, 1e-7);
  p = problem_of(kThree, {-1, -.5, .2});
  solve_sweeping(*p, 2);
  expect_solution(*p, {.22916667, .09027778, 0}, 1e-8);
}

TEST(Pivoting, RedundantContactsShareWithRegularisation) {
  Matrix m{{4, 4, 1}, {4, 4, 1}, {1, 1, 3}};
  auto p = problem_of(m, {-1, -1, -.5});
  solve_pivoting(*p);  // singular: the sweeps take over, and find the same total
  EXPECT_NEAR(p->push_N[0] + p->push_N[1], .22727273, 1e-6);
  for (std::size_t i = 0; i < 3; ++i) m[i][i] *= 1 + 1e-6;
  p = problem_of(m, {-1, -1, -.5});
  solve_pivoting(*p);
  expect_solution(*p, {.11363631, .11363631, .09090903}, 1e-8);
}

// A punch on a half space, Boussinesq's kernel: what the Delassus matrix of a real body looks like.
Matrix punch(int n, double spacing, double width) {
  Matrix m(static_cast<std::size_t>(n), std::vector<double>(static_cast<std::size_t>(n)));
  const int row = static_cast<int>(std::lround(std::sqrt(n)));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double dx = spacing * (i % row - j % row), dy = spacing * (i / row - j / row);
      m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = 1 / std::sqrt(dx * dx + dy * dy + width * width);
    }
  return m;
}

double residual(const Matrix& m, const std::vector<double>& q, const NormalProblem& p) {
  double worst = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    double gap = q[i];
    for (std::size_t j = 0; j < q.size(); ++j) gap += m[i][j] * p.push_N[j];
    worst = std::max(worst, std::abs(std::min(gap, m[i][i] * p.push_N[i])));
  }
  return worst;
}

TEST(Pivoting, ExactOnRandomProblemsColdAndWarm) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  int most_cold = 0, most_warm = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 4 + trial % 61;
    const Matrix m = punch(n, 1, 0.4);
    std::vector<double> q(static_cast<std::size_t>(n));
    for (double& x : q) x = any(random) - 0.3;
    auto p = problem_of(m, q);
    solve_pivoting(*p);
    most_cold = std::max(most_cold, p->pivots);
    EXPECT_LT(residual(m, q, *p), 1e-12) << n;
    for (std::int32_t i = 0; i < p->n; ++i) EXPECT_GE(p->push_N[i], 0);
    // Next tick: nearly the same gaps.
    const std::vector<double> guess(p->push_N, p->push_N + n);
    for (double& x : q) x += 0.01 * any(random);
    p = problem_of(m, q, guess);
    solve_pivoting(*p);
    most_warm = std::max(most_warm, p->pivots);
    EXPECT_LT(residual(m, q, *p), 1e-12) << n;
  }
  std::printf("factorisations: cold at most %d, warm at most %d\n", most_cold, most_warm);
  EXPECT_LE(most_cold, 7);
  EXPECT_LE(most_warm, 3);  // three steps warm
}

// Sixty-four coplanar contacts under a flat punch, nearly redundant: no divergence, no pull.
TEST(Pivoting, FlatPunchOfRedundantContacts) {
  for (const double width : {0.4, 1.0, 3.0, 10.0}) {  // from well conditioned to nearly singular
    Matrix m = punch(64, 0.25, width);
    for (std::size_t i = 0; i < 64; ++i) m[i][i] *= 1 + 1e-6;
    const std::vector<double> q(64, -0.5);
    auto p = problem_of(m, q);
    solve_pivoting(*p);
    EXPECT_LE(p->pivots, kMaxPivots);
    double total = 0;
    for (std::int32_t i = 0; i < 64; ++i) {
      EXPECT_GE(p->push_N[i], 0);
      total += p->push_N[i];
    }
    EXPECT_TRUE(std::isfinite(total));
    // The widest kernels are as good as singular and may end in the sweeps: a penetration of 2 % of the depth.
    EXPECT_LT(residual(m, q, *p), width < 0.5 ? 1e-12 : width < 2 ? 1e-8 : 1e-2) << width;
  }
}

TEST(Pivoting, ErrorOfGaussSeidelPerSweep) {
  const Matrix m = punch(49, 1, 0.5);
  std::vector<double> q(49);
  for (std::size_t i = 0; i < 49; ++i) {
    const double x = static_cast<double>(i % 7) - 3, y = static_cast<double>(i / 7) - 3;
    q[i] = -1 + 0.08 * (x * x + y * y);  // a sphere
  }
  auto exact = problem_of(m, q);
  solve_pivoting(*exact);
  double total = 0, before = 1;
  for (int i = 0; i < 49; ++i) total += exact->push_N[i];
  for (const int sweeps : {5, 10, 20, 50}) {
    auto p = problem_of(m, q);
    solve_sweeping(*p, sweeps);
    double sum = 0;
    for (int i = 0; i < 49; ++i) sum += p->push_N[i];
    const double error = std::abs(sum - total) / total;
    std::printf("Gauss-Seidel, %2d sweeps cold: total force %.1e off\n", sweeps, error);
    EXPECT_LT(error, before);
    before = error;
  }
  EXPECT_LT(before, 1e-5);
}

TEST(Pivoting, NotANumberPushesNothing) {
  auto p = problem_of(kThree, {kNan, -.5, .2});
  solve_pivoting(*p);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(p->push_N[i] < 0);
  EXPECT_LE(p->pivots, kMaxPivots);
}

TEST(Factor, SolvesWhatItFactorised) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  for (std::int32_t n = 1; n <= kMaxContacts; n += 7) {
    const auto un = static_cast<std::size_t>(n);
    Matrix half(un, std::vector<double>(un)), m(un, std::vector<double>(un));
    for (auto& row : half)
      for (double& x : row) x = any(random);
    for (std::size_t i = 0; i < un; ++i)
      for (std::size_t j = 0; j < un; ++j) {
        m[i][j] = i == j ? 0.5 : 0;
        for (std::size_t k = 0; k < un; ++k) m[i][j] += half[i][k] * half[j][k];
      }
    auto factor = std::make_unique<ContactFactor>();
    factor->n = n;
    for (std::size_t j = 0; j < un; ++j)
      for (std::size_t i = j; i < un; ++i) factor->column[j][i] = m[i][j];
    ASSERT_TRUE(factorise(*factor));
    alignas(32) double x[kContactStride] = {};
    std::vector<double> b(un);
    for (std::size_t i = 0; i < un; ++i) x[i] = b[i] = any(random);
    solve_lower(*factor, x);
    solve_upper(*factor, x);
    for (std::size_t i = 0; i < un; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < un; ++j) sum += m[i][j] * x[j];
      EXPECT_NEAR(sum, b[i], 1e-11) << n;
    }
  }
}

}  // namespace
}  // namespace palpate::test
