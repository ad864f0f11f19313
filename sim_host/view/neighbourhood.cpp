#include "sim_host/view/neighbourhood.h"

#include "rt_core/math.h"

namespace palpate {
namespace {

constexpr Real kLeastContactRadius = 0.05;  // of the reach
constexpr Real kMostContactRadius = 0.9;    // of the reach

// ln(R/r) - (1 - r^2/R^2)/2 as a function of q = r/R.
Real c1_profile(Real q) { return -math::log(q) - 0.5 * (1.0 - q * q); }

}  // namespace

LogLaw log_law(Real contact_radius_m, Real reach_m, Real u_contact, Real u_far) {
  if (!(contact_radius_m > 0 && contact_radius_m < reach_m)) return {u_far, 0};
  const Real b = (u_contact - u_far) / math::log(reach_m / contact_radius_m);
  return {u_contact + b * math::log(contact_radius_m), b};
}

Real contact_radius_m(Real area_m2, Real reach_m) {
  const Real radius_m = area_m2 > 0 ? square_root(area_m2 / kPi) : 0.0;
  return clamp_to(radius_m, kLeastContactRadius * reach_m, kMostContactRadius * reach_m);
}

Neighbourhood make_neighbourhood(NeighbourhoodLaw law, Real contact_radius_m, Real reach_m) {
  Neighbourhood result;
  const bool usable = contact_radius_m > 0 && reach_m < kHuge && contact_radius_m <= kMostContactRadius * reach_m;
  if (!usable) return result;
  result.law = law;
  result.contact_radius_m = contact_radius_m;
  result.reach_m = reach_m;
  const Real q = contact_radius_m / reach_m;
  result.log = log_law(contact_radius_m, reach_m, 1.0, 0.0);
  if (law == NeighbourhoodLaw::kLogC1) result.inverse_at_contact = 1.0 / c1_profile(q);
  result.edge = {{1, 0, 0}, contact_radius_m, contact_radius_m};
  return result;
}

Neighbourhood punch_neighbourhood(TipShape tip, ContactEllipse edge, Real reach_m) {
  const Real most = kMostContactRadius * reach_m;
  edge = {edge.along, min_of(edge.across_m, most), min_of(edge.along_m, most)};
  Neighbourhood result = make_neighbourhood(NeighbourhoodLaw::kPunch, max_of(edge.across_m, edge.along_m), reach_m);
  result.tip = tip;
  result.edge = edge;
  return result;
}

Real neighbourhood_blend(const Neighbourhood& n, Vec3 from_middle) {
  const Real distance_m = norm(from_middle);
  if (n.law == NeighbourhoodLaw::kNone || !(distance_m < n.reach_m) || !is_finite(from_middle)) return 0;
  if (n.law == NeighbourhoodLaw::kPunch)
    return contact_profile(n.tip, n.edge.radii(from_middle)) *
           fade_out(distance_m, max_of(n.contact_radius_m, 0.5 * n.reach_m), n.reach_m);
  if (distance_m <= n.contact_radius_m) return 1;
  Real g = 0;
  switch (n.law) {
    case NeighbourhoodLaw::kLogPaper:
      g = n.log.a - n.log.b * math::log(distance_m);
      break;
    case NeighbourhoodLaw::kLogC1:
      g = c1_profile(distance_m / n.reach_m) * n.inverse_at_contact;
      break;
    case NeighbourhoodLaw::kPunch:
    case NeighbourhoodLaw::kNone:
      break;
  }
  return clamp_to(g, 0.0, 1.0);  // rounding may leave the interval at its ends
}

Real region_size_factor(Real area_m2, Real reference_area_m2) {
  if (!(area_m2 > 0 && reference_area_m2 > 0 && reference_area_m2 < area_m2)) return 1;
  return square_root(reference_area_m2 / area_m2);
}

}  // namespace palpate
