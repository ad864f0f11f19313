// The local neighbourhood of a contact: how the dent fades from the contact's edge to where the global shape takes
// over.
#pragma once

#include "rt_core/model.h"

namespace palpate {

// u(r) = A - B ln r, r in metres (Luo & Xiao 2006, section V.B).
struct LogLaw {
  Real a = 0;
  Real b = 0;
};
// The logarithmic law through u(contact_radius_m) = u_contact and u(reach_m) = u_far. Needs 0 < contact_radius < reach.
LogLaw log_law(Real contact_radius_m, Real reach_m, Real u_contact, Real u_far);

// Blend factor g(r): 1 for r <= a (contact radius), 0 for r >= R (reach), continuous and falling between.
//   kLogPaper  g = ln(R/r) / ln(R/a): the paper's law, the plane (line-load) solution; kink at R.
//   kLogC1 g = [ln(R/r) - (1 - r^2/R^2)/2] / [same at a]: the same without a kink at R.
//   kPunch g = (asin(a/r) - asin(a/R)) / (pi/2 - asin(a/R)): the surface around a flat punch on a half space
//          (Sneddon 1965), the solution in space; kink at R.
//   kNone  g = 0: no local law.
struct Neighbourhood {
  NeighbourhoodLaw law = NeighbourhoodLaw::kNone;
  Real contact_radius_m = 0;
  Real reach_m = 0;
  LogLaw log;                   // kLogPaper: g = A - B ln r
  Real at_reach = 0;            // kPunch: asin(a/R)
  Real inverse_at_contact = 0;  // kLogC1, kPunch: 1 / denominator
};

// a = sqrt(area / pi) clipped to [0.05 R, 0.9 R]: below, a point contact would make the dent a needle; above, the law's
// denominator vanishes. An area that is not a positive number gives the lower end.
Real contact_radius_m(Real area_m2, Real reach_m);
// Precomputes the law. contact_radius_m in (0, 0.9 reach_m]; anything else, or reach_m <= 0, gives law kNone.
Neighbourhood make_neighbourhood(NeighbourhoodLaw law, Real contact_radius_m, Real reach_m);
// g(r), in [0, 1].
Real neighbourhood_blend(const Neighbourhood& neighbourhood, Real distance_m);

// The paper's modification factor omega = min(1, sqrt(A_ref / A)): a larger region makes a shallower dent. The paper
// counts mesh points, which depends on the mesh; area does not, and for a flat punch at given force depth falls as
// 1/sqrt(A). Applied to the dent that is drawn, never to a force. 1 when an area is not positive.
Real region_size_factor(Real area_m2, Real reference_area_m2);

}  // namespace palpate
