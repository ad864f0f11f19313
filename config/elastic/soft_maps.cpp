#include "config/elastic/soft_maps.h"

#include <Eigen/Dense>
#include <cmath>

#include "config/elastic/fixed_random.h"

namespace palpate::elastic {

namespace {

// Random directions per unknown of the quartic, each giving `soft` equations.
constexpr int kDirectionsPerUnknown = 3;

template <int kDim>
class Prober {
 public:
  Prober(const RestBody<kDim>& body, const SurfaceModes& modes, int soft, double probe_m)
      : body_(body), phi_(modes.phi_1pm.leftCols(soft)), lambda_(modes.lambda_Npm3.head(soft)), amplitude_(soft) {
    for (int a = 0; a < soft; ++a)
      amplitude_[a] = probe_m * std::sqrt(lambda_[0] / lambda_[a]) / phi_.col(0).cwiseAbs().maxCoeff();
  }

  // K2(v, v), to the fourth order in v.
  Eigen::VectorXd even(const Eigen::VectorXd& v) {
    residuals_ += 2;
    return body_.internal_force(v) + body_.internal_force(-v);
  }
  // phi' K3(v, v, v) / 6, to the seventh order.
  Eigen::VectorXd projected_cubic(const Eigen::VectorXd& v) {
    residuals_ += 4;
    const auto odd = [&](const Eigen::VectorXd& u) -> Eigen::VectorXd {
      return 0.5 * (body_.internal_force(u) - body_.internal_force(-u));
    };
    // K v cancels: (1 - 2 / 8) K3 / 6 is left.
    return phi_.transpose() * (odd(v) - 2 * odd(0.5 * v)) / 0.75;
  }
  // K2[phi_a, phi_b] of all pairs by polarisation.
  std::vector<Eigen::VectorXd> pairs() {
    const int s = static_cast<int>(amplitude_.size());
    std::vector<Eigen::VectorXd> k2(static_cast<std::size_t>(s * (s + 1) / 2));
    for (int a = 0; a < s; ++a) k2[pair_place(a, a, s)] = even(amplitude_[a] * phi_.col(a));
    for (int a = 0; a < s; ++a)
      for (int b = a + 1; b < s; ++b)
        k2[pair_place(a, b, s)] = 0.5 * (even(amplitude_[a] * phi_.col(a) + amplitude_[b] * phi_.col(b)) -
                                         k2[pair_place(a, a, s)] - k2[pair_place(b, b, s)]);
    for (int a = 0; a < s; ++a)
      for (int b = a; b < s; ++b) k2[pair_place(a, b, s)] /= amplitude_[a] * amplitude_[b];
    return k2;
  }

  Eigen::VectorXd follow(const Eigen::VectorXd& k2) const {
    Eigen::VectorXd u = -body_.solve(k2);
    for (Eigen::Index c = 0; c < phi_.cols(); ++c) u += phi_.col(c) * (phi_.col(c).dot(k2) / lambda_[c]);
    return u;
  }

  // The quartic of K3 by least squares over random directions, in units of the amplitudes.
  Eigen::VectorXd fit_quartic(const SoftPotential& shape, double& residual) {
    const Eigen::Index s = amplitude_.size(), unknowns = shape.quartic.size();
    const Eigen::Index directions = kDirectionsPerUnknown * unknowns / s + 1;
    Eigen::MatrixXd rows(directions * s, unknowns);
    Eigen::VectorXd right(directions * s);
    FixedRandom random(2);
    for (Eigen::Index d = 0; d < directions; ++d) {
      Eigen::VectorXd y(s);
      for (double& x : y) x = random.symmetric();
      y.normalize();
      right.segment(d * s, s) = projected_cubic(phi_ * amplitude_.cwiseProduct(y)).cwiseProduct(amplitude_);
      for (int k = 0; k < s; ++k) rows.row(d * s + k) = shape.quartic_slopes(y, k).transpose();
    }
    Eigen::VectorXd fitted = rows.colPivHouseholderQr().solve(right);
    residual = (rows * fitted - right).norm() / right.norm();
    for (std::size_t m = 0; m < shape.quartic_index().size(); ++m)
      for (const int i : shape.quartic_index()[m]) fitted[static_cast<Eigen::Index>(m)] /= amplitude_[i];
    return fitted;
  }
  int residuals() const { return residuals_; }

 private:
  const RestBody<kDim>& body_;
  Eigen::MatrixXd phi_;
  Eigen::VectorXd lambda_, amplitude_;
  int residuals_ = 0;
};

}  // namespace

Eigen::VectorXd soft_displacement(const SurfaceModes& modes, const SoftMaps& maps, const Eigen::VectorXd& q) {
  const int s = static_cast<int>(q.size());
  Eigen::VectorXd u = modes.phi_1pm.leftCols(s) * q;
  for (int a = 0; a < s; ++a)
    for (int b = a; b < s; ++b) u += (a == b ? 0.5 : 1.0) * q[a] * q[b] * maps.theta_1pm3[pair_place(a, b, s)];
  return u;
}

template <int kDim>
SoftMaps soft_maps(const RestBody<kDim>& body, const SurfaceModes& modes, int soft, double probe_m) {
  SoftMaps maps;
  maps.potential = SoftPotential(modes.lambda_Npm3.head(soft));
  Prober<kDim> prober(body, modes, soft, probe_m);
  const std::vector<Eigen::VectorXd> k2 = prober.pairs();
  for (const Eigen::VectorXd& k : k2) maps.theta_1pm3.push_back(prober.follow(k));
  SoftPotential& v = maps.potential;
  v.quartic = prober.fit_quartic(v, maps.quartic_residual);
  for (int a = 0; a < soft; ++a)
    for (int b = 0; b < soft; ++b) {
      const Eigen::VectorXd& k = k2[pair_place(a, b, soft)];
      for (int c = 0; c < soft; ++c) {
        v.cubic[static_cast<Eigen::Index>(v.cubic_place(a, b, c))] += k.dot(modes.phi_1pm.col(c)) / 6;
        for (int d = 0; d < soft; ++d)
          v.quartic[static_cast<Eigen::Index>(v.quartic_place(a, b, c, d))] +=
              k.dot(maps.theta_1pm3[pair_place(c, d, soft)]) / 8;
      }
    }
  maps.residuals = prober.residuals();
  return maps;
}
template SoftMaps soft_maps<2>(const RestBody<2>&, const SurfaceModes&, int, double);
template SoftMaps soft_maps<3>(const RestBody<3>&, const SurfaceModes&, int, double);

}  // namespace palpate::elastic
