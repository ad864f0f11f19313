#include "config/fem/tet_element.h"

#include <algorithm>
#include <cmath>

#include "config/index.h"

namespace palpate {

namespace {

Eigen::Index row(std::size_t i) { return static_cast<Eigen::Index>(i); }

// The four points with one coordinate b and three equal ones a; the six with two a and two b.
void add_corner_orbit(std::vector<TetPoint>& rule, double a, double b, double weight) {
  for (std::size_t k = 0; k < 4; ++k) {
    TetPoint p{{a, a, a, a}, weight};
    p.lambda[k] = b;
    rule.push_back(p);
  }
}
void add_edge_orbit(std::vector<TetPoint>& rule, double a, double b, double weight) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      TetPoint p{{b, b, b, b}, weight};
      p.lambda[i] = p.lambda[j] = a;
      rule.push_back(p);
    }
}

// Derivative of lambda k along parent axis d: lambda 0 is 1 - x - y - z.
double lambda_slope(std::size_t k, std::size_t d) { return k == 0 ? -1.0 : (k == d + 1 ? 1.0 : 0.0); }

const std::vector<TetPoint>& rule_of(const TetMesh& mesh, const Tet& tet) {
  return is_curved(mesh, tet) ? tet_rule_14() : tet_rule_4();
}

// One pair of nodes: K_ij = G (g_i . g_j) I + G g_j g_i' + c g_i g_j', c = K - 2G/3 (c = -2G/3: deviatoric part only).
void add_pair(TetStiffness& stiffness, Eigen::Index i, Eigen::Index j, const Eigen::Vector3d& gi,
              const Eigen::Vector3d& gj, double shear, double dilatation) {
  auto block = stiffness.block<3, 3>(3 * i, 3 * j);
  const double along = shear * gi.dot(gj);
  for (Eigen::Index a = 0; a < 3; ++a)
    for (Eigen::Index b = 0; b < 3; ++b) block(a, b) += shear * gj(a) * gi(b) + dilatation * gi(a) * gj(b);
  for (Eigen::Index a = 0; a < 3; ++a) block(a, a) += along;
}

}  // namespace

const std::vector<TetPoint>& tet_rule_4() {
  static const std::vector<TetPoint> rule = [] {
    std::vector<TetPoint> r;
    const double a = (5.0 - std::sqrt(5.0)) / 20.0;
    add_corner_orbit(r, a, 1.0 - 3.0 * a, 0.25);
    return r;
  }();
  return rule;
}

const std::vector<TetPoint>& tet_rule_14() {
  static const std::vector<TetPoint> rule = [] {
    std::vector<TetPoint> r;
    const double a1 = 0.31088591926330060980, a2 = 0.092735250310891226402, a3 = 0.045503704125649649492;
    add_corner_orbit(r, a1, 1.0 - 3.0 * a1, 0.11268792571801585080);
    add_corner_orbit(r, a2, 1.0 - 3.0 * a2, 0.073493043116361949544);
    add_edge_orbit(r, a3, 0.5 - a3, 0.042546020777081466438);
    return r;
  }();
  return rule;
}

TetValues tet_shape(const Tet& tet, const std::array<double, 4>& lambda) {
  TetValues n = TetValues::Zero();
  for (std::size_t k = 0; k < 4; ++k) n(row(k)) = lambda[k];
  for (std::size_t e = 0; e < 6; ++e) {
    if (tet.node[4 + e] < 0) continue;
    const std::size_t i = at(kTetEdge[e][0]), j = at(kTetEdge[e][1]);
    const double bubble = 4.0 * lambda[i] * lambda[j];
    n(row(4 + e)) = bubble;
    n(row(i)) -= 0.5 * bubble;
    n(row(j)) -= 0.5 * bubble;
  }
  return n;
}

TetGradients tet_shape_gradients(const Tet& tet, const std::array<double, 4>& lambda) {
  TetGradients g = TetGradients::Zero();
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t k = 0; k < 4; ++k) g(row(k), row(d)) = lambda_slope(k, d);
    for (std::size_t e = 0; e < 6; ++e) {
      if (tet.node[4 + e] < 0) continue;
      const std::size_t i = at(kTetEdge[e][0]), j = at(kTetEdge[e][1]);
      const double slope = 4.0 * (lambda_slope(i, d) * lambda[j] + lambda[i] * lambda_slope(j, d));
      g(row(4 + e), row(d)) = slope;
      g(row(i), row(d)) -= 0.5 * slope;
      g(row(j), row(d)) -= 0.5 * slope;
    }
  }
  return g;
}

TetMapping map_tet(const TetMesh& mesh, const Tet& tet, const std::array<double, 4>& lambda) {
  const TetGradients parent = tet_shape_gradients(tet, lambda);
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();  // row d: derivative of position along parent axis d
  for (std::size_t k = 0; k < 10; ++k) {
    if (tet.node[k] < 0) continue;
    const Vec3 p = mesh.node_m[at(tet.node[k])];
    for (Eigen::Index d = 0; d < 3; ++d) {
      jacobian(d, 0) += parent(row(k), d) * p.x;
      jacobian(d, 1) += parent(row(k), d) * p.y;
      jacobian(d, 2) += parent(row(k), d) * p.z;
    }
  }
  return {parent * jacobian.inverse().transpose(), jacobian.determinant()};
}

bool is_curved(const TetMesh& mesh, const Tet& tet) {
  for (std::size_t e = 0; e < 6; ++e) {
    if (tet.node[4 + e] < 0) continue;
    const Vec3 a = mesh.node_m[at(tet.node[at(kTetEdge[e][0])])], b = mesh.node_m[at(tet.node[at(kTetEdge[e][1])])];
    if (norm(mesh.node_m[at(tet.node[4 + e])] - 0.5 * (a + b)) > 1e-9 * norm(b - a)) return true;
  }
  return false;
}

double least_jacobian_ratio(const TetMesh& mesh, const Tet& tet) {
  if (!is_curved(mesh, tet)) return 1.0;
  const double straight = 6.0 * corner_volume_m3(mesh, tet);
  double least = 1e300;
  for (const TetPoint& p : tet_rule_14()) least = std::min(least, map_tet(mesh, tet, p.lambda).determinant_m3);
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<double, 4> corner{};
    corner[k] = 1.0;
    least = std::min(least, map_tet(mesh, tet, corner).determinant_m3);
  }
  return least / straight;
}

TetStiffness tet_stiffness(const TetMesh& mesh, const Tet& tet, const FemMaterial& material) {
  const double shear = material.young_Pa / (2.0 * (1.0 + material.poisson));
  const double bulk = material.young_Pa / (3.0 * (1.0 - 2.0 * material.poisson));
  const bool mean_dilatation = material.poisson > kMeanDilatationAbove;
  const double dilatation = (mean_dilatation ? 0.0 : bulk) - 2.0 / 3.0 * shear;
  TetStiffness stiffness = TetStiffness::Zero();
  TetGradients mean = TetGradients::Zero();  // volume times the mean gradient: the row b of the mean dilatation
  double volume = 0;
  for (const TetPoint& p : rule_of(mesh, tet)) {
    const TetMapping m = map_tet(mesh, tet, p.lambda);
    const double w = p.weight * m.determinant_m3 / 6.0;
    volume += w;
    mean += w * m.gradient_1pm;
    for (Eigen::Index i = 0; i < 10; ++i)
      for (Eigen::Index j = 0; j < 10; ++j)
        if (tet.node[static_cast<std::size_t>(i)] >= 0 && tet.node[static_cast<std::size_t>(j)] >= 0)
          add_pair(stiffness, i, j, m.gradient_1pm.row(i).transpose(), m.gradient_1pm.row(j).transpose(), w * shear,
                   w * dilatation);
  }
  if (mean_dilatation)
    for (Eigen::Index i = 0; i < 10; ++i)
      for (Eigen::Index j = 0; j < 10; ++j)
        stiffness.block<3, 3>(3 * i, 3 * j) += (bulk / volume) * mean.row(i).transpose() * mean.row(j);
  return stiffness;
}

}  // namespace palpate
