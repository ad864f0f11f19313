#include "config/fem/large_strain_assembly.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "config/scene/config_error.h"

namespace palpate::fem {

namespace {

constexpr int kMaxDofs = 81;  // H27

// Thickness stretch of a plane-stress point: the F33 that makes P33 = 0, by Newton from the isochoric value; the energy
// is convex in F33 there.
struct PlaneStressPoint {
  double energy = std::numeric_limits<double>::infinity();
  Gradient<2> stress = Gradient<2>::Zero();
  GradientSquare<2> stiffness = GradientSquare<2>::Zero();
};

struct FullPoint {
  double energy;
  Gradient<2> stress;
  GradientSquare<2> stiffness;
};
FullPoint full_point(const Gradient<2>& f, double shear, double bulk) {
  const VolumeRatio<2> v = volume_ratio(f);
  const DistortionEnergy<2> w = distortion_energy<2>(f, v, shear);
  const double p = bulk * (v.value - 1);
  return {w.value + 0.5 * p * (v.value - 1), w.slope + p * v.slope, energy_curvature(f, v, w, p, bulk)};
}

PlaneStressPoint plane_stress_point(Gradient<2> f, double shear, double bulk) {
  PlaneStressPoint out;
  const double area_ratio = f[0] * f[3] - f[1] * f[2];
  if (!(area_ratio > 0)) return out;
  f[4] = 1 / std::sqrt(area_ratio);
  FullPoint point = full_point(f, shear, bulk);
  for (int i = 0; i < 50 && std::abs(point.stress[4]) > 1e-14 * bulk; ++i) {
    const double step = -point.stress[4] / point.stiffness(4, 4);
    f[4] = std::max(0.2 * f[4], f[4] + step);
    point = full_point(f, shear, bulk);
  }
  out.energy = point.energy;
  out.stress = point.stress;
  out.stress[4] = 0;
  const Gradient<2> column = point.stiffness.col(4);
  out.stiffness = point.stiffness - column * column.transpose() / column[4];
  return out;
}

ElementModuli moduli_of(double young_Pa, double poisson, double point_bulk) {
  const double shear = young_Pa / (2 * (1 + poisson)), bulk = young_Pa / (3 * (1 - 2 * poisson));
  return {shear, bulk, std::min(bulk, point_bulk * shear)};
}

}  // namespace

template <int kDim>
struct LargeStrainAssembly<kDim>::ElementSums {
  double energy;
  Eigen::Matrix<double, kMaxDofs, 1> force;
  Eigen::Matrix<double, kMaxDofs, kMaxDofs, Eigen::RowMajor> stiffness;  // lower triangle
};

template <int kDim>
LargeStrainAssembly<kDim>::LargeStrainAssembly(const StrainMesh<kDim>& mesh, const StrainBody& body,
                                               std::vector<int> equation_of_dof)
    : tables_(element_tables<kDim>(mesh.element)),
      body_(body),
      connectivity_(mesh.connectivity),
      equation_(std::move(equation_of_dof)) {
  for (const int q : equation_) free_count_ = std::max(free_count_, q + 1);
  if (body.element.empty()) moduli_.push_back(moduli_of(body.youngs_modulus_Pa, body.poisson_ratio, body.point_bulk));
  for (const ElementMaterial& m : body.element)
    moduli_.push_back(moduli_of(m.youngs_modulus_Pa, m.poisson_ratio, body.point_bulk));
  place_points(mesh);
  place_nodes(mesh);
  find_pattern();
}

template <int kDim>
void LargeStrainAssembly<kDim>::place_points(const StrainMesh<kDim>& mesh) {
  using Square = Eigen::Matrix<double, kDim, kDim>;
  const bool ring = body_.kinematics == Kinematics::kAxisymmetric;
  for (int e = 0; e < mesh.element_count(); ++e) {
    Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(tables_.modes, tables_.modes);
    for (int g = 0; g < tables_.points; ++g) {
      Square jacobian = Square::Zero();  // dX_d / dparameter_k
      double radius = 0;
      const auto entry = [&](int a) { return static_cast<std::size_t>(g * tables_.nodes + a); };
      for (int a = 0; a < tables_.nodes; ++a) {
        const Point<kDim>& x = mesh.nodes_m[static_cast<std::size_t>(element_nodes(e)[a])];
        radius += tables_.shape[entry(a)] * x[0];
        for (int d = 0; d < kDim; ++d)
          for (int k = 0; k < kDim; ++k)
            jacobian(d, k) += x[static_cast<std::size_t>(d)] * tables_.gradient[entry(a)][static_cast<std::size_t>(k)];
      }
      const double determinant = jacobian.determinant();
      if (!(determinant > 0))
        throw ConfigError("large-strain mesh: element " + std::to_string(e) + " is inverted or flat");
      const Square inverse = jacobian.inverse();
      for (int a = 0; a < tables_.nodes; ++a) {
        Point<kDim> grad{};
        for (int d = 0; d < kDim; ++d)
          for (int k = 0; k < kDim; ++k)
            grad[static_cast<std::size_t>(d)] +=
                tables_.gradient[entry(a)][static_cast<std::size_t>(k)] * inverse(k, d);
        gradient_.push_back(grad);
        if (ring) hoop_.push_back(tables_.shape[entry(a)] / radius);
      }
      const double across = ring ? 2 * std::numbers::pi * radius : kDim == 2 ? body_.thickness_m : 1.0;
      const double volume = tables_.weight[static_cast<std::size_t>(g)] * determinant * across;
      weight_.push_back(volume);
      const double* modes = &tables_.pressure[static_cast<std::size_t>(g * tables_.modes)];
      for (int k = 0; k < tables_.modes; ++k)
        for (int l = 0; l < tables_.modes; ++l) mass(k, l) += volume * modes[k] * modes[l];
    }
    inverse_mass_.push_back(mass.inverse());
  }
}

template <int kDim>
void LargeStrainAssembly<kDim>::place_nodes(const StrainMesh<kDim>& mesh) {
  using Square = Eigen::Matrix<double, kDim, kDim>;
  for (int e = 0; e < mesh.element_count(); ++e)
    for (int n = 0; n < tables_.nodes; ++n) {
      const Point<kDim>* grad = &tables_.gradient_at_nodes[static_cast<std::size_t>(n * tables_.nodes)];
      Square jacobian = Square::Zero();
      for (int a = 0; a < tables_.nodes; ++a)
        for (int d = 0; d < kDim; ++d)
          for (int k = 0; k < kDim; ++k)
            jacobian(d, k) += mesh.nodes_m[static_cast<std::size_t>(element_nodes(e)[a])][static_cast<std::size_t>(d)] *
                              grad[a][static_cast<std::size_t>(k)];
      const bool collapsed = !(jacobian.determinant() > 1e-6 * std::pow(jacobian.norm(), kDim));
      const Square inverse = collapsed ? Square::Zero().eval() : jacobian.inverse().eval();
      for (int a = 0; a < tables_.nodes; ++a) {
        Point<kDim> x{};
        for (int d = 0; d < kDim; ++d)
          for (int k = 0; k < kDim; ++k)
            x[static_cast<std::size_t>(d)] += grad[a][static_cast<std::size_t>(k)] * inverse(k, d);
        node_gradient_.push_back(x);
      }
    }
}

template <int kDim>
bool LargeStrainAssembly<kDim>::unfolded(const Eigen::VectorXd& u) const {
  for (std::size_t row = 0; row < node_gradient_.size(); row += static_cast<std::size_t>(tables_.nodes)) {
    const int e = static_cast<int>(row / static_cast<std::size_t>(tables_.nodes * tables_.nodes));
    Eigen::Matrix<double, kDim, kDim> f = Eigen::Matrix<double, kDim, kDim>::Identity();
    for (int a = 0; a < tables_.nodes; ++a)
      for (int i = 0; i < kDim; ++i)
        for (int d = 0; d < kDim; ++d)
          f(i, d) += node_gradient_[row + static_cast<std::size_t>(a)][static_cast<std::size_t>(d)] *
                     u[element_nodes(e)[a] * kDim + i];
    if (!(f.determinant() > 0.02)) return false;
  }
  return true;
}

template <int kDim>
void LargeStrainAssembly<kDim>::find_pattern() {
  const int dofs = tables_.nodes * kDim, elements = static_cast<int>(inverse_mass_.size());
  std::vector<Eigen::Triplet<double>> entries;
  const auto for_pairs = [&](int e, const auto& visit) {
    for (int p = 0; p < dofs; ++p)
      for (int q = 0; q <= p; ++q)
        visit(equation(element_nodes(e)[p / kDim] * kDim + p % kDim),
              equation(element_nodes(e)[q / kDim] * kDim + q % kDim));
  };
  for (int e = 0; e < elements; ++e)
    for_pairs(e, [&](int row, int column) {
      if (row >= 0 && column >= 0) entries.emplace_back(std::max(row, column), std::min(row, column), 0.0);
    });
  pattern_.resize(free_count_, free_count_);
  pattern_.setFromTriplets(entries.begin(), entries.end());
  pattern_.makeCompressed();
  for (int e = 0; e < elements; ++e)
    for_pairs(e, [&](int row, int column) {
      if (row < 0 || column < 0) {
        value_index_.push_back(-1);
      } else {
        const double* value = &pattern_.coeffRef(std::max(row, column), std::min(row, column));
        value_index_.push_back(static_cast<int>(value - pattern_.valuePtr()));
      }
    });
  for (const NodeSpring& s : body_.spring) {
    const int row = equation(s.row), column = equation(s.column);
    const bool held = row < 0 || column < 0;
    spring_index_.push_back(held ? -1
                                 : static_cast<int>(&pattern_.coeffRef(std::max(row, column), std::min(row, column)) -
                                                    pattern_.valuePtr()));
  }
}

template <int kDim>
Gradient<kDim> LargeStrainAssembly<kDim>::gradient_at(int e, int g, const Eigen::VectorXd& u) const {
  Gradient<kDim> f = Gradient<kDim>::Zero();
  for (int d = 0; d < kDim; ++d) f[d * kDim + d] = 1;
  if constexpr (kDim == 2) f[4] = 1;
  const std::size_t first = point_index(e, g) * static_cast<std::size_t>(tables_.nodes);
  for (int a = 0; a < tables_.nodes; ++a) {
    const int node = element_nodes(e)[a];
    const Point<kDim>& grad = gradient_[first + static_cast<std::size_t>(a)];
    for (int i = 0; i < kDim; ++i)
      for (int d = 0; d < kDim; ++d) f[i * kDim + d] += grad[static_cast<std::size_t>(d)] * u[node * kDim + i];
    if constexpr (kDim == 2)
      if (!hoop_.empty()) f[4] += hoop_[first + static_cast<std::size_t>(a)] * u[node * kDim];
  }
  return f;
}

// Adds w B^T stress. A displacement component touches only its own row of F, and F33 on a ring.
template <int kDim>
void LargeStrainAssembly<kDim>::add_force(int e, int g, const Gradient<kDim>& stress, ElementSums& out) const {
  const std::size_t first = point_index(e, g) * static_cast<std::size_t>(tables_.nodes);
  const double w = weight_[point_index(e, g)];
  const bool ring = !hoop_.empty();
  for (int a = 0; a < tables_.nodes; ++a) {
    const Point<kDim>& grad = gradient_[first + static_cast<std::size_t>(a)];
    for (int i = 0; i < kDim; ++i) {
      double force =
          ring && i == 0 ? hoop_[first + static_cast<std::size_t>(a)] * stress[kGradientSize<kDim> - 1] : 0.0;
      for (int d = 0; d < kDim; ++d) force += grad[static_cast<std::size_t>(d)] * stress[i * kDim + d];
      out.force[a * kDim + i] += w * force;
    }
  }
}

// Adds w B^T stiffness B.
template <int kDim>
void LargeStrainAssembly<kDim>::add_stiffness(int e, int g, const GradientSquare<kDim>& stiffness,
                                              ElementSums& out) const {
  const std::size_t first = point_index(e, g) * static_cast<std::size_t>(tables_.nodes);
  const double w = weight_[point_index(e, g)];
  const int dofs = tables_.nodes * kDim;
  const auto row = [&](int p, int d) {
    return gradient_[first + static_cast<std::size_t>(p / kDim)][static_cast<std::size_t>(d)];
  };
  const bool ring = !hoop_.empty();
  Eigen::Matrix<double, kGradientSize<kDim>, kMaxDofs> product;  // stiffness B
  for (int p = 0; p < dofs; ++p) {
    const int i = p % kDim;
    const double hoop = ring && i == 0 ? hoop_[first + static_cast<std::size_t>(p / kDim)] : 0.0;
    auto column = product.col(p);
    column.setZero();
    for (int d = 0; d < kDim; ++d) column += w * row(p, d) * stiffness.col(i * kDim + d);
    if (hoop != 0) column += w * hoop * stiffness.col(kGradientSize<kDim> - 1);
  }
  for (int p = 0; p < dofs; ++p) {
    const int i = p % kDim;
    const double hoop = ring && i == 0 ? hoop_[first + static_cast<std::size_t>(p / kDim)] : 0.0;
    for (int q = 0; q <= p; ++q) {
      double sum = kDim == 2 ? hoop * product(kGradientSize<kDim> - 1, q) : 0.0;
      for (int d = 0; d < kDim; ++d) sum += row(p, d) * product(i * kDim + d, q);
      out.stiffness(p, q) += sum;
    }
  }
}

template <int kDim>
bool LargeStrainAssembly<kDim>::evaluate_element(int e, const Eigen::VectorXd& u, bool tangent,
                                                 ElementSums& out) const {
  const int dofs = tables_.nodes * kDim;
  const auto [shear_Pa, bulk_Pa, point_bulk_Pa] = moduli(e);
  const double projected_Pa = bulk_Pa - point_bulk_Pa;
  out.energy = 0;
  out.force.head(dofs).setZero();
  if (tangent) out.stiffness.topLeftCorner(dofs, dofs).setZero();
  if constexpr (kDim == 2) {
    if (body_.kinematics == Kinematics::kPlaneStress) {
      for (int g = 0; g < tables_.points; ++g) {
        const PlaneStressPoint point = plane_stress_point(gradient_at(e, g, u), shear_Pa, bulk_Pa);
        if (!std::isfinite(point.energy)) return false;
        out.energy += weight_[point_index(e, g)] * point.energy;
        add_force(e, g, point.stress, out);
        if (tangent) add_stiffness(e, g, point.stiffness, out);
      }
      return true;
    }
  }
  constexpr int kMaxPoints = 27, kMaxModes = 4;
  Gradient<kDim> f[kMaxPoints];
  VolumeRatio<kDim> v[kMaxPoints];
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxModes, 1> moment = Eigen::VectorXd::Zero(tables_.modes);
  const auto mode = [&](int g, int k) { return tables_.pressure[static_cast<std::size_t>(g * tables_.modes + k)]; };
  for (int g = 0; g < tables_.points; ++g) {
    f[g] = gradient_at(e, g, u);
    v[g] = volume_ratio(f[g]);
    if (!(v[g].value > 0)) return false;
    for (int k = 0; k < tables_.modes; ++k) moment[k] += weight_[point_index(e, g)] * mode(g, k) * v[g].value;
  }
  const Eigen::MatrixXd& inverse_mass = inverse_mass_[static_cast<std::size_t>(e)];
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxModes, 1> projected = inverse_mass * moment;
  Eigen::Matrix<double, kMaxDofs, kMaxModes> mode_slope;  // d moment_k / d u
  if (tangent) mode_slope.topLeftCorner(dofs, tables_.modes).setZero();
  for (int g = 0; g < tables_.points; ++g) {
    const DistortionEnergy<kDim> w = distortion_energy<kDim>(f[g], v[g], shear_Pa);
    double dilatation = -1;
    for (int k = 0; k < tables_.modes; ++k) dilatation += projected[k] * mode(g, k);
    const double own = v[g].value - 1, volume = weight_[point_index(e, g)];
    const double p = projected_Pa * dilatation + point_bulk_Pa * own;
    out.energy += volume * (w.value + 0.5 * projected_Pa * dilatation * dilatation + 0.5 * point_bulk_Pa * own * own);
    add_force(e, g, w.slope + p * v[g].slope, out);
    if (!tangent) continue;
    add_stiffness(e, g, energy_curvature(f[g], v[g], w, p, point_bulk_Pa), out);
    const std::size_t first = point_index(e, g) * static_cast<std::size_t>(tables_.nodes);
    for (int q = 0; q < dofs; ++q) {
      const std::size_t a = first + static_cast<std::size_t>(q / kDim);
      double slope = 0;
      for (int d = 0; d < kDim; ++d)
        slope += gradient_[a][static_cast<std::size_t>(d)] * v[g].slope[q % kDim * kDim + d];
      if (kDim == 2 && !hoop_.empty() && q % kDim == 0) slope += hoop_[a] * v[g].slope[kGradientSize<kDim> - 1];
      for (int k = 0; k < tables_.modes; ++k) mode_slope(q, k) += volume * mode(g, k) * slope;
    }
  }
  if (tangent) {
    const auto slope = mode_slope.topLeftCorner(dofs, tables_.modes);
    const Eigen::MatrixXd scaled = projected_Pa * slope * inverse_mass;
    for (int p = 0; p < dofs; ++p)
      for (int q = 0; q <= p; ++q) out.stiffness(p, q) += scaled.row(p).dot(slope.row(q));
  }
  return true;
}

template <int kDim>
double LargeStrainAssembly<kDim>::evaluate(const Eigen::VectorXd& u, Eigen::VectorXd* force,
                                           Eigen::SparseMatrix<double>* tangent) const {
  ElementSums sums;
  double energy = 0;
  const int dofs = tables_.nodes * kDim;
  std::size_t place = 0;
  for (int e = 0; e < static_cast<int>(inverse_mass_.size()); ++e) {
    if (!evaluate_element(e, u, tangent != nullptr, sums)) return std::numeric_limits<double>::infinity();
    energy += sums.energy;
    if (force != nullptr)
      for (int p = 0; p < dofs; ++p) (*force)[element_nodes(e)[p / kDim] * kDim + p % kDim] += sums.force[p];
    if (tangent == nullptr) continue;
    for (int p = 0; p < dofs; ++p)
      for (int q = 0; q <= p; ++q) {
        // A collapsed edge repeats a node: a pair of its unknowns then stands for both orders of the same entry.
        const int index = value_index_[place++];
        if (index < 0) continue;
        const bool doubled = p != q && element_nodes(e)[p / kDim] == element_nodes(e)[q / kDim] && p % kDim == q % kDim;
        tangent->valuePtr()[index] += (doubled ? 2 : 1) * sums.stiffness(p, q);
      }
  }
  return energy + add_springs(u, force, tangent);
}

template <int kDim>
double LargeStrainAssembly<kDim>::add_springs(const Eigen::VectorXd& u, Eigen::VectorXd* force,
                                              Eigen::SparseMatrix<double>* tangent) const {
  double energy = 0;
  for (std::size_t i = 0; i < body_.spring.size(); ++i) {
    const auto& [row, column, k] = body_.spring[i];
    energy += (row == column ? 0.5 : 1) * k * u[row] * u[column];
    if (force != nullptr) {
      (*force)[row] += k * u[column];
      if (row != column) (*force)[column] += k * u[row];
    }
    if (tangent != nullptr && spring_index_[i] >= 0) tangent->valuePtr()[spring_index_[i]] += k;
  }
  return energy;
}

template <int kDim>
Eigen::VectorXd LargeStrainAssembly<kDim>::spring_force(const Eigen::VectorXd& u) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(u.size());
  add_springs(u, &force, nullptr);
  return force;
}

template <int kDim>
void LargeStrainAssembly<kDim>::add_nodes_block(const std::vector<int>& nodes, const std::vector<double>& weights,
                                                const Eigen::Matrix<double, kDim, kDim>& block,
                                                Eigen::SparseMatrix<double>& tangent) const {
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t b = 0; b < nodes.size(); ++b)
      for (int i = 0; i < kDim; ++i)
        for (int j = 0; j < kDim; ++j) {
          const int row = equation(nodes[a] * kDim + i), column = equation(nodes[b] * kDim + j);
          if (row >= column && column >= 0) tangent.coeffRef(row, column) += weights[a] * weights[b] * block(i, j);
        }
}

template class LargeStrainAssembly<2>;
template class LargeStrainAssembly<3>;

}  // namespace palpate::fem
