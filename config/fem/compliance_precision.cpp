#include "config/fem/compliance_precision.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

constexpr std::size_t kPresses = 48;

std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

// The free vertices nearest to one, those that face the same way as it: what a flat tool would touch.
std::vector<std::size_t> patch_around(const CondensedBody& body, std::size_t centre, std::size_t count) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < body.held.size(); ++i)
    if (body.held[i] == 0 && dot(body.normal[i], body.normal[centre]) > 0.5)
      near.emplace_back(squared_norm(body.surface.vertex_m[i] - body.surface.vertex_m[centre]), i);
  std::sort(near.begin(), near.end());
  std::vector<std::size_t> patch;
  for (std::size_t k = 0; k < std::min(count, near.size()); ++k) patch.push_back(near[k].second);
  return patch;
}

template <class Scalar>
Eigen::MatrixXd normal_compliance(const CondensedBody& body, const std::vector<std::size_t>& patch) {
  const std::size_t stride = 3 * body.node.size();
  const auto n = static_cast<Eigen::Index>(patch.size());
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const Vec3 a = body.normal[patch[at(i)]], b = body.normal[patch[at(j)]];
      const double* block = &body.compliance_mpN[3 * patch[at(i)] * stride + 3 * patch[at(j)]];
      const auto entry = [&](std::size_t row, std::size_t column) {
        return static_cast<double>(static_cast<Scalar>(block[row * stride + column]));
      };
      const auto row = [&](std::size_t r) { return entry(r, 0) * b.x + entry(r, 1) * b.y + entry(r, 2) * b.z; };
      matrix(i, j) = a.x * row(0) + a.y * row(1) + a.z * row(2);
    }
  return matrix;
}

}  // namespace

PrecisionReport single_precision_error(const CondensedBody& body) {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < body.held.size(); ++i)
    if (body.held[i] == 0) free.push_back(i);
  PrecisionReport report;
  const std::size_t presses = std::min(kPresses, free.size());
  for (std::size_t s = 0; s < presses; ++s)
    for (const std::size_t count : {std::size_t{10}, std::size_t{40}}) {
      const std::vector<std::size_t> patch = patch_around(body, free[s * free.size() / presses], count);
      const Eigen::LLT<Eigen::MatrixXd> exact(normal_compliance<double>(body, patch));
      const Eigen::LLT<Eigen::MatrixXd> rounded(normal_compliance<float>(body, patch));
      if (exact.info() != Eigen::Success || rounded.info() != Eigen::Success) {
        report.is_definite = false;
        continue;
      }
      const Eigen::VectorXd depth = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(patch.size()));
      const Eigen::VectorXd force = exact.solve(depth), other = rounded.solve(depth);
      report.total_error = std::max(report.total_error, std::abs(other.sum() / force.sum() - 1.0));
      report.node_error =
          std::max(report.node_error, (other - force).cwiseAbs().maxCoeff() / force.cwiseAbs().maxCoeff());
    }
  return report;
}

}  // namespace palpate
