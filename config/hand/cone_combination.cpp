#include "config/hand/cone_combination.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace palpate {

namespace {

using Index = Eigen::Index;

// Least squares on the columns that take part; zero elsewhere.
Eigen::VectorXd unconstrained(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target,
                              const std::vector<bool>& in) {
  std::vector<Index> part;
  for (Index j = 0; j < columns.cols(); ++j)
    if (in[static_cast<std::size_t>(j)]) part.push_back(j);
  const Eigen::VectorXd solved = columns(Eigen::all, part).completeOrthogonalDecomposition().solve(target);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(columns.cols());
  for (std::size_t k = 0; k < part.size(); ++k) weight[part[k]] = solved[static_cast<Index>(k)];
  return weight;
}

// From `from` towards `to`, as far as no weight falls below zero; those at zero leave.
void step_back(const Eigen::VectorXd& to, Eigen::VectorXd& from, std::vector<bool>& in) {
  double share = 1;
  for (Index j = 0; j < to.size(); ++j)
    if (in[static_cast<std::size_t>(j)] && to[j] <= 0) share = std::min(share, from[j] / (from[j] - to[j]));
  from += share * (to - from);
  for (Index j = 0; j < to.size(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    if (in[at] && to[j] <= 0 && from[j] <= 1e-14 * from.cwiseAbs().maxCoeff()) in[at] = false;
    if (!in[at]) from[j] = 0;
  }
}

}  // namespace

ConeCombination cone_combination(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) {
  const Index n = columns.cols();
  ConeCombination result{Eigen::VectorXd::Zero(n), target};
  std::vector<bool> in(static_cast<std::size_t>(n), false);
  const double enough = 1e-12 * columns.cwiseAbs().maxCoeff() * (1 + target.norm());
  for (Index entered = 0; entered < 3 * n; ++entered) {
    const Eigen::VectorXd slope = columns.transpose() * result.residual;
    Index best = -1;
    for (Index j = 0; j < n; ++j)
      if (!in[static_cast<std::size_t>(j)] && slope[j] > enough && (best < 0 || slope[j] > slope[best])) best = j;
    if (best < 0) break;
    in[static_cast<std::size_t>(best)] = true;
    Eigen::VectorXd wanted = unconstrained(columns, target, in);
    for (Index back = 0; back < n && (wanted.array() < 0).any(); ++back) {
      step_back(wanted, result.weight, in);
      wanted = unconstrained(columns, target, in);
    }
    result.weight = wanted.cwiseMax(0.0);
    result.residual = target - columns * result.weight;
  }
  return result;
}

}  // namespace palpate
