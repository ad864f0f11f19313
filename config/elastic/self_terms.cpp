#include "config/elastic/self_terms.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "config/elastic/local_law.h"
#include "config/parallel.h"
#include "config/scene/config_error.h"

namespace palpate::elastic {

namespace {

// A wall's other side and a block's flanks carry nothing of a patch.
constexpr double kFacingCosine = 0.5;
constexpr double kPatchSigmas = 4;
constexpr std::size_t kTogether = 4;    // nodes whose patches are solved in one pass through the factor
constexpr std::size_t kMostPieces = 4;  // at a time: of 100,000 nodes each has 48 vectors, 115 MB
constexpr double kWider = 1.4;          // deviation of the second patch, of the first's
constexpr double kMostGrowth = 2;       // of a place's give, from the patch to no width
// Elements are too stiff under a patch, by (edges / deviation) to this power: PatchOptions.
constexpr double kTooStiffPower = 3.25;

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

namespace {

// Of a patch's force, what acts at a point of the surface; nothing on facets that look elsewhere.
template <int kDim>
double patch_share(const typename Surface<kDim>::Point& point, const Vector<kDim>& at_m, const Vector<kDim>& normal,
                   double sigma_m) {
  const double distance = (point.x_m - at_m).norm();
  if (distance > kPatchSigmas * sigma_m || point.normal.dot(normal) < kFacingCosine) return 0;
  return point.area_m2 * std::exp(-0.5 * distance * distance / (sigma_m * sigma_m));
}

}  // namespace

template <int kDim>
Eigen::VectorXd gaussian_patch(const RestBody<kDim>& body, const Vector<kDim>& at_m, const Vector<kDim>& normal,
                               double sigma_m) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(body.size());
  double total = 0;
  for (const auto& point : body.surface().points()) {
    const double share = patch_share<kDim>(point, at_m, normal, sigma_m);
    if (!(share > 0)) continue;
    const auto& nodes = body.surface().facets()[static_cast<std::size_t>(point.facet)].nodes;
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (int d = 0; d < kDim; ++d) load[nodes[a] * kDim + d] -= share * point.shape.value[a] * normal[d];
    total += share;
  }
  return load / total;
}

namespace {

// Without friction a patch presses along the surface's own normals, not along that of its middle. What it presses aside
// by that, for a unit of force along the latter: `aside` there, of the force. Their mean is left out: where all of it
// goes the tool says, and the tick with it.
template <int kDim, class Aside>
Eigen::VectorXd aside_patch(const RestBody<kDim>& body, const Vector<kDim>& at_m, const Vector<kDim>& normal,
                            double sigma_m, const Aside& aside) {
  const Surface<kDim>& surface = body.surface();
  Eigen::VectorXd load = Eigen::VectorXd::Zero(body.size()), even = load;
  Vector<kDim> mean = Vector<kDim>::Zero();
  double total = 0;
  for (const auto& point : surface.points()) {
    const double share = patch_share<kDim>(point, at_m, normal, sigma_m);
    if (!(share > 0)) continue;
    const Vector<kDim> by = share * aside(point);
    const auto& nodes = surface.facets()[static_cast<std::size_t>(point.facet)].nodes;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      load.template segment<kDim>(kDim * nodes[a]) -= point.shape.value[a] * by;
      even.template segment<kDim>(kDim * nodes[a]).array() += point.shape.value[a] * share;
    }
    mean += by;
    total += share;
  }
  for (Eigen::Index n = 0; n < load.size(); n += kDim)
    load.template segment<kDim>(n) += even.template segment<kDim>(n).cwiseProduct(mean / total);
  return load / total;
}

// At rest, where the surface is bent ...
template <int kDim>
Eigen::VectorXd bent_patch(const RestBody<kDim>& body, const Vector<kDim>& at_m, const Vector<kDim>& normal,
                           double sigma_m) {
  return aside_patch<kDim>(body, at_m, normal, sigma_m, [&](const typename Surface<kDim>::Point& point) {
    return Vector<kDim>(point.normal / point.normal.dot(normal) - normal);
  });
}

// ... and as the displacement under a unit of force turns it.
template <int kDim>
Eigen::VectorXd turned_patch(const RestBody<kDim>& body, const Vector<kDim>& at_m, const Vector<kDim>& normal,
                             double sigma_m, const Eigen::VectorXd& u) {
  return aside_patch<kDim>(body, at_m, normal, sigma_m,
                           [&](const typename Surface<kDim>::Point& point) { return body.surface().turn(point, u); });
}

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

// Two patches at a node, the second wider.
struct Met {
  PressedPlace place;
  double give_mpN[2] = {};
};
// All nodes at once.
template <int kDim>
std::vector<Met> meet(const RestBody<kDim>& body, std::span<const int> nodes, const PatchOptions& patch) {
  const Surface<kDim>& surface = body.surface();
  const auto sigma = [&](std::size_t i) {
    return (i % 2 == 0 ? 1 : kWider) * patch.edges * surface.edge_m(nodes[i / 2]);
  };
  Eigen::MatrixXd g(body.size(), static_cast<Eigen::Index>(2 * nodes.size()));
  for (std::size_t i = 0; i < 2 * nodes.size(); ++i) {
    const int node = nodes[i / 2];
    g.col(static_cast<Eigen::Index>(i)) =
        gaussian_patch<kDim>(body, surface.rest(node), node_normal(surface, node), sigma(i));
  }
  const Eigen::MatrixXd u = body.solve_all(g);
  std::vector<Met> met(nodes.size());
  for (std::size_t i = 0; i < 2 * nodes.size(); ++i) {
    const auto col = static_cast<Eigen::Index>(i);
    PressedPlace& place = met[i / 2].place;
    place.node = nodes[i / 2];
    place.sigma_m[i % 2] = sigma(i);
    place.u_mpN[i % 2] = u.col(col);
    if (i % 2 == 0) place.give_mpN = g.col(col).dot(u.col(col));
    const double half_space =
        gaussian_self_compliance_mpN(kDim == 2, body.contact_modulus(nodes[i / 2]), sigma(i), surface.extent_m());
    const double edges = surface.edge_m(nodes[i / 2]) / sigma(i);
    const double too_stiff = patch.too_stiff * std::pow(edges, kTooStiffPower);
    met[i / 2].give_mpN[i % 2] = g.col(col).dot(u.col(col)) - (1 - too_stiff) * half_space;
  }
  return met;
}

// Samples of some nodes, and where someone listens what they met.
template <int kDim>
struct Sampled {
  std::vector<SelfSample> samples;
  std::vector<Met> met;
};
template <int kDim>
Sampled<kDim> sample_some(const RestBody<kDim>& body, std::span<const int> some, double probe_m,
                          const PatchOptions& patch, bool heard) {
  const Surface<kDim>& surface = body.surface();
  Sampled<kDim> out{{}, meet(body, some, patch)};
  // What is drawn besides, in one solve, for a solve spends its time on fetching the factor: the second order of every
  // place, and its patch with a slope.
  const auto count = static_cast<Eigen::Index>(some.size());
  Eigen::MatrixXd drawn(body.size(), heard ? 2 * count : 0);
  for (std::size_t i = 0; i < some.size(); ++i) {
    const Met& met = out.met[i];
    const PressedPlace& place = met.place;
    const Eigen::VectorXd& u = place.u_mpN[0];
    SelfSample sample;
    sample.node = some[i];
    sample.curvature_1pm = node_curvature(surface, some[i]);
    sample.width = WidthLaw(met.give_mpN, place.sigma_m, body.contact_modulus(some[i]), body.material().poisson_ratio,
                            kDim == 3 ? sample.curvature_1pm : 0);  // a line's load leaves the surface unstressed
    const double scale = probe_m / u.cwiseAbs().maxCoeff();
    const Eigen::VectorXd bent = body.internal_force(scale * u) + body.internal_force(-scale * u);
    sample.third_mpN2 = bent.dot(u) / (scale * scale);
    if (heard) {
      const Vector<kDim> at = surface.rest(some[i]), normal = node_normal(surface, some[i]);
      const auto col = static_cast<Eigen::Index>(i);
      drawn.col(col) = bent * (-0.5 / (scale * scale)) + turned_patch<kDim>(body, at, normal, place.sigma_m[0], u);
      drawn.col(count + col) = bent_patch<kDim>(body, at, normal, place.sigma_m[0]);
    }
    // A wall's second order is of the third power in how far it gives: on a dome the patches of 4.4 and 3.3 mm stand
    // as 1 to 1.07 in R and 1 to 1.23 in this (2026-11-23). Along the patches' parabola: a plate's own growth, more,
    // leaves half shells and tubes 0.6 to 1 % softer at 5 mm (2026-11-25).
    if (met.give_mpN[0] > 0) {
      const double fall = met.give_mpN[0] - met.give_mpN[1];
      const double grows = std::clamp(1 + fall / (kWider * kWider - 1) / met.give_mpN[0], 1.0, kMostGrowth);
      sample.third_mpN2 *= grows * grows * grows;
    }
    out.samples.push_back(sample);
  }
  if (!heard) return out;
  drawn = body.solve_all(drawn);
  for (Eigen::Index i = 0; i < count; ++i) {
    out.met[static_cast<std::size_t>(i)].place.second_mpN2 = drawn.col(i);
    out.met[static_cast<std::size_t>(i)].place.bent_mpN = drawn.col(count + i);
  }
  return out;
}

}  // namespace

template <int kDim>
std::vector<SelfSample> self_samples(const RestBody<kDim>& body, const std::vector<int>& nodes, double probe_m,
                                     const PatchOptions& patch, const PlaceListener& listen, unsigned jobs) {
  for (const int node : nodes)
    if (body.surface().facets_at(node).empty())
      throw ConfigError("elastic body: contact node " + std::to_string(node) + " lies inside the body");
  std::vector<SelfSample> samples;
  const std::size_t at_once = kTogether * std::min(pieces_at_once(jobs), kMostPieces);
  for (std::size_t first = 0; first < nodes.size(); first += at_once) {
    const auto some = std::span(nodes).subspan(first, std::min(at_once, nodes.size() - first));
    std::vector<Sampled<kDim>> sampled((some.size() + kTogether - 1) / kTogether);
    for_each_piece(sampled.size(), jobs, [&](std::size_t i) {
      const auto piece = some.subspan(kTogether * i, std::min(kTogether, some.size() - kTogether * i));
      sampled[i] = sample_some(body, piece, probe_m, patch, static_cast<bool>(listen));
    });
    for (const Sampled<kDim>& piece : sampled) {
      samples.insert(samples.end(), piece.samples.begin(), piece.samples.end());
      if (!listen) continue;
      for (const Met& met : piece.met) listen(met.place);
    }
  }
  return samples;
}

template <int kDim>
SelfTerms self_terms(const RestBody<kDim>& body, const SurfaceModes& modes, const SoftMaps& maps,
                     const std::vector<SelfSample>& samples) {
  SelfTerms terms;
  terms.self_mpN.assign(static_cast<std::size_t>(body.size() / kDim), std::numeric_limits<double>::quiet_NaN());
  terms.curvature_1pm = terms.second_mpN2 = terms.self_mpN;
  terms.width.resize(terms.self_mpN.size());
  terms.length_m = body.surface().extent_m();
  for (const SelfSample& sample : samples) {
    const std::size_t at = static_cast<std::size_t>(sample.node);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(body.size());
    g.template segment<kDim>(kDim * sample.node) = -node_normal(body.surface(), sample.node);
    const Eigen::VectorXd pull = modes.phi_1pm.leftCols(maps.potential.size()).transpose() * g,
                          q1 = pull.cwiseQuotient(maps.potential.lambda());
    terms.nodes.push_back(sample.node);
    terms.curvature_1pm[at] = sample.curvature_1pm;
    terms.width[at] = sample.width;
    terms.self_mpN[at] = sample.width.give_mpN(0) - pull.dot(q1);
    terms.second_mpN2[at] = -0.5 * sample.third_mpN2 - 3 * soft_third_order(maps, g, q1);
  }
  return terms;
}

#define PALPATE_ELASTIC_SELF(kDim)                                                                               \
  template Vector<kDim> node_normal<kDim>(const Surface<kDim>&, int);                                            \
  template Eigen::VectorXd gaussian_patch<kDim>(const RestBody<kDim>&, const Vector<kDim>&, const Vector<kDim>&, \
                                                double);                                                         \
  template std::vector<SelfSample> self_samples<kDim>(const RestBody<kDim>&, const std::vector<int>&, double,    \
                                                      const PatchOptions&, const PlaceListener&, unsigned);      \
  template SelfTerms self_terms<kDim>(const RestBody<kDim>&, const SurfaceModes&, const SoftMaps&,               \
                                      const std::vector<SelfSample>&);
PALPATE_ELASTIC_SELF(2)
PALPATE_ELASTIC_SELF(3)
#undef PALPATE_ELASTIC_SELF

}  // namespace palpate::elastic
