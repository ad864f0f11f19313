// One tip on the carried surface x = X + u(X; p) of an elastic body.
#pragma once

#include "rt_core/contact/elastic/soft_energy.h"
#include "rt_core/state.h"
#include "rt_core/surface/smooth_foot.h"

namespace palpate {

struct ElasticRow {
  SmoothFoot foot;                                 // on the carried surface
  Vec3 centre_w;                                   // of the tip
  Real travel_m;                                   // how far the carried surface and the tip overlap; < 0 apart
  Real pull[kMaxSoftModes];                        // d travel / d p
  Real turn[elastic_layout::kMaxPairs];            // d2 travel / d p2 at a fixed place
  Real c_m_per_N, c1_m_per_N2, curvature_1_per_m;  // there; see config/elastic/self_terms.h
  Vec3 rise;                                       // gradient of the tip's height: the normal but for the facets' share
  Vec3 c_gradient, c1_gradient, curvature_gradient;
};

// The surface with the soft modes at given amplitudes.
struct CarriedSurface {
  const Model& model;
  const Real* y;         // soft_products
  std::int32_t* looked;  // boxes and triangles this tick has looked at
  std::int32_t* shown;   // terms of vertices summed up

  // Displacement of a vertex.
  Vec3 displacement(std::int32_t vertex) const PALPATE_RT;
  // Puts the tip of `margin_m` about `centre_w` on the surface, starting at `triangle` below `near_w`. Beyond a sharp
  // edge, and below the focal surface, on the facet nearest to the centre as it was before the body moved; with
  // foot.triangle -1 where the tick's share of surface work is used up.
  void place(Vec3 centre_w, Real margin_m, std::int32_t triangle, Vec3 near_w, ElasticRow& row) const PALPATE_RT;

 private:
  bool place_on_facet(Vec3 centre_w, std::int32_t triangle, ElasticRow& row) const PALPATE_RT;
};

// Travel of the linear modes at one row per newton at the other.
Real linear_compliance_m_per_N(const Model& model, const ElasticRow& a, const ElasticRow& b) PALPATE_RT;

}  // namespace palpate
