#include "config/fem/sparse_factor.h"

#include <Eigen/SparseCholesky>

#include "config/scene/config_error.h"

namespace palpate {

SparseFactor::SparseFactor(const Eigen::SparseMatrix<double>& lower) {
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> cholesky(lower);
  if (cholesky.info() != Eigen::Success)
    throw ConfigError(
        "the stiffness matrix is not positive definite: the supports leave a motion free, or elements are so flat "
        "that rounding decides");
  const Eigen::SparseMatrix<double>& factor = cholesky.matrixL().nestedExpression();
  const Eigen::Index n = factor.cols();
  diagonal_.reserve(static_cast<std::size_t>(n));
  start_.reserve(static_cast<std::size_t>(n) + 1);
  row_.reserve(static_cast<std::size_t>(factor.nonZeros() - n));
  value_.reserve(static_cast<std::size_t>(factor.nonZeros() - n));
  for (Eigen::Index column = 0; column < n; ++column) {
    start_.push_back(value_.size());
    for (Eigen::SparseMatrix<double>::InnerIterator entry(factor, column); entry; ++entry) {
      if (entry.row() == column) {
        diagonal_.push_back(entry.value());
        continue;
      }
      row_.push_back(static_cast<std::int32_t>(entry.row()));
      value_.push_back(entry.value());
    }
  }
  start_.push_back(value_.size());
}

void SparseFactor::solve_from(std::size_t first, std::vector<Lane>& x) const {
  const std::size_t n = size();
  for (std::size_t column = first; column < n; ++column) {
    Lane pivot = x[column];
    for (double& v : pivot.value) v /= diagonal_[column];
    x[column] = pivot;
    for (std::size_t k = start_[column]; k < start_[column + 1]; ++k) {
      Lane& target = x[static_cast<std::size_t>(row_[k])];
      for (std::size_t c = 0; c < kWidth; ++c) target.value[c] -= value_[k] * pivot.value[c];
    }
  }
  for (std::size_t column = n; column-- > first;) {
    Lane sum = x[column];
    for (std::size_t k = start_[column]; k < start_[column + 1]; ++k) {
      const Lane& source = x[static_cast<std::size_t>(row_[k])];
      for (std::size_t c = 0; c < kWidth; ++c) sum.value[c] -= value_[k] * source.value[c];
    }
    for (double& v : sum.value) v /= diagonal_[column];
    x[column] = sum;
  }
}

}  // namespace palpate
