// Sparse Cholesky factor of a symmetric positive definite matrix, and solves for many right-hand sides at once.
// Eigen's factorisation is kept to its scalar code, and solves run each column's operations in one order whatever
// their number: an image has the same bits from every compiler. CHOLMOD would depend on the BLAS that happens to be
// installed.
#pragma once

#include <Eigen/Sparse>
#include <cstdint>
#include <vector>

namespace palpate {

class SparseFactor {
 public:
  // Right-hand sides per pass over the factor: four AVX registers of accumulators leave room for the operands.
  static constexpr std::size_t kWidth = 16;
  // Values of kWidth right-hand sides for one equation.
  struct alignas(64) Lane {
    double value[kWidth];
  };

  // `lower`: the lower triangle in elimination order. Throws ConfigError when it is not positive definite.
  explicit SparseFactor(const Eigen::SparseMatrix<double>& lower);

  std::size_t size() const { return diagonal_.size(); }
  std::size_t entries() const { return value_.size() + diagonal_.size(); }
  // L y = x, then L' x = y, in place, where x is zero before `first`; results before `first` are not computed.
  void solve_from(std::size_t first, std::vector<Lane>& x) const;

 private:
  std::vector<double> diagonal_;
  std::vector<std::size_t> start_;  // of each column's entries below the diagonal
  std::vector<std::int32_t> row_;
  std::vector<double> value_;
};

}  // namespace palpate
