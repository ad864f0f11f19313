#include "config/elastic/soft_potential.h"

#include <algorithm>
#include <cmath>

#include "config/elastic/fixed_random.h"

namespace palpate::elastic {

namespace {

// Adds value, slope and curvature of coefficient * product of q over `index`.
template <std::size_t kDegree>
void add_monomial(const std::array<int, kDegree>& index, double coefficient, const Eigen::VectorXd& q,
                  SoftPotential::Value& out) {
  double whole = coefficient;
  for (const int i : index) whole *= q[i];
  out.energy_J += whole;
  for (std::size_t i = 0; i < kDegree; ++i) {
    double slope = coefficient;
    for (std::size_t k = 0; k < kDegree; ++k)
      if (k != i) slope *= q[index[k]];
    out.slope[index[i]] += slope;
    for (std::size_t j = 0; j < kDegree; ++j) {
      if (j == i) continue;
      double curvature = coefficient;
      for (std::size_t k = 0; k < kDegree; ++k)
        if (k != i && k != j) curvature *= q[index[k]];
      out.curvature(index[i], index[j]) += curvature;
    }
  }
}

SoftPotential::Value zero(Eigen::Index n) { return {0, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)}; }

// Replaces a homogeneous part P of degree n, outside the ball, by P f(rho) with f = p(rho) / rho^n, p the tangent of
// t^n at the radius.
void continue_by_tangent(SoftPotential::Value& part, int degree, double radius, double rho,
                         const Eigen::VectorXd& gradient_rho, const Eigen::MatrixXd& curvature_rho) {
  const double n = degree, p1 = n * std::pow(radius, degree - 1), p = std::pow(radius, degree) + p1 * (rho - radius);
  const double s = std::pow(rho, -degree), s1 = -n * s / rho, s2 = n * (n + 1) * s / (rho * rho);
  const double f = p * s, f1 = p1 * s + p * s1, f2 = 2 * p1 * s1 + p * s2;
  part.curvature = f * part.curvature +
                   f1 * (part.slope * gradient_rho.transpose() + gradient_rho * part.slope.transpose()) +
                   part.energy_J * (f2 * gradient_rho * gradient_rho.transpose() + f1 * curvature_rho);
  part.slope = f * part.slope + part.energy_J * f1 * gradient_rho;
  part.energy_J *= f;
}

template <std::size_t kDegree>
std::size_t place_of(const std::vector<std::array<int, kDegree>>& index, std::array<int, kDegree> wanted) {
  std::sort(wanted.begin(), wanted.end());
  return static_cast<std::size_t>(std::lower_bound(index.begin(), index.end(), wanted) - index.begin());
}

}  // namespace

SoftPotential::SoftPotential(const Eigen::VectorXd& lambda) : lambda_(lambda) {
  const int n = static_cast<int>(lambda.size());
  for (int a = 0; a < n; ++a)
    for (int b = a; b < n; ++b)
      for (int c = b; c < n; ++c) {
        index3_.push_back({a, b, c});
        for (int d = c; d < n; ++d) index4_.push_back({a, b, c, d});
      }
  cubic = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(index3_.size()));
  quartic = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(index4_.size()));
}

std::size_t SoftPotential::cubic_place(int a, int b, int c) const { return place_of<3>(index3_, {a, b, c}); }
std::size_t SoftPotential::quartic_place(int a, int b, int c, int d) const {
  return place_of<4>(index4_, {a, b, c, d});
}

Eigen::VectorXd SoftPotential::quartic_slopes(const Eigen::VectorXd& q, int k) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(quartic.size());
  for (std::size_t m = 0; m < index4_.size(); ++m)
    for (std::size_t i = 0; i < 4; ++i) {
      if (index4_[m][i] != k) continue;
      double slope = 1;
      for (std::size_t j = 0; j < 4; ++j)
        if (j != i) slope *= q[index4_[m][j]];
      out[static_cast<Eigen::Index>(m)] += slope;
    }
  return out;
}

SoftPotential::Value SoftPotential::at(const Eigen::VectorXd& q) const {
  const Eigen::Index n = size();
  Value third = zero(n), fourth = zero(n);
  for (std::size_t m = 0; m < index3_.size(); ++m)
    add_monomial(index3_[m], cubic[static_cast<Eigen::Index>(m)], q, third);
  for (std::size_t m = 0; m < index4_.size(); ++m)
    add_monomial(index4_[m], quartic[static_cast<Eigen::Index>(m)], q, fourth);
  const Eigen::VectorXd stretched = lambda_.cwiseProduct(q);
  const double rho = std::sqrt(q.dot(stretched));
  if (rho > radius_rootJ) {
    const Eigen::VectorXd gradient = stretched / rho;
    const Eigen::MatrixXd curvature = (Eigen::MatrixXd(lambda_.asDiagonal()) - gradient * gradient.transpose()) / rho;
    continue_by_tangent(third, 3, radius_rootJ, rho, gradient, curvature);
    continue_by_tangent(fourth, 4, radius_rootJ, rho, gradient, curvature);
  }
  Value out{0.5 * rho * rho + third.energy_J + fourth.energy_J, stretched + third.slope + fourth.slope,
            third.curvature + fourth.curvature};
  out.curvature.diagonal() += lambda_;
  return out;
}

double trusted_radius(const SoftPotential& v, double reach_rootJ, double least) {
  constexpr int kRays = 400, kSteps = 20;
  const Eigen::Index n = v.size();
  FixedRandom random(3);
  double radius = reach_rootJ;
  for (int ray = 0; ray < kRays + 2 * n; ++ray) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(n);
    if (ray < 2 * n)
      q[ray / 2] = ray % 2 == 0 ? 1 : -1;
    else
      for (double& x : q) x = random.symmetric();
    for (Eigen::Index a = 0; a < n; ++a) q[a] /= std::sqrt(v.lambda()[a]);
    q /= std::sqrt(q.dot(v.lambda().cwiseProduct(q)));
    for (int step = 1; step <= kSteps; ++step) {
      const double rho = reach_rootJ * step / kSteps;
      if (rho >= radius) break;
      if (!(v.at(rho * q).energy_J > 0.5 * least * rho * rho)) radius = reach_rootJ * (step - 1) / kSteps;
    }
  }
  return radius;
}

}  // namespace palpate::elastic
