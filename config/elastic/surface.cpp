#include "config/elastic/surface.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace palpate::elastic {

namespace {

struct Parabolas {
  std::array<double, 3> value, slope, curvature;
};
Parabolas parabolas(double x) {
  return {{0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)}, {x - 0.5, -2 * x, x + 0.5}, {1, -2, 1}};
}

FacetShape edge_shape(double x) {
  FacetShape s;
  const Parabolas p = parabolas(x);
  for (std::size_t i = 0; i < 3; ++i) {
    s.value[i] = p.value[i];
    s.slope[i] = {p.slope[i], 0};
    s.curvature[i] << p.curvature[i], 0, 0, 0;
  }
  return s;
}

FacetShape square_shape(const FacetPlace& at) {
  FacetShape s;
  const Parabolas x = parabolas(at[0]), y = parabolas(at[1]);
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = 3 * j + i;
      s.value[k] = x.value[i] * y.value[j];
      s.slope[k] = {x.slope[i] * y.value[j], x.value[i] * y.slope[j]};
      const double mixed = x.slope[i] * y.slope[j];
      s.curvature[k] << x.curvature[i] * y.value[j], mixed, mixed, x.value[i] * y.curvature[j];
    }
  return s;
}

FacetShape triangle_shape(const FacetPlace& at) {
  FacetShape s;
  const std::array<double, 3> l = {1 - at[0] - at[1], at[0], at[1]};
  const std::array<Eigen::Vector2d, 3> grad = {Eigen::Vector2d{-1, -1}, {1, 0}, {0, 1}};
  for (std::size_t i = 0; i < 3; ++i) {
    s.value[i] = l[i] * (2 * l[i] - 1);
    s.slope[i] = (4 * l[i] - 1) * grad[i];
    s.curvature[i] = 4 * grad[i] * grad[i].transpose();
    const std::size_t j = (i + 1) % 3;
    s.value[3 + i] = 4 * l[i] * l[j];
    s.slope[3 + i] = 4 * (l[i] * grad[j] + l[j] * grad[i]);
    s.curvature[3 + i] = 4 * (grad[i] * grad[j].transpose() + grad[j] * grad[i].transpose());
  }
  return s;
}

std::vector<FacetPoint> tensor_rule(bool plane) {
  const double g = std::sqrt(0.6);
  const std::array<double, 3> place = {-g, 0, g}, weight = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  std::vector<FacetPoint> rule;
  for (std::size_t j = 0; j < (plane ? 3U : 1U); ++j)
    for (std::size_t i = 0; i < 3; ++i)
      rule.push_back({{place[i], plane ? place[j] : 0}, weight[i] * (plane ? weight[j] : 1)});
  return rule;
}

// Six points, degree 4 (Strang & Fix 1973).
std::vector<FacetPoint> triangle_rule() {
  std::vector<FacetPoint> rule;
  const std::array<double, 2> corner = {0.091576213509771, 0.445948490915965},
                              weight = {0.109951743655322, 0.223381589678011};
  for (std::size_t k = 0; k < 2; ++k) {
    const double a = corner[k], far = 1 - 2 * a, w = 0.5 * weight[k];
    rule.push_back({{a, a}, w});
    rule.push_back({{far, a}, w});
    rule.push_back({{a, far}, w});
  }
  return rule;
}

}  // namespace

FacetShape facet_shape(std::size_t nodes, const FacetPlace& at) {
  return nodes == 3 ? edge_shape(at[0]) : nodes == 6 ? triangle_shape(at) : square_shape(at);
}

FacetPlace clamp_to_facet(std::size_t nodes, const FacetPlace& at) {
  if (nodes != 6) return {std::clamp(at[0], -1.0, 1.0), nodes == 3 ? 0 : std::clamp(at[1], -1.0, 1.0)};
  FacetPlace p = at.cwiseMax(0.0);
  if (p.sum() > 1) {  // onto the third edge
    const double along = std::clamp(0.5 * (1 + p[1] - p[0]), 0.0, 1.0);
    p = {1 - along, along};
  }
  return p;
}

FacetPlace facet_centre(std::size_t nodes) { return nodes == 6 ? FacetPlace(1.0 / 3, 1.0 / 3) : FacetPlace(0, 0); }

const std::vector<FacetPoint>& facet_rule(std::size_t nodes) {
  static const std::vector<FacetPoint> edge = tensor_rule(false), square = tensor_rule(true),
                                       triangle = triangle_rule();
  return nodes == 3 ? edge : nodes == 6 ? triangle : square;
}

template <int kDim>
Vector<kDim> Surface<kDim>::rest(int node) const {
  Vector<kDim> x;
  for (int d = 0; d < kDim; ++d) x[d] = nodes_m_[static_cast<std::size_t>(node)][static_cast<std::size_t>(d)];
  return x;
}

namespace {

// Columns: tangents along the parameters. The normal of an edge is its tangent turned to the right.
template <int kDim>
Vector<kDim> area_normal(const Eigen::Matrix<double, kDim, 2>& tangent) {
  if constexpr (kDim == 2)
    return {tangent(1, 0), -tangent(0, 0)};
  else
    return tangent.col(0).cross(tangent.col(1));
}

}  // namespace

template <int kDim>
Vector<kDim> Surface<kDim>::normal(const Facet& facet, const FacetShape& shape) const {
  Eigen::Matrix<double, kDim, 2> tangent = Eigen::Matrix<double, kDim, 2>::Zero();
  for (std::size_t a = 0; a < facet.nodes.size(); ++a) tangent += rest(facet.nodes[a]) * shape.slope[a].transpose();
  return facet.side * area_normal<kDim>(tangent).normalized();
}

// The parallelogram of the tangents stays across both: n . t = 0 along either, differentiated.
template <int kDim>
Vector<kDim> Surface<kDim>::turn(const Point& point, const Eigen::VectorXd& u) const {
  const Facet& facet = facets_[static_cast<std::size_t>(point.facet)];
  Eigen::Matrix<double, kDim, 2> tangent = Eigen::Matrix<double, kDim, 2>::Zero(), moved = tangent;
  for (std::size_t a = 0; a < facet.nodes.size(); ++a) {
    tangent += rest(facet.nodes[a]) * point.shape.slope[a].transpose();
    moved += u.segment<kDim>(kDim * facet.nodes[a]) * point.shape.slope[a].transpose();
  }
  constexpr int kAlong = kDim - 1;
  const Eigen::Matrix<double, kDim, kAlong> t = tangent.template leftCols<kAlong>();
  const Eigen::Matrix<double, kAlong, 1> slope = moved.template leftCols<kAlong>().transpose() * point.normal;
  return -t * (t.transpose() * t).inverse() * slope;
}

template <int kDim>
void Surface<kDim>::add_points(int index, double thickness_m, std::vector<Eigen::Triplet<double>>& mass) {
  const Facet& facet = facets_[static_cast<std::size_t>(index)];
  for (const FacetPoint& q : facet_rule(facet.nodes.size())) {
    Point point{index, facet_shape(facet.nodes.size(), q.at), Vector<kDim>::Zero(), {}, 0};
    Eigen::Matrix<double, kDim, 2> tangent = Eigen::Matrix<double, kDim, 2>::Zero();
    for (std::size_t a = 0; a < facet.nodes.size(); ++a) {
      point.x_m += point.shape.value[a] * rest(facet.nodes[a]);
      tangent += rest(facet.nodes[a]) * point.shape.slope[a].transpose();
    }
    const Vector<kDim> across = area_normal<kDim>(tangent);
    point.area_m2 = q.weight * across.norm() * thickness_m;
    point.normal = facet.side * across.normalized();
    for (std::size_t a = 0; a < facet.nodes.size(); ++a)
      for (std::size_t b = 0; b < facet.nodes.size(); ++b)
        mass.emplace_back(facet.nodes[a], facet.nodes[b], point.area_m2 * point.shape.value[a] * point.shape.value[b]);
    points_.push_back(std::move(point));
  }
}

template <int kDim>
Surface<kDim>::Surface(const fem::StrainMesh<kDim>& mesh, double thickness_m) : nodes_m_(mesh.nodes_m) {
  at_node_.resize(mesh.nodes_m.size());
  const int per_element = fem::nodes_per_element(mesh.element);
  std::vector<Eigen::Triplet<double>> mass;
  for (fem::BoundaryFacet& found : fem::boundary_facets(mesh)) {
    Vector<kDim> inside = Vector<kDim>::Zero();
    for (int a = 0; a < per_element; ++a)
      inside += rest(mesh.connectivity[static_cast<std::size_t>(found.element * per_element + a)]) / per_element;
    Facet facet{std::move(found.nodes), 1};
    const FacetShape middle = facet_shape(facet.nodes.size(), facet_centre(facet.nodes.size()));
    Vector<kDim> centre = Vector<kDim>::Zero();
    for (std::size_t a = 0; a < facet.nodes.size(); ++a) centre += middle.value[a] * rest(facet.nodes[a]);
    if (normal(facet, middle).dot(centre - inside) < 0) facet.side = -1;
    const int index = static_cast<int>(facets_.size());
    for (const int n : facet.nodes) at_node_[static_cast<std::size_t>(n)].push_back(index);
    facets_.push_back(std::move(facet));
    add_points(index, thickness_m, mass);
  }
  mass_.resize(static_cast<Eigen::Index>(nodes_m_.size()), static_cast<Eigen::Index>(nodes_m_.size()));
  mass_.setFromTriplets(mass.begin(), mass.end());
  Vector<kDim> low = rest(0), high = rest(0);
  for (int n = 0; n < mesh.node_count(); ++n) {
    low = low.cwiseMin(rest(n));
    high = high.cwiseMax(rest(n));
  }
  extent_m_ = (high - low).norm();
}

template <int kDim>
Eigen::VectorXd Surface<kDim>::mass_times(const Eigen::VectorXd& u) const {
  Eigen::VectorXd out(u.size());
  const Eigen::Index n = mass_.cols();
  Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, kDim, Eigen::RowMajor>> from(u.data(), n, kDim);
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kDim, Eigen::RowMajor>> to(out.data(), n, kDim);
  to = mass_ * from;
  return out;
}

template <int kDim>
double Surface<kDim>::edge_m(int node) const {
  double sum = 0;
  int count = 0;
  for (const int f : facets_at(node)) {
    const std::vector<int>& n = facets_[static_cast<std::size_t>(f)].nodes;
    const auto add = [&](std::size_t a, std::size_t b) {
      sum += (rest(n[a]) - rest(n[b])).norm();
      ++count;
    };
    if (n.size() == 3) add(0, 2);
    if (n.size() == 6)
      for (std::size_t i = 0; i < 3; ++i) add(i, (i + 1) % 3);
    if (n.size() == 9)
      for (const auto& [a, b] : {std::pair{0, 2}, {2, 8}, {8, 6}, {6, 0}})
        add(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
  }
  return count > 0 ? sum / count : 0;
}

template class Surface<2>;
template class Surface<3>;

}  // namespace palpate::elastic
