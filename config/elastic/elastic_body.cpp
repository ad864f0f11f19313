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
ElasticBody<kDim> make_elastic_body(const RestBody<kDim>& rest, const std::vector<int>& contact_nodes,
                                    const ElasticOptions& options) {
  ElasticBody<kDim> body;
  body.rest = &rest;
  body.modes = surface_modes(rest, options.soft + options.linear);
  body.soft = whole_families(body.modes, options.soft);
  body.maps = soft_maps(rest, body.modes, body.soft, options.probe_share * rest.surface().extent_m());
  const double largest = body.modes.phi_1pm.col(0).cwiseAbs().maxCoeff();
  const double reach_m2 = kReachShare * rest.surface().extent_m() / largest;
  body.maps.potential.radius_rootJ =
      trusted_radius(body.maps.potential, reach_m2 * std::sqrt(body.modes.lambda_Npm3[0]), kLeastEnergyShare);
  body.self = self_terms(rest, body.modes, body.maps, contact_nodes, options.probe_share * rest.surface().extent_m(),
                         options.patch_edges);
  if (!options.second_order) std::fill(body.self.second_mpN2.begin(), body.self.second_mpN2.end(), 0.0);
  return body;
}
template ElasticBody<2> make_elastic_body<2>(const RestBody<2>&, const std::vector<int>&, const ElasticOptions&);
template ElasticBody<3> make_elastic_body<3>(const RestBody<3>&, const std::vector<int>&, const ElasticOptions&);

}  // namespace palpate::elastic
