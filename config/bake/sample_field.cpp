#include "config/bake/sample_field.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "config/elastic/self_terms.h"

namespace palpate {

namespace {

// In spacings: how far a sample is heard, and how far away the opposite outlook counts as.
constexpr double kLengths = 4, kTurn = 1, kNugget = 1e-6;
// Of the middle one of the samples' sizes.
constexpr double kOutlying = 20;

Eigen::MatrixXd without_outliers(Eigen::MatrixXd value) {
  for (Eigen::Index k = 0; k < value.cols(); ++k) {
    Eigen::VectorXd size = value.col(k).cwiseAbs();
    std::nth_element(size.begin(), size.begin() + size.size() / 2, size.end());
    const double most = kOutlying * size[size.size() / 2];
    if (most > 0) value.col(k) = value.col(k).cwiseMax(-most).cwiseMin(most);
  }
  return value;
}

}  // namespace

SampleField::SampleField(const elastic::Surface<3>& surface, const std::vector<int>& nodes,
                         const Eigen::MatrixXd& value, double spacing_m)
    : length_(kLengths * spacing_m) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd kernel(n, n);
  for (const int node : nodes)
    samples_.push_back({elastic::vec(surface.rest(node)), elastic::vec(elastic::node_normal(surface, node))});
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k)
      kernel(i, k) = likeness(samples_[static_cast<std::size_t>(i)], samples_[static_cast<std::size_t>(k)]);
  mean_ = value.colwise().mean();
  kernel.diagonal().array() += kNugget;
  weight_ = kernel.llt().solve(value.rowwise() - mean_);
}

Eigen::RowVectorXd SampleField::show(Vec3 p, Vec3 normal) const {
  Eigen::RowVectorXd sum = mean_;
  for (std::size_t i = 0; i < samples_.size(); ++i)
    sum += likeness({p, normal}, samples_[i]) * weight_.row(static_cast<Eigen::Index>(i));
  return sum;
}

double SampleField::likeness(const Sample& a, const Sample& b) const {
  const double d = norm(a.position - b.position) / length_, turn = kTurn * norm(a.normal - b.normal);
  const double r = std::sqrt(3.0 * (d * d + turn * turn));
  return (1 + r) * std::exp(-r);
}

SampleField tame_field(const elastic::Surface<3>& surface, const std::vector<int>& nodes, const Eigen::MatrixXd& value,
                       double spacing_m) {
  return {surface, nodes, without_outliers(value), spacing_m};
}

}  // namespace palpate
