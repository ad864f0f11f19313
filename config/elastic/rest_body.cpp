#include "config/elastic/rest_body.h"

#include <cmath>

#include "config/scene/config_error.h"

namespace palpate::elastic {

namespace {

// A load's displacement gives the load back to this share, or the factor has met a free rigid motion.
constexpr double kSolveTolerance = 1e-6;

std::vector<int> number(const std::vector<bool>& fixed) {
  std::vector<int> equation;
  int next = 0;
  for (const bool f : fixed) equation.push_back(f ? -1 : next++);
  return equation;
}

}  // namespace

template <int kDim>
RestBody<kDim>::RestBody(const fem::StrainMesh<kDim>& mesh, const fem::StrainBody& body, const std::vector<bool>& fixed)
    : material_(body),
      size_(static_cast<Eigen::Index>(mesh.node_count()) * kDim),
      surface_(mesh, kDim == 2 ? body.thickness_m : 1),
      assembly_(mesh, body, number(fixed)) {
  if (!(body.youngs_modulus_Pa > 0) || !(body.poisson_ratio > -1 && body.poisson_ratio <= 0.4999))
    throw ConfigError("elastic body: Young's modulus must be above 0 Pa and Poisson's ratio in (-1, 0.4999]");
  if (body.kinematics == fem::Kinematics::kAxisymmetric)
    throw ConfigError("elastic body: a body of revolution is meshed in space, not in its half plane");
  find_node_moduli(mesh);
  Eigen::SparseMatrix<double> stiffness = assembly_.pattern();
  assembly_.evaluate(Eigen::VectorXd::Zero(size_), nullptr, &stiffness);
  factor_.analyse(stiffness);
  bool held = factor_.factorise(stiffness, 0);
  if (held) {
    // A free motion leaves a pivot of rounding: the answer then is no answer.
    Eigen::VectorXd load(stiffness.cols());
    for (Eigen::Index i = 0; i < load.size(); ++i) load[i] = 1 + 0.1 * static_cast<double>(i % 7);
    const Eigen::VectorXd answer = factor_.solve(load);
    const Eigen::VectorXd back = stiffness.selfadjointView<Eigen::Lower>() * answer;
    held = (back - load).norm() < kSolveTolerance * load.norm();
  }
  if (!held)
    throw ConfigError(
        "elastic body: the supports leave a motion free, or elements are so flat that rounding decides; hold the body "
        "in "
        "more places");
}

template <int kDim>
double RestBody<kDim>::contact_modulus() const {
  return contact_modulus_of({material_.youngs_modulus_Pa, material_.poisson_ratio});
}
template <int kDim>
double RestBody<kDim>::contact_modulus_of(const fem::ElementMaterial& m) const {
  const double nu = m.poisson_ratio;
  const double shared = material_.kinematics == fem::Kinematics::kPlaneStress ? 1 : 1 - nu * nu;
  return m.youngs_modulus_Pa / shared * (kDim == 2 ? material_.thickness_m : 1);
}
template <int kDim>
double RestBody<kDim>::contact_modulus(int node) const {
  return node_modulus_.empty() ? contact_modulus() : node_modulus_[static_cast<std::size_t>(node)];
}
template <int kDim>
void RestBody<kDim>::find_node_moduli(const fem::StrainMesh<kDim>& mesh) {
  if (material_.element.empty()) return;
  node_modulus_.assign(static_cast<std::size_t>(mesh.node_count()), 0);
  std::vector<double> count(node_modulus_.size());
  const auto nodes = static_cast<std::size_t>(fem::nodes_per_element(mesh.element));
  for (std::size_t i = 0; i < mesh.connectivity.size(); ++i) {
    const auto n = static_cast<std::size_t>(mesh.connectivity[i]);
    node_modulus_[n] += contact_modulus_of(material_.element[i / nodes]);
    count[n] += 1;
  }
  for (std::size_t n = 0; n < count.size(); ++n) node_modulus_[n] /= count[n];
}

template <int kDim>
Eigen::MatrixXd RestBody<kDim>::solve_all(const Eigen::MatrixXd& force_N) const {
  Eigen::MatrixXd reduced(assembly_.free_count(), force_N.cols()), u = Eigen::MatrixXd::Zero(size_, force_N.cols());
  for (int dof = 0; dof < size_; ++dof)
    if (const int q = assembly_.equation(dof); q >= 0) reduced.row(q) = force_N.row(dof);
  reduced = factor_.solve_all(reduced);
  for (int dof = 0; dof < size_; ++dof)
    if (const int q = assembly_.equation(dof); q >= 0) u.row(dof) = reduced.row(q);
  return u;
}

template <int kDim>
Eigen::VectorXd RestBody<kDim>::internal_force(const Eigen::VectorXd& u_m) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(size_);
  if (!std::isfinite(assembly_.evaluate(u_m, &force, nullptr)))
    throw ConfigError("elastic body: a probing displacement turns an element inside out; the mesh has flat elements");
  release_fixed(force);
  return force;
}

template <int kDim>
void RestBody<kDim>::release_fixed(Eigen::VectorXd& v) const {
  for (int dof = 0; dof < size_; ++dof)
    if (assembly_.equation(dof) < 0) v[dof] = 0;
}

template class RestBody<2>;
template class RestBody<3>;

}  // namespace palpate::elastic
