#include "config/elastic/contact_places.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "config/scene/config_error.h"

namespace palpate::elastic {

namespace {

constexpr int kSettleSteps = 30;
constexpr double kApartEdges = 4;
constexpr std::size_t kPlacesPerTool = 2;

template <int kDim>
Vector<kDim> eigen(const fem::Point<kDim>& p) {
  Vector<kDim> v;
  for (int d = 0; d < kDim; ++d) v[d] = p[static_cast<std::size_t>(d)];
  return v;
}

}  // namespace

template <int kDim>
PlaceFinder<kDim>::PlaceFinder(const ElasticBody<kDim>& body, std::vector<fem::RigidTool> tools)
    : body_(body), tools_(std::move(tools)) {
  for (const fem::RigidTool& tool : tools_)
    if (tool.shape != fem::RigidShape::kBall && tool.shape != fem::RigidShape::kPlane)
      throw ConfigError("elastic body: the static solver knows balls and planes only");
  const Surface<kDim>& surface = body_.rest->surface();
  carried_m_.resize(body_.self.self_mpN.size());
  for (const int node : body_.self.nodes) {
    std::vector<int> around;
    for (const int f : surface.facets_at(node))
      for (const int n : surface.facets()[static_cast<std::size_t>(f)].nodes)
        if (n != node && body_.self.known(n)) around.push_back(n);
    neighbours_.push_back(std::move(around));
  }
}

template <int kDim>
Vector<kDim> PlaceFinder<kDim>::displacement(int node, const Eigen::VectorXd& q) const {
  Vector<kDim> u = body_.modes.phi_1pm.block(node * kDim, 0, kDim, body_.soft) * q;
  for (int a = 0; a < body_.soft; ++a)
    for (int b = a; b < body_.soft; ++b)
      u += (a == b ? 0.5 : 1.0) * q[a] * q[b] *
           body_.maps.theta_1pm3[pair_place(a, b, body_.soft)].template segment<kDim>(node * kDim);
  return u;
}

template <int kDim>
void PlaceFinder<kDim>::carry(const std::vector<int>& nodes, const Eigen::VectorXd& q) {
  for (const int node : nodes)
    carried_m_[static_cast<std::size_t>(node)] = body_.rest->surface().rest(node) + displacement(node, q);
}

template <int kDim>
fem::Gap<kDim> PlaceFinder<kDim>::gap(int tool, const Vector<kDim>& x_m) const {
  fem::Point<kDim> p;
  for (int d = 0; d < kDim; ++d) p[static_cast<std::size_t>(d)] = x_m[d] - origin_m_[static_cast<std::size_t>(tool)][d];
  return fem::gap_of<kDim>(tools_[static_cast<std::size_t>(tool)], p);
}

template <int kDim>
double PlaceFinder<kDim>::gap_on_facet(int tool, int facet, const FacetPlace& at, Eigen::Vector2d* slope,
                                       Eigen::Matrix2d* curvature) const {
  const std::vector<int>& nodes = body_.rest->surface().facets()[static_cast<std::size_t>(facet)].nodes;
  const FacetShape shape = facet_shape(nodes.size(), at);
  Vector<kDim> x = Vector<kDim>::Zero();
  Eigen::Matrix<double, kDim, 2> tangent = Eigen::Matrix<double, kDim, 2>::Zero();
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    x += shape.value[a] * carried_m_[static_cast<std::size_t>(nodes[a])];
    tangent += carried_m_[static_cast<std::size_t>(nodes[a])] * shape.slope[a].transpose();
  }
  const fem::Gap<kDim> g = gap(tool, x);
  if (slope == nullptr) return g.value_m;
  const Vector<kDim> normal = eigen<kDim>(g.normal);
  *slope = tangent.transpose() * normal;
  Eigen::Matrix<double, kDim, kDim> bend;
  for (int d = 0; d < kDim; ++d) bend.row(d) = eigen<kDim>(g.curvature_per_m[static_cast<std::size_t>(d)]);
  *curvature = tangent.transpose() * bend * tangent;
  for (std::size_t a = 0; a < nodes.size(); ++a)
    *curvature += normal.dot(carried_m_[static_cast<std::size_t>(nodes[a])]) * shape.curvature[a];
  if (nodes.size() == 3) (*curvature)(1, 1) = 1;
  return g.value_m;
}

template <int kDim>
double PlaceFinder<kDim>::settle(int tool, int facet, FacetPlace& at) const {
  const std::size_t nodes = body_.rest->surface().facets()[static_cast<std::size_t>(facet)].nodes.size();
  Eigen::Vector2d slope;
  Eigen::Matrix2d curvature;
  double best = gap_on_facet(tool, facet, at, &slope, &curvature);
  for (int i = 0; i < kSettleSteps; ++i) {
    // Toward a minimum also where the surface curves the other way: eigenvalues by their size, not below a hundredth.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> frame(curvature);
    const Eigen::Vector2d size =
        frame.eigenvalues().cwiseAbs().cwiseMax(1e-2 * frame.eigenvalues().cwiseAbs().maxCoeff() + 1e-30);
    Eigen::Vector2d step =
        -(frame.eigenvectors() * (frame.eigenvectors().transpose() * slope).cwiseQuotient(size).matrix());
    double next = best;
    FacetPlace trial = at;
    for (int cut = 0; cut < 20; ++cut, step *= 0.5) {
      trial = clamp_to_facet(nodes, at + step);
      next = gap_on_facet(tool, facet, trial, nullptr, nullptr);
      if (next < best) break;
    }
    if (!(next < best)) break;
    const bool still = (trial - at).norm() < 1e-12;
    at = trial;
    best = gap_on_facet(tool, facet, at, &slope, &curvature);
    if (still) break;
  }
  return best;
}

template <int kDim>
std::vector<int> PlaceFinder<kDim>::minima(int tool) const {
  const std::vector<int>& nodes = body_.self.nodes;
  std::vector<std::pair<double, int>> found;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto height = [&](int n) { return gap(tool, carried_m_[static_cast<std::size_t>(n)]).value_m; };
    const double own = height(nodes[i]);
    if (std::all_of(neighbours_[i].begin(), neighbours_[i].end(), [&](int n) { return own <= height(n); }))
      found.emplace_back(own, nodes[i]);
  }
  std::sort(found.begin(), found.end());
  const Surface<kDim>& surface = body_.rest->surface();
  std::vector<int> kept;
  for (const auto& [height, node] : found) {
    const bool apart = std::all_of(kept.begin(), kept.end(), [&, n = node](int k) {
      return (surface.rest(k) - surface.rest(n)).norm() > kApartEdges * surface.edge_m(n);
    });
    if (apart && kept.size() < kPlacesPerTool) kept.push_back(node);
  }
  return kept;
}

template <int kDim>
ContactPlace<kDim> PlaceFinder<kDim>::describe(int tool, int facet, const FacetPlace& at,
                                               const Eigen::VectorXd& q) const {
  const Surface<kDim>& surface = body_.rest->surface();
  const auto& f = surface.facets()[static_cast<std::size_t>(facet)];
  const FacetShape shape = facet_shape(f.nodes.size(), at);
  const int s = body_.soft;
  const Eigen::Index linear = body_.modes.lambda_Npm3.size() - s;
  ContactPlace<kDim> place;
  place.tool = tool;
  place.facet = facet;
  place.at = at;
  place.rest_m = place.x_m = Vector<kDim>::Zero();
  place.slide = Eigen::MatrixXd::Zero(kDim, s);
  place.linear = Eigen::VectorXd::Zero(linear);
  std::vector<Vector<kDim>> theta(static_cast<std::size_t>(s * (s + 1) / 2), Vector<kDim>::Zero());
  place.rest_normal = surface.normal(f, shape);
  for (std::size_t a = 0; a < f.nodes.size(); ++a) {
    const int n = f.nodes[a];
    place.rest_m += shape.value[a] * surface.rest(n);
    place.x_m += shape.value[a] * carried_m_[static_cast<std::size_t>(n)];
    place.self_mpN += shape.value[a] * body_.self.self_mpN[static_cast<std::size_t>(n)];
    place.second_mpN2 += shape.value[a] * body_.self.second_mpN2[static_cast<std::size_t>(n)];
    place.body_curvature_1pm += shape.value[a] * body_.self.curvature_1pm[static_cast<std::size_t>(n)];
    place.slide += shape.value[a] * body_.modes.phi_1pm.block(n * kDim, 0, kDim, s);
    place.linear +=
        shape.value[a] * (body_.modes.phi_1pm.block(n * kDim, s, kDim, linear).transpose() * place.rest_normal);
    for (std::size_t p = 0; p < theta.size(); ++p)
      theta[p] += shape.value[a] * body_.maps.theta_1pm3[p].template segment<kDim>(n * kDim);
  }
  const fem::Gap<kDim> g = gap(tool, place.x_m);
  place.travel_m = -g.value_m;
  place.normal = -eigen<kDim>(g.normal);
  place.turn.resize(s, s);
  for (int a = 0; a < s; ++a)
    for (int b = 0; b < s; ++b) {
      place.turn(a, b) = place.normal.dot(theta[pair_place(a, b, s)]);
      place.slide.col(a) += theta[pair_place(a, b, s)] * q[b];
    }
  place.pull = place.slide.transpose() * place.normal;
  return place;
}

template <int kDim>
void PlaceFinder<kDim>::place_tools(const std::vector<fem::Point<kDim>>& origin_m) {
  origin_m_.clear();
  for (const fem::Point<kDim>& o : origin_m) origin_m_.push_back(eigen<kDim>(o));
}

template <int kDim>
std::vector<ContactPlace<kDim>> PlaceFinder<kDim>::follow(const Eigen::VectorXd& q,
                                                          const std::vector<fem::Point<kDim>>& origin_m,
                                                          const std::vector<ContactPlace<kDim>>& places) {
  place_tools(origin_m);
  std::vector<ContactPlace<kDim>> out;
  for (const ContactPlace<kDim>& place : places) {
    carry(body_.rest->surface().facets()[static_cast<std::size_t>(place.facet)].nodes, q);
    FacetPlace at = place.at;
    settle(place.tool, place.facet, at);
    out.push_back(describe(place.tool, place.facet, at, q));
  }
  return out;
}

template <int kDim>
std::vector<ContactPlace<kDim>> PlaceFinder<kDim>::find(const Eigen::VectorXd& q,
                                                        const std::vector<fem::Point<kDim>>& origin_m, double reach_m) {
  carry(body_.self.nodes, q);
  place_tools(origin_m);
  const Surface<kDim>& surface = body_.rest->surface();
  std::vector<ContactPlace<kDim>> places;
  for (int tool = 0; tool < static_cast<int>(tools_.size()); ++tool)
    for (const int node : minima(tool)) {
      double best = reach_m;
      int best_facet = -1;
      FacetPlace best_at{};
      for (const int f : surface.facets_at(node)) {
        const auto& nodes = surface.facets()[static_cast<std::size_t>(f)].nodes;
        if (!std::all_of(nodes.begin(), nodes.end(), [&](int n) { return body_.self.known(n); })) continue;
        FacetPlace at = facet_centre(nodes.size());
        const double gap_m = settle(tool, f, at);
        if (gap_m >= best) continue;
        best = gap_m;
        best_facet = f;
        best_at = at;
      }
      if (best_facet >= 0) places.push_back(describe(tool, best_facet, best_at, q));
    }
  return places;
}

template class PlaceFinder<2>;
template class PlaceFinder<3>;

}  // namespace palpate::elastic
