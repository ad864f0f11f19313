#include "config/elastic/elastic_body.h"

#include <algorithm>
#include <cmath>

namespace palpate::elastic {

namespace {

// Rays are tried until the softest mode moves the surface by half the body.
constexpr double kReachShare = 0.5;
// V is followed as far as it holds this share of the linear energy: a quartic that has lost more than that is about to
// turn down, which a body does not.
constexpr double kLeastEnergyShare = 0.2;

}  // namespace

template <int kDim>
ElasticStock<kDim> make_elastic_stock(const RestBody<kDim>& rest, const std::vector<int>& contact_nodes, int modes,
                                      const ElasticOptions& options, const PlaceListener& listen) {
  const double probe_m = options.probe_share * rest.surface().extent_m();
  return {&rest, surface_modes(rest, modes),
          self_samples(rest, contact_nodes, probe_m, options.patch, listen, options.jobs)};
}

template <int kDim>
ElasticBody<kDim> make_elastic_body(const ElasticStock<kDim>& stock, const ElasticOptions& options) {
  const RestBody<kDim>& rest = *stock.rest;
  ElasticBody<kDim> body;
  body.rest = &rest;
  const Eigen::Index count = std::min<Eigen::Index>(options.soft + options.linear, stock.modes.lambda_Npm3.size());
  body.modes = {stock.modes.lambda_Npm3.head(count), stock.modes.phi_1pm.leftCols(count)};
  body.soft = whole_families(body.modes, options.soft);
  body.maps = soft_maps(rest, body.modes, body.soft, options.probe_share * rest.surface().extent_m(), options.jobs);
  const double largest = body.modes.phi_1pm.col(0).cwiseAbs().maxCoeff();
  const double reach_m2 = kReachShare * rest.surface().extent_m() / largest;
  body.maps.potential.radius_rootJ =
      trusted_radius(body.maps.potential, reach_m2 * std::sqrt(body.modes.lambda_Npm3[0]), kLeastEnergyShare);
  body.self = self_terms(rest, body.modes, body.maps, stock.samples);
  if (!options.second_order) std::fill(body.self.second_mpN2.begin(), body.self.second_mpN2.end(), 0.0);
  return body;
}

template <int kDim>
ElasticBody<kDim> make_elastic_body(const RestBody<kDim>& rest, const std::vector<int>& contact_nodes,
                                    const ElasticOptions& options) {
  return make_elastic_body(make_elastic_stock(rest, contact_nodes, options.soft + options.linear, options), options);
}

#define PALPATE_ELASTIC_BODY(kDim)                                                                          \
  template ElasticStock<kDim> make_elastic_stock<kDim>(const RestBody<kDim>&, const std::vector<int>&, int, \
                                                       const ElasticOptions&, const PlaceListener&);        \
  template ElasticBody<kDim> make_elastic_body<kDim>(const ElasticStock<kDim>&, const ElasticOptions&);     \
  template ElasticBody<kDim> make_elastic_body<kDim>(const RestBody<kDim>&, const std::vector<int>&,        \
                                                     const ElasticOptions&);
PALPATE_ELASTIC_BODY(2)
PALPATE_ELASTIC_BODY(3)
#undef PALPATE_ELASTIC_BODY

}  // namespace palpate::elastic
