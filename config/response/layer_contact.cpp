#include "config/response/layer_loss.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "rt_core/math.h"

namespace palpate {

namespace {

constexpr int kPoints = 64;
// Steps of the tabulated kernel per unit of distance / thickness: its cubics are then within 1e-12.
constexpr double kStepsPerUnit = 200;

struct Quadrature {
  std::vector<double> x, w;  // on [0, 1]
};

// Gauss-Legendre points by Newton on the Legendre polynomial.
Quadrature gauss_legendre(int n) {
  Quadrature q;
  for (int i = 0; i < n; ++i) {
    double z = -math::cos(kPi * (i + 0.75) / (n + 0.5)), derivative = 1;
    for (int k = 0; k < 20; ++k) {
      double p1 = 1, p2 = 0;
      for (int j = 0; j < n; ++j) {
        const double p3 = p2;
        p2 = p1;
        p1 = ((2.0 * j + 1.0) * z * p2 - j * p3) / (j + 1.0);
      }
      derivative = n * (z * p1 - p2) / (z * z - 1.0);
      z -= p1 / derivative;
    }
    q.x.push_back(0.5 * (1 + z));
    q.w.push_back(1.0 / ((1 - z * z) * derivative * derivative));
  }
  return q;
}

const Quadrature& rule() {
  static const Quadrature q = gauss_legendre(kPoints);
  return q;
}

double profile_at(const Indenter& indenter, double x) {
  switch (indenter.profile) {
    case TipProfile::kFlat:
      return 0;
    case TipProfile::kParabola:
      return x * x / indenter.radius_m;
    case TipProfile::kSphere: {
      const double q = x / indenter.radius_m;
      if (q < 1e-3) return indenter.radius_m * q * q * (1 + q * q / 3);  // next term q^4/5: below 1e-12
      return 0.5 * x * (math::log(1 + q) - math::log(1 - q));
    }
    case TipProfile::kCone:
      return 0.5 * kPi * x / indenter.tan_half_angle;
  }
  return 0;
}

// Contact radius of the half-space solution: where the search at a depth starts.
double first_radius(const Indenter& indenter, double depth) {
  if (indenter.profile == TipProfile::kCone) return 2 / kPi * depth * indenter.tan_half_angle;
  return std::min(square_root(indenter.radius_m * depth), 0.98 * indenter.radius_m);
}

}  // namespace

// From exp(-2w) so that nothing overflows or cancels at large w.
double layer_loss(const ElasticLayer& layer, double w) {
  const double x = math::exp(-2 * w), x2 = x * x;
  if (layer.base == LayerBase::kSlip) {
    // 2 sinh^2 w = cosh 2w - 1.
    return (2 * x * (1 + 2 * w) - 2 * x2) / (1 - x2 + 4 * w * x);
  }
  const double k = 3 - 4 * layer.poisson_ratio;
  const double rest = k * k + 1 + 4 * w * w + 4 * w;
  return (2 * k * x2 + rest * x) / (k * (1 + x2) + (k * k + 1 + 4 * w * w) * x);
}

LayerContact::LayerContact(const ElasticLayer& layer, double largest_radius_m) : layer_(layer) {
  if (!(layer.thickness_m > 0)) return;
  const double reach = 2.02 * largest_radius_m / layer.thickness_m + 0.05;
  const auto count = static_cast<std::size_t>(reach * kStepsPerUnit) + 2;
  step_ = 1.0 / kStepsPerUnit;
  value_.assign(count, 0.0);
  slope_.assign(count, 0.0);
  // 1 - L falls like w^2 exp(-2w): nothing is left at w = 24. A panel of 0.25 never holds more than a few periods.
  const Quadrature panel = gauss_legendre(12);
  for (int p = 0; p < 96; ++p) {
    for (std::size_t k = 0; k < panel.x.size(); ++k) {
      const double w = 0.25 * (p + panel.x[k]), share = 0.25 * panel.w[k] * layer_loss(layer, w);
      // cos and sin of w s on the uniform grid by rotation.
      const double c1 = math::cos(w * step_), s1 = math::sin(w * step_);
      double c = 1, s = 0;
      for (std::size_t i = 0; i < count; ++i) {
        value_[i] += share * c;
        slope_[i] -= share * w * s;
        const double next = c * c1 - s * s1;
        s = s * c1 + c * s1;
        c = next;
      }
    }
  }
}

double LayerContact::kernel(double s) const {
  const double x = std::abs(s) / step_;
  const std::size_t i = std::min(static_cast<std::size_t>(x), value_.size() - 2);
  const double u = x - static_cast<double>(i), rise = value_[i + 1] - value_[i];
  const double p = step_ * slope_[i], q = step_ * slope_[i + 1];
  return value_[i] + u * (p + u * (3 * rise - 2 * p - q + u * (p + q - 2 * rise)));
}

double LayerContact::kernel_at_zero_per_m() const {
  return layer_.thickness_m > 0 ? value_[0] / layer_.thickness_m : 0.0;
}

LayerState LayerContact::at_radius(const Indenter& indenter, double radius_m) const {
  const Quadrature& q = rule();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(kPoints, kPoints);
  Eigen::MatrixXd right(kPoints, 2);
  const double ratio = layer_.thickness_m > 0 ? radius_m / layer_.thickness_m : 0.0;
  const auto pull = [&](double x, double t) {
    return ratio / kPi * (kernel(ratio * (x - t)) + kernel(ratio * (x + t)));
  };
  for (int i = 0; i < kPoints; ++i) {
    const auto a = static_cast<std::size_t>(i);
    for (int j = 0; ratio > 0 && j < kPoints; ++j)
      matrix(i, j) -= q.w[static_cast<std::size_t>(j)] * pull(q.x[a], q.x[static_cast<std::size_t>(j)]);
    right(i, 0) = 1 / kPi;
    right(i, 1) = profile_at(indenter, radius_m * q.x[a]) / kPi;
  }
  const Eigen::MatrixXd phi = ratio > 0 ? Eigen::MatrixXd(matrix.partialPivLu().solve(right)) : right;
  double sum[2] = {0, 0}, edge[2] = {1 / kPi, profile_at(indenter, radius_m) / kPi};
  for (int i = 0; i < kPoints; ++i) {
    const auto a = static_cast<std::size_t>(i);
    const double reach = ratio > 0 ? q.w[a] * pull(1.0, q.x[a]) : 0.0;
    for (int k = 0; k < 2; ++k) {
      sum[k] += 2 * kPi * radius_m * q.w[a] * phi(i, k);
      edge[k] += reach * phi(i, k);
    }
  }
  const double depth = indenter.profile == TipProfile::kFlat ? 1.0 : edge[1] / edge[0];
  return {depth, depth * sum[0] - sum[1], sum[0]};
}

LayerState LayerContact::at_depth(const Indenter& indenter, double depth_m) const {
  // Secant in log a: depth grows like a power of a, so the function is nearly straight.
  double a0 = first_radius(indenter, depth_m), a1 = 0.999 * a0;
  LayerState s0 = at_radius(indenter, a0), s1 = at_radius(indenter, a1);
  const double widest = indenter.profile == TipProfile::kCone ? kHuge : 0.9999999 * indenter.radius_m;
  for (int i = 0; i < 60 && std::abs(s1.depth_m - depth_m) > 1e-14 * depth_m; ++i) {
    const double power = math::log(s1.depth_m / s0.depth_m) / math::log(a1 / a0);
    if (!(std::abs(power) > 1e-6)) break;
    const double next = std::min(a1 * math::exp(std::clamp(math::log(depth_m / s1.depth_m) / power, -0.5, 0.5)),
                                 indenter.profile == TipProfile::kParabola ? kHuge : 0.5 * (widest + a1));
    a0 = a1;
    s0 = s1;
    a1 = next;
    s1 = at_radius(indenter, a1);
    if (a1 == a0) break;
  }
  // What is left of the depth error is removed to second order by the stiffness.
  s1.force_m2 += s1.stiffness_m * (depth_m - s1.depth_m);
  s1.depth_m = depth_m;
  return s1;
}

double elliptic_radius_m(double curvature_a_per_m, double curvature_b_per_m) {
  const double small = std::min(curvature_a_per_m, curvature_b_per_m);
  const double large = std::max(curvature_a_per_m, curvature_b_per_m);
  // Nearly circular: the geometric mean is exact to second order in the difference.
  if (large < (1 + 1e-6) * small) return 1 / square_root(small * large);
  // K and (K - E)/K of modulus e by the arithmetic-geometric mean, without cancellation.
  struct Integrals {
    double k, drop;
  };
  const auto integrals = [](double e2) {
    double a = 1, b = square_root(1 - e2), sum = 0.5 * e2, scale = 1;
    for (int i = 0; i < 40 && a - b > 1e-16 * a; ++i) {
      const double c = 0.5 * (a - b), mean = 0.5 * (a + b);
      b = square_root(a * b);
      a = mean;
      sum += scale * c * c;
      scale *= 2;
    }
    return Integrals{kPi / (2 * a), sum};
  };
  // B/A = ((1 - e^2)^-1 E - K)/(K - E) rises with e: bisection in t = -ln(1 - e^2).
  double low = 0, high = 80;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.5 * (low + high), rest = math::exp(-t);
    const Integrals n = integrals(1 - rest);
    (((1 - n.drop) / rest - 1) / n.drop > large / small ? high : low) = t;
  }
  const double e2 = 1 - math::exp(-0.5 * (low + high));
  const Integrals n = integrals(e2);
  // F = 2 pi/3 E* sqrt((K - E)/(K^3 e^2 A)) d^1.5, A = half the smaller curvature.
  const double c = 2 * kPi / 3 * square_root(n.drop / (n.k * n.k * e2 * 0.5 * small));
  return (0.75 * c) * (0.75 * c);
}

}  // namespace palpate
