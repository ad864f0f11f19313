// The stored energy of the soft modes: V(q) = 1/2 sum lambda q^2 + cubic + quartic, a polynomial in packed monomials.
// A quartic may turn down far out. Beyond `radius_rootJ`, in the measure rho^2 = sum lambda q^2, every ray keeps the
// linear body's stiffness: t^3 and t^4 go on along their tangents at the radius. Energy and forces stay continuous, and
// the energy is bounded below whatever the coefficients: it ends as a parabola.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

namespace palpate::elastic {

class SoftPotential {
 public:
  SoftPotential() = default;
  // Zero cubic and quartic.
  explicit SoftPotential(const Eigen::VectorXd& lambda);

  Eigen::Index size() const { return lambda_.size(); }
  const Eigen::VectorXd& lambda() const { return lambda_; }
  const std::vector<std::array<int, 3>>& cubic_index() const { return index3_; }
  const std::vector<std::array<int, 4>>& quartic_index() const { return index4_; }
  // Coefficients of the sorted monomials q_a q_b q_c (q_d), in the order of the indices above.
  Eigen::VectorXd cubic, quartic;
  double radius_rootJ = std::numeric_limits<double>::infinity();

  std::size_t cubic_place(int a, int b, int c) const;  // in any order
  std::size_t quartic_place(int a, int b, int c, int d) const;
  // q_a q_b q_c q_d of every quartic monomial, differentiated by q_k.
  Eigen::VectorXd quartic_slopes(const Eigen::VectorXd& q, int k) const;

  struct Value {
    double energy_J = 0;
    Eigen::VectorXd slope;
    Eigen::MatrixXd curvature;
  };
  Value at(const Eigen::VectorXd& q) const;

 private:
  Eigen::VectorXd lambda_;
  std::vector<std::array<int, 3>> index3_;
  std::vector<std::array<int, 4>> index4_;
};

// The largest radius, up to `reach`, within which V holds more than `least` of 1/2 rho^2, along random rays and the
// axes.
double trusted_radius(const SoftPotential& v, double reach_rootJ, double least);

}  // namespace palpate::elastic
