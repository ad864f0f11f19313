#include "config/elastic/soft_maps.h"

#include <Eigen/Dense>
#include <cmath>

#include "config/elastic/fixed_random.h"
#include "config/parallel.h"

namespace palpate::elastic {

namespace {

// Random directions per unknown of the quartic, each giving `soft` equations.
constexpr int kDirectionsPerUnknown = 3;

template <int kDim>
class Prober {
 public:
  Prober(const RestBody<kDim>& body, const SurfaceModes& modes, int soft, double probe_m, unsigned jobs)
      : body_(body),
        phi_(modes.phi_1pm.leftCols(soft)),
        lambda_(modes.lambda_Npm3.head(soft)),
        amplitude_(soft),
        jobs_(jobs) {
    for (int a = 0; a < soft; ++a)
      amplitude_[a] = probe_m * std::sqrt(lambda_[0] / lambda_[a]) / phi_.col(0).cwiseAbs().maxCoeff();
  }

  // K2(v, v), to the fourth order in v.
  Eigen::VectorXd even(const Eigen::VectorXd& v) const { return body_.internal_force(v) + body_.internal_force(-v); }
  // phi' K3(v, v, v) / 6, to the seventh order.
  Eigen::VectorXd projected_cubic(const Eigen::VectorXd& v) const {
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
    std::vector<std::pair<int, int>> pair;
    for (int a = 0; a < s; ++a)
      for (int b = a; b < s; ++b) pair.emplace_back(a, b);
    for_each_piece(pair.size(), jobs_, [&](std::size_t i) {
      const auto [a, b] = pair[i];
      Eigen::VectorXd v = amplitude_[a] * phi_.col(a);
      if (b != a) v += amplitude_[b] * phi_.col(b);
      k2[pair_place(a, b, s)] = even(v);
    });
    residuals_ += 2 * static_cast<int>(k2.size());
    for (int a = 0; a < s; ++a)
      for (int b = a + 1; b < s; ++b)
        k2[pair_place(a, b, s)] = 0.5 * (k2[pair_place(a, b, s)] - k2[pair_place(a, a, s)] - k2[pair_place(b, b, s)]);
    for (int a = 0; a < s; ++a)
      for (int b = a; b < s; ++b) k2[pair_place(a, b, s)] /= amplitude_[a] * amplitude_[b];
    return k2;
  }

  std::vector<Eigen::VectorXd> follow(const std::vector<Eigen::VectorXd>& k2) const {
    std::vector<Eigen::VectorXd> theta(k2.size());
    for_each_piece(k2.size(), jobs_, [&](std::size_t i) {
      Eigen::VectorXd u = -body_.solve(k2[i]);
      for (Eigen::Index c = 0; c < phi_.cols(); ++c) u += phi_.col(c) * (phi_.col(c).dot(k2[i]) / lambda_[c]);
      theta[i] = std::move(u);
    });
    return theta;
  }

  // The quartic of K3 by least squares over random directions, in units of the amplitudes.
  Eigen::VectorXd fit_quartic(const SoftPotential& shape, double& residual) {
    const Eigen::Index s = amplitude_.size(), unknowns = shape.quartic.size();
    const Eigen::Index directions = kDirectionsPerUnknown * unknowns / s + 1;
    Eigen::MatrixXd rows(directions * s, unknowns);
    Eigen::VectorXd right(directions * s);
    FixedRandom random(2);
    std::vector<Eigen::VectorXd> direction(static_cast<std::size_t>(directions), Eigen::VectorXd(s));
    for (Eigen::VectorXd& y : direction) {
      for (double& x : y) x = random.symmetric();
      y.normalize();
    }
    for_each_piece(direction.size(), jobs_, [&](std::size_t i) {
      const Eigen::VectorXd& y = direction[i];
      const auto d = static_cast<Eigen::Index>(i);
      right.segment(d * s, s) = projected_cubic(phi_ * amplitude_.cwiseProduct(y)).cwiseProduct(amplitude_);
      for (int k = 0; k < s; ++k) rows.row(d * s + k) = shape.quartic_slopes(y, k).transpose();
    });
    residuals_ += 4 * static_cast<int>(directions);
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
  unsigned jobs_;
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
SoftMaps soft_maps(const RestBody<kDim>& body, const SurfaceModes& modes, int soft, double probe_m, unsigned jobs) {
  SoftMaps maps;
  maps.potential = SoftPotential(modes.lambda_Npm3.head(soft));
  Prober<kDim> prober(body, modes, soft, probe_m, jobs);
  const std::vector<Eigen::VectorXd> k2 = prober.pairs();
  maps.theta_1pm3 = prober.follow(k2);
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
template SoftMaps soft_maps<2>(const RestBody<2>&, const SurfaceModes&, int, double, unsigned);
template SoftMaps soft_maps<3>(const RestBody<3>&, const SurfaceModes&, int, double, unsigned);

}  // namespace palpate::elastic
