// Front-wise L D L' against the matrices it factors.
#include <gtest/gtest.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include "config/fem/fill_order.h"
#include "config/fem/supernodal_factor.h"

namespace palpate::fem {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Lower triangle of a grid's 27-point coupling with `unknowns` per node; `sign` of the last unknown's diagonal.
Sparse grid(int side, int unknowns, double sign, std::mt19937& random) {
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<Eigen::Triplet<double>> entries;
  const auto node = [&](int x, int y, int z) { return (z * side + y) * side + x; };
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        for (int dz = -1; dz <= 1; ++dz)
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
              const int a = x + dx, b = y + dy, c = z + dz;
              if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= side) continue;
              for (int i = 0; i < unknowns; ++i)
                for (int j = 0; j < unknowns; ++j) {
                  const int row = node(x, y, z) * unknowns + i, column = node(a, b, c) * unknowns + j;
                  if (row < column) continue;
                  const double dominant = 40.0 * unknowns * (i + 1 == unknowns ? sign : 1);
                  entries.emplace_back(row, column, row == column ? dominant : value(random));
                }
            }
  Sparse lower(side * side * side * unknowns, side * side * side * unknowns);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

double residual(const Sparse& lower, double shift, const Eigen::VectorXd& x, const Eigen::VectorXd& b) {
  return (lower.selfadjointView<Eigen::Lower>() * x + shift * x - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

TEST(SupernodalFactor, SolvesDefiniteAndIndefiniteGridsWithAndWithoutAShift) {
  std::mt19937 random(7);
  for (const double sign : {1.0, -1.0})
    for (const auto& [side, unknowns] : {std::pair{1, 1}, {2, 1}, {7, 1}, {6, 3}}) {
      const Sparse lower = grid(side, unknowns, sign, random);
      SupernodalFactor factor;
      factor.analyse(lower);
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(lower.cols(), -1, 2);
      for (const double shift : {0.0, 3.0}) {
        ASSERT_TRUE(factor.factorise(lower, shift));
        EXPECT_LT(residual(lower, shift, factor.solve(b), b), 1e-12) << side << " " << unknowns << " " << shift;
      }
    }
}

// One front each, so that every share of a panel and of a block of rows and columns is met.
TEST(SupernodalFactor, SolvesFullMatricesOfEverySize) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int size = 1; size <= 110; ++size) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < size; ++row)
      for (int column = 0; column <= row; ++column)
        entries.emplace_back(row, column, row != column ? value(random) : row % 3 == 1 ? -size : size);
    Sparse lower(size, size);
    lower.setFromTriplets(entries.begin(), entries.end());
    SupernodalFactor factor;
    factor.analyse(lower);
    ASSERT_TRUE(factor.factorise(lower, 0));
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(size, -1, 2);
    EXPECT_LT(residual(lower, 0, factor.solve(b), b), 1e-12) << size;
    EXPECT_EQ(factor.negative_pivots(), (size + 1) / 3) << size;
  }
}

// Whether columns go through the factor alone, in fours or in eights is not to be seen in a bit.
TEST(SupernodalFactor, SolvesColumnsTogetherAsAlone) {
  std::mt19937 random(3);
  const Sparse lower = grid(5, 3, 1, random);
  SupernodalFactor factor;
  factor.analyse(lower);
  ASSERT_TRUE(factor.factorise(lower, 0));
  const Eigen::MatrixXd b = Eigen::MatrixXd::NullaryExpr(
      lower.cols(), 21, [&] { return std::uniform_real_distribution<double>(-1, 1)(random); });
  for (const Eigen::Index columns : {1, 3, 8, 13, 21}) {
    const Eigen::MatrixXd x = factor.solve_all(b.leftCols(columns));
    ASSERT_EQ(x.cols(), columns);
    for (Eigen::Index i = 0; i < columns; ++i) EXPECT_TRUE(x.col(i) == factor.solve(b.col(i))) << i;
  }
}

// Large enough for nested dissection, which draws random numbers from one place: the same in every thread.
TEST(SupernodalFactor, OrdersLargeBodiesAlikeInEveryThread) {
  std::mt19937 random(5);
  const Sparse lower = grid(14, 3, -1, random);
  ASSERT_GT(lower.cols(), 8000);
  const std::vector<int> order = fill_order(lower);
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i < lower.cols(); ++i) ASSERT_EQ(sorted[static_cast<std::size_t>(i)], i);
  std::vector<std::vector<int>> others(4);
  std::vector<std::thread> threads;
  for (std::vector<int>& other : others) threads.emplace_back([&] { other = fill_order(lower); });
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<int>& other : others) EXPECT_TRUE(other == order);
  SupernodalFactor factor;
  factor.analyse(lower);
  ASSERT_TRUE(factor.factorise(lower, 0));
  EXPECT_GT(factor.negative_pivots(), 0);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(lower.cols(), -1, 2);
  EXPECT_LT(residual(lower, 0, factor.solve(b), b), 1e-12);
}

TEST(SupernodalFactor, TakesUnknownsThatNothingConnects) {
  Sparse lower(5, 5);
  for (int i = 0; i < 5; ++i) lower.insert(i, i) = i + 1.0;
  lower.insert(4, 1) = 0.5;
  lower.makeCompressed();
  SupernodalFactor factor;
  factor.analyse(lower);
  ASSERT_TRUE(factor.factorise(lower, 0));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(5);
  EXPECT_LT(residual(lower, 0, factor.solve(b), b), 1e-15);
}

// A full matrix of n rows: sum over its columns of half the square that is left, n (n + 1) (2 n + 1) / 12.
TEST(SupernodalFactor, CountsItsMultiplications) {
  constexpr int kRows = 30;
  Sparse lower(kRows, kRows);
  for (int j = 0; j < kRows; ++j)
    for (int i = j; i < kRows; ++i) lower.insert(i, j) = i == j ? 2.0 * kRows : 1;
  lower.makeCompressed();
  SupernodalFactor factor;
  factor.analyse(lower);
  EXPECT_DOUBLE_EQ(factor.multiplications(), kRows * (kRows + 1) * (2 * kRows + 1) / 12.0);
}

TEST(SupernodalFactor, CountsNegativeEigenvalues) {
  Sparse lower(3, 3);  // eigenvalues 1, 3 and -2
  for (int i = 0; i < 2; ++i) lower.insert(i, i) = 2;
  lower.insert(1, 0) = 1;
  lower.insert(2, 2) = -2;
  lower.makeCompressed();
  SupernodalFactor factor;
  factor.analyse(lower);
  ASSERT_TRUE(factor.factorise(lower, 0));
  EXPECT_EQ(factor.negative_pivots(), 1);
  ASSERT_TRUE(factor.factorise(lower, 2.5));
  EXPECT_EQ(factor.negative_pivots(), 0);
}

TEST(SupernodalFactor, ReportsAPivotThatIsZeroOrNoNumber) {
  Sparse lower(2, 2);
  lower.insert(0, 0) = 1;
  lower.insert(1, 0) = 1;
  lower.insert(1, 1) = 1;
  lower.makeCompressed();
  SupernodalFactor factor;
  factor.analyse(lower);
  EXPECT_FALSE(factor.factorise(lower, 0));
  EXPECT_TRUE(factor.factorise(lower, 1));
  lower.coeffRef(1, 1) = std::nan("");
  EXPECT_FALSE(factor.factorise(lower, 0));
}

}  // namespace
}  // namespace palpate::fem
