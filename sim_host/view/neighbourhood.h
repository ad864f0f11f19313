// The local neighbourhood of a contact: how the dent fades from the contact's edge to where the global shape takes
// over.
#pragma once

#include "rt_core/model.h"
#include "sim_host/view/contact_profile.h"

namespace palpate {

// u(r) = A - B ln r, r in metres (Luo & Xiao 2006, section V.B).
struct LogLaw {
  Real a = 0;
  Real b = 0;
};
// The logarithmic law through u(contact_radius_m) = u_contact and u(reach_m) = u_far. Needs 0 < contact_radius < reach.
LogLaw log_law(Real contact_radius_m, Real reach_m, Real u_contact, Real u_far);

// Blend factor g(r): 0 for r >= R (reach), continuous and falling; by the logarithmic laws 1 for r <= a (contact
// radius).
//   kLogPaper  g = ln(R/r) / ln(R/a): the paper's law, the plane (line-load) solution; kink at R.
//   kLogC1 g = [ln(R/r) - (1 - r^2/R^2)/2] / [same at a]: the same without a kink at R.
//   kPunch g = contact_profile(tip, r/a), the surface of a half space under and around a punch of the tip's profile
//          (Sneddon 1965): exact out to half of R, or to a, and fading from there.
//   kNone  g = 0: no local law.
struct Neighbourhood {
  NeighbourhoodLaw law = NeighbourhoodLaw::kNone;
  Real contact_radius_m = 0;
  Real reach_m = 0;
  LogLaw log;                      // kLogPaper: g = A - B ln r
  Real inverse_at_contact = 0;     // kLogC1: 1 / denominator
  TipShape tip = TipShape::kFlat;  // kPunch
  ContactEllipse edge;             // kPunch: of which contact_radius_m is the longer half axis
};

// a = sqrt(area / pi) clipped to [0.05 R, 0.9 R]: below, a point contact would make the dent a needle; above, the law's
// denominator vanishes. An area that is not a positive number gives the lower end.
Real contact_radius_m(Real area_m2, Real reach_m);
// Precomputes the law. contact_radius_m in (0, 0.9 reach_m]; anything else, or reach_m <= 0, gives law kNone.
Neighbourhood make_neighbourhood(NeighbourhoodLaw law, Real contact_radius_m, Real reach_m);
// Law kPunch for a contact with this edge, cut to 0.9 reach_m.
Neighbourhood punch_neighbourhood(TipShape tip, ContactEllipse edge, Real reach_m);
// g at a place that far from the middle of the contact, in [0, 1].
Real neighbourhood_blend(const Neighbourhood& neighbourhood, Vec3 from_middle);

// The paper's modification factor omega = min(1, sqrt(A_ref / A)): a larger region makes a shallower dent. The paper
// counts mesh points, which depends on the mesh; area does not, and for a flat punch at given force depth falls as
// 1/sqrt(A). Applied to the dent that is drawn, never to a force. 1 when an area is not positive.
Real region_size_factor(Real area_m2, Real reference_area_m2);

}  // namespace palpate
