// One body for every contact: few soft nonlinear modes, more linear ones, self terms under the contact.
#pragma once

#include "config/elastic/self_terms.h"
#include "config/elastic/soft_maps.h"
#include "config/elastic/surface_modes.h"

namespace palpate::elastic {

struct ElasticOptions {
  int soft = 4;     // nonlinear modes; raised where it would part a symmetric family
  int linear = 30;  // more modes, linear
  // Probing displacement, share of the body's extent. At 60 mm 0.12 mm: above rounding, below fifth order.
  double probe_share = 2e-3;
  PatchOptions patch = {};
  bool second_order = false;  // c1; see docs/models_elastic.md for when it helps
  unsigned jobs = 1;          // threads (config/parallel.h); changes no bit
};

template <int kDim>
struct ElasticBody {
  const RestBody<kDim>* rest = nullptr;
  int soft = 0;
  SurfaceModes modes;  // soft, then linear
  SoftMaps maps;
  SelfTerms self;
};

// What does not depend on how many modes are taken: a pool of modes, and the samples under contacts.
template <int kDim>
struct ElasticStock {
  const RestBody<kDim>* rest = nullptr;
  SurfaceModes modes;
  std::vector<SelfSample> samples;
};
// `modes`: at most so many will be asked for. `rest` must outlive the result.
template <int kDim>
ElasticStock<kDim> make_elastic_stock(const RestBody<kDim>& rest, const std::vector<int>& contact_nodes, int modes,
                                      const ElasticOptions& options = {}, const PlaceListener& listen = {});
template <int kDim>
ElasticBody<kDim> make_elastic_body(const ElasticStock<kDim>& stock, const ElasticOptions& options);

// Both at once. `contact_nodes`: where tools may touch. `rest` must outlive the result.
template <int kDim>
ElasticBody<kDim> make_elastic_body(const RestBody<kDim>& rest, const std::vector<int>& contact_nodes,
                                    const ElasticOptions& options = {});

}  // namespace palpate::elastic
