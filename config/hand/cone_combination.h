// The combination of given vectors with weights >= 0 that comes nearest to a target: non-negative least squares.
#pragma once

#include <Eigen/Dense>

namespace palpate {

struct ConeCombination {
  Eigen::VectorXd weight;    // >= 0, one per column
  Eigen::VectorXd residual;  // target - columns * weight: where it is not zero, a plane that parts the target from all
                             // columns: columns^T residual <= 0, target . residual > 0 (Farkas)
};

// Lawson & Hanson 1974, chapter 23. At most three times as many columns enter as there are.
ConeCombination cone_combination(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target);

}  // namespace palpate
