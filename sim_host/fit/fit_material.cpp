#include "sim_host/fit/fit_material.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unsupported/Eigen/NonLinearOptimization>

namespace palpate {

namespace {

// Where the optimiser may look. Above 0.495 finite elements lock, and forces hardly change.
constexpr double kPoissonLow = 0.0, kPoissonHigh = 0.495, kFrictionLow = 0.0, kFrictionHigh = 2.0;
// Steps of the differences, in the optimiser's own variables.
constexpr double kStep = 0.02;

double logistic(double x, double low, double high) { return low + (high - low) / (1 + std::exp(-x)); }
double logit(double v, double low, double high) {
  const double share = std::clamp((v - low) / (high - low), 0.01, 0.99);
  return std::log(share / (1 - share));
}

// The optimiser's variables: ln E, and the others through a logistic curve, so that no step leaves the range.
double variable_of(const MaterialGuess& m, Fitted what) {
  if (what == Fitted::kModulus) return std::log(m.youngs_modulus_Pa);
  return what == Fitted::kPoisson ? logit(m.poisson_ratio, kPoissonLow, kPoissonHigh)
                                  : logit(m.friction, kFrictionLow, kFrictionHigh);
}
double& member_of(MaterialGuess& m, Fitted what) {
  if (what == Fitted::kModulus) return m.youngs_modulus_Pa;
  return what == Fitted::kPoisson ? m.poisson_ratio : m.friction;
}
double value_of(double x, Fitted what) {
  if (what == Fitted::kModulus) return std::exp(x);
  return what == Fitted::kPoisson ? logistic(x, kPoissonLow, kPoissonHigh) : logistic(x, kFrictionLow, kFrictionHigh);
}

// What Eigen's optimiser asks of a problem.
struct Problem {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const ForwardModel& forward;
  MaterialGuess base;
  const std::vector<Fitted>& wanted;
  const std::vector<Vec3>& measured_N;
  mutable int evaluations = 0;

  int inputs() const { return static_cast<int>(wanted.size()); }
  int values() const { return static_cast<int>(3 * measured_N.size()); }
  MaterialGuess material(const Eigen::VectorXd& x) const {
    MaterialGuess m = base;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      member_of(m, wanted[i]) = value_of(x[static_cast<Eigen::Index>(i)], wanted[i]);
    return m;
  }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residual) const {
    const std::vector<Vec3> force = forward(material(x));
    evaluations += 1;
    for (std::size_t i = 0; i < force.size(); ++i) {
      const Vec3 d = force[i] - measured_N[i];
      const auto row = static_cast<Eigen::Index>(3 * i);
      residual[row] = d.x, residual[row + 1] = d.y, residual[row + 2] = d.z;
    }
    return 0;
  }
  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& jacobian) const {
    Eigen::VectorXd high(values()), low(values());
    for (Eigen::Index k = 0; k < inputs(); ++k) {
      Eigen::VectorXd at = x;
      at[k] = x[k] + kStep;
      (*this)(at, high);
      at[k] = x[k] - kStep;
      (*this)(at, low);
      jacobian.col(k) = (high - low) / (2 * kStep);
    }
    return 0;
  }
};

// Two-sided 95 % quantile of Student's distribution (fit within 1 % from 3 degrees of freedom on).
double student(double freedom) { return 1.96 + 2.37 / freedom + 2.82 / (freedom * freedom); }

// Correlation of the residuals of one component from one row to the next.
double correlation_of(const Eigen::VectorXd& residual) {
  double product = 0, square = 0;
  for (Eigen::Index i = 0; i + 3 < residual.size(); ++i) product += residual[i] * residual[i + 3];
  square = residual.squaredNorm();
  return square > 0 ? std::clamp(product / square, 0.0, 0.98) : 0;
}

bool is_unknown(Fitted what, double value, double half_width) {
  if (!std::isfinite(half_width)) return true;
  if (what == Fitted::kModulus) return half_width > kModulusUnknown * value;
  return half_width > (what == Fitted::kPoisson ? kPoissonUnknown : kFrictionUnknown);
}

// One fit of all the parameters in `wanted`, with their confidence.
MaterialFit fit_all(const ForwardModel& forward, const MaterialGuess& guess, const std::vector<Fitted>& wanted,
                    const std::vector<Vec3>& measured_N) {
  Problem problem{forward, guess, wanted, measured_N};
  Eigen::VectorXd x(problem.inputs());
  for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = variable_of(guess, wanted[static_cast<std::size_t>(k)]);
  Eigen::LevenbergMarquardt<Problem> optimiser(problem);
  optimiser.parameters.xtol = optimiser.parameters.ftol = 1e-6;
  optimiser.parameters.maxfev = 60;
  if (x.size() > 0) optimiser.minimize(x);
  MaterialFit fit;
  fit.material = problem.material(x);
  Eigen::VectorXd residual(problem.values());
  Eigen::MatrixXd jacobian(problem.values(), problem.inputs());
  problem(x, residual);
  problem.df(x, jacobian);
  fit.force_N = forward(fit.material);
  // A component that no force ever had carries no information: a straight press has one.
  double informative = 0;
  for (Eigen::Index c = 0; c < 3; ++c)
    for (Eigen::Index i = c; i < residual.size(); i += 3)
      if (std::abs(residual[i]) > 0) informative += 1;
  const double freedom = std::max(1.0, informative - static_cast<double>(problem.inputs()));
  fit.noise_N = std::sqrt(residual.squaredNorm() / freedom);
  fit.correlation = correlation_of(residual);
  // Neighbouring rows that err alike are fewer measurements than they are rows.
  const double repeated = (1 + fit.correlation) / (1 - fit.correlation);
  const Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  const Eigen::MatrixXd covariance =
      fit.noise_N * fit.noise_N * repeated * information.completeOrthogonalDecomposition().pseudoInverse();
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const Fitted what = wanted[static_cast<std::size_t>(k)];
    const double in_variable = student(freedom / repeated + 1) * std::sqrt(std::max(covariance(k, k), 0.0));
    const double slope = (value_of(x[k] + kStep, what) - value_of(x[k] - kStep, what)) / (2 * kStep);
    const bool blind = !(jacobian.col(k).norm() > 1e-9 * residual.norm()) && !(jacobian.col(k).norm() > 1e-12);
    fit.value.push_back({what, value_of(x[k], what), in_variable * slope, true});
    fit.value.back().identified = !blind && !is_unknown(what, fit.value.back().value, fit.value.back().half_width);
  }
  fit.evaluations = problem.evaluations;
  return fit;
}

}  // namespace

MaterialFit fit_material(const ForwardModel& forward, const MaterialGuess& guess, const std::vector<Fitted>& wanted,
                         const std::vector<Vec3>& measured_N) {
  double largest = 0;
  for (const Vec3& force : measured_N) largest = std::max(largest, norm(force));
  if (!(largest > 0)) throw std::runtime_error("the measurement has no force at all: is the tool in contact?");
  if (measured_N.size() <= wanted.size() + 1)
    throw std::runtime_error("fewer measured rows than parameters and one more: measure more, or fit less");
  std::vector<Fitted> left = wanted;
  std::vector<FittedValue> unknown;
  MaterialFit fit;
  int evaluations = 0;
  for (;;) {
    fit = fit_all(forward, guess, left, measured_N);
    evaluations += fit.evaluations;
    // The least known goes first: without it the others may be known well.
    const auto worst = std::ranges::find_if(fit.value.rbegin(), fit.value.rend(),
                                            [](const FittedValue& value) { return !value.identified; });
    if (worst == fit.value.rend()) break;
    MaterialGuess start = guess;
    FittedValue value = *worst;
    value.value = member_of(start, value.what);
    unknown.push_back(value);
    std::erase(left, value.what);
  }
  fit.value.insert(fit.value.end(), unknown.begin(), unknown.end());
  fit.evaluations = evaluations;
  return fit;
}

}  // namespace palpate
