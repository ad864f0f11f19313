#include "config/elastic/self_terms.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "config/elastic/local_law.h"
#include "config/scene/config_error.h"

namespace palpate::elastic {

namespace {

// A wall's other side and a block's flanks carry nothing of a patch.
constexpr double kFacingCosine = 0.5;
constexpr double kPatchSigmas = 4;

FacetPlace place_of_node(const std::vector<int>& nodes, int node) {
  const auto local = std::find(nodes.begin(), nodes.end(), node) - nodes.begin();
  if (nodes.size() == 6) {
    constexpr double kPlace[6][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};
    return {kPlace[local][0], kPlace[local][1]};
  }
  return {static_cast<double>(local % 3) - 1, nodes.size() == 9 ? static_cast<double>(local / 3) - 1 : 0};
}

// Mean of the facets' mean curvatures at the node: half the trace of the second fundamental form in the first.
template <int kDim>
double node_curvature(const Surface<kDim>& surface, int node) {
  double sum = 0;
  for (const int f : surface.facets_at(node)) {
    const auto& facet = surface.facets()[static_cast<std::size_t>(f)];
    const FacetShape shape = facet_shape(facet.nodes.size(), place_of_node(facet.nodes, node));
    const Vector<kDim> normal = surface.normal(facet, shape);
    Eigen::Matrix<double, kDim, 2> tangent = Eigen::Matrix<double, kDim, 2>::Zero();
    Eigen::Matrix2d bend = Eigen::Matrix2d::Zero();
    for (std::size_t a = 0; a < facet.nodes.size(); ++a) {
      tangent += surface.rest(facet.nodes[a]) * shape.slope[a].transpose();
      bend -= normal.dot(surface.rest(facet.nodes[a])) * shape.curvature[a];
    }
    const Eigen::Matrix2d metric = tangent.transpose() * tangent;
    sum += kDim == 2 ? bend(0, 0) / metric(0, 0) : 0.5 * (metric.inverse() * bend).trace();
  }
  return sum / static_cast<double>(surface.facets_at(node).size());
}

}  // namespace

template <int kDim>
Vector<kDim> node_normal(const Surface<kDim>& surface, int node) {
  Vector<kDim> sum = Vector<kDim>::Zero();
  for (const int f : surface.facets_at(node)) {
    const auto& facet = surface.facets()[static_cast<std::size_t>(f)];
    sum += surface.normal(facet, facet_shape(facet.nodes.size(), place_of_node(facet.nodes, node)));
  }
  return sum.normalized();
}

template <int kDim>
Eigen::VectorXd gaussian_patch(const RestBody<kDim>& body, const Vector<kDim>& at_m, const Vector<kDim>& normal,
                               double sigma_m) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(body.size());
  double total = 0;
  for (const auto& point : body.surface().points()) {
    const double distance = (point.x_m - at_m).norm();
    if (distance > kPatchSigmas * sigma_m || point.normal.dot(normal) < kFacingCosine) continue;
    const double share = point.area_m2 * std::exp(-0.5 * distance * distance / (sigma_m * sigma_m));
    const auto& nodes = body.surface().facets()[static_cast<std::size_t>(point.facet)].nodes;
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (int d = 0; d < kDim; ++d) load[nodes[a] * kDim + d] -= share * point.shape.value[a] * normal[d];
    total += share;
  }
  return load / total;
}

namespace {

// Third order of the complementary energy of the soft modes under the load g.
double soft_third_order(const SoftMaps& maps, const Eigen::VectorXd& g, const Eigen::VectorXd& q1) {
  const SoftPotential& v = maps.potential;
  double sum = 0;
  for (std::size_t m = 0; m < v.cubic_index().size(); ++m) {
    const auto& [a, b, c] = v.cubic_index()[m];
    sum -= v.cubic[static_cast<Eigen::Index>(m)] * q1[a] * q1[b] * q1[c];
  }
  const int s = static_cast<int>(q1.size());
  for (int a = 0; a < s; ++a)
    for (int b = 0; b < s; ++b) sum += 0.5 * g.dot(maps.theta_1pm3[pair_place(a, b, s)]) * q1[a] * q1[b];
  return sum;
}

}  // namespace

template <int kDim>
std::vector<SelfSample> self_samples(const RestBody<kDim>& body, const std::vector<int>& nodes, double probe_m,
                                     double patch_edges) {
  const Surface<kDim>& surface = body.surface();
  std::vector<SelfSample> samples;
  for (const int node : nodes) {
    if (surface.facets_at(node).empty())
      throw ConfigError("elastic body: contact node " + std::to_string(node) + " lies inside the body");
    const double sigma = patch_edges * surface.edge_m(node);
    const Eigen::VectorXd g = gaussian_patch<kDim>(body, surface.rest(node), node_normal(surface, node), sigma),
                          u = body.solve(g);
    SelfSample sample;
    sample.node = node;
    sample.load_N = g.sparseView();
    sample.give_mpN =
        g.dot(u) - gaussian_self_compliance_mpN(kDim == 2, body.contact_modulus(), sigma, surface.extent_m());
    sample.curvature_1pm = node_curvature(surface, node);
    const double scale = probe_m / u.cwiseAbs().maxCoeff();
    sample.third_mpN2 = (body.internal_force(scale * u) + body.internal_force(-scale * u)).dot(u) / (scale * scale);
    samples.push_back(std::move(sample));
  }
  return samples;
}

template <int kDim>
SelfTerms self_terms(const RestBody<kDim>& body, const SurfaceModes& modes, const SoftMaps& maps,
                     const std::vector<SelfSample>& samples) {
  SelfTerms terms;
  terms.self_mpN.assign(static_cast<std::size_t>(body.size() / kDim), std::numeric_limits<double>::quiet_NaN());
  terms.curvature_1pm = terms.second_mpN2 = terms.self_mpN;
  terms.length_m = body.surface().extent_m();
  for (const SelfSample& sample : samples) {
    const std::size_t at = static_cast<std::size_t>(sample.node);
    const Eigen::VectorXd g = sample.load_N, pull = modes.phi_1pm.leftCols(maps.potential.size()).transpose() * g,
                          q1 = pull.cwiseQuotient(maps.potential.lambda());
    terms.nodes.push_back(sample.node);
    terms.curvature_1pm[at] = sample.curvature_1pm;
    terms.self_mpN[at] = sample.give_mpN - pull.dot(q1);
    terms.second_mpN2[at] = -0.5 * sample.third_mpN2 - 3 * soft_third_order(maps, g, q1);
  }
  return terms;
}

#define PALPATE_ELASTIC_SELF(kDim)                                                                                     \
  template Vector<kDim> node_normal<kDim>(const Surface<kDim>&, int);                                                  \
  template Eigen::VectorXd gaussian_patch<kDim>(const RestBody<kDim>&, const Vector<kDim>&, const Vector<kDim>&,       \
                                                double);                                                               \
  template std::vector<SelfSample> self_samples<kDim>(const RestBody<kDim>&, const std::vector<int>&, double, double); \
  template SelfTerms self_terms<kDim>(const RestBody<kDim>&, const SurfaceModes&, const SoftMaps&,                     \
                                      const std::vector<SelfSample>&);
PALPATE_ELASTIC_SELF(2)
PALPATE_ELASTIC_SELF(3)
#undef PALPATE_ELASTIC_SELF

}  // namespace palpate::elastic
