// The normal law of one tool tip: force over local indentation, for the shapes whose half-space solution is a power of
// the depth (Mahvash & Hayward 2002, table 1; Sneddon 1965), with the factor of a finite layer or of a true sphere.
#pragma once

#include "rt_core/contact/cubic_law.h"
#include "rt_core/model.h"
#include "rt_core/vec.h"

namespace palpate {

// One law, ready to evaluate. F(e) = c e^(n/2) S(x), x = sqrt(e / depth_max), n = 2, 3, 4; S = 1 without `factor`.
// Flat punch of radius R: c = 2 R E*; sphere: c = 4/3 sqrt(R) E*; cone, half angle alpha from its axis: c = 2/pi tan
// alpha E*, E* = E/(1 - nu^2). Beyond depth_max the force continues by its tangent, and a layer stiffens from there
// towards its plate. `factor` points to kFactorKnots entries.
struct LocalLaw {
  const TipLaw* tip = nullptr;
  const FactorKnot* factor = nullptr;
};

// Law of a piece. `piece` must be below n_tip_law.
LocalLaw local_law(const Model& model, std::int32_t piece) PALPATE_RT;

// Force and tangent at a local indentation; zero for e <= 0 (no adhesion) and NaN; e above kHuge counts as kHuge.
LawPoint local_at(const LocalLaw& law, Real e_m) PALPATE_RT;
// Integral of the force from zero: exact for the force above, also with a factor table.
Real local_energy_J(const LocalLaw& law, Real e_m) PALPATE_RT;
// What a place adds to the law where its give changes with the width of the contact (an elastic body's; the tick has
// them from c and beta of the place): force second e^2 + between e^2.5 + third e^3 + fourth e^4, beyond the law's range
// by its tangent.
struct PlaceTerms {
  Real second_N_per_m2 = 0, between_N_per_m25 = 0, third_N_per_m3 = 0, fourth_N_per_m4 = 0;
};
LawPoint place_at(const PlaceTerms& place, Real range_m, Real e_m) PALPATE_RT;
// Integral of that force from zero, by each of its terms: for one dent and several places' terms.
struct PlaceEnergies {
  Real of[4] = {};
  Real J(const PlaceTerms& place) const PALPATE_RT {
    return place.second_N_per_m2 * of[0] + place.between_N_per_m25 * of[1] + place.third_N_per_m3 * of[2] +
           place.fourth_N_per_m4 * of[3];
  }
};
PlaceEnergies place_energies(Real range_m, Real e_m) PALPATE_RT;
inline Real place_energy_J(const PlaceTerms& place, Real range_m, Real e_m) PALPATE_RT {
  return place_energies(range_m, e_m).J(place);
}

// Integral of the force over one interval of the factor table: what the baker adds up into FactorKnot::energy_J.
Real interval_energy_J(const LocalLaw& law, std::int32_t interval) PALPATE_RT;

// Force curves tabulated at the surface's vertices instead (Mahvash & Hayward 2002, eqs. 3 and 4): monotone C1 in
// depth, barycentric over a triangle.

// The three curves of one triangle with the area coordinates of a contact's foot.
struct TableLaw {
  const double* knot = nullptr;  // ascending from 0
  const ResponseKnot* curve[3] = {};
  Real weight[3] = {};
  std::int32_t knots = 0;
  bool root = false;  // the knots are roots of depths
};

// Of the curves of `piece`: the set that is its own.
TableLaw table_law(const Model& model, std::int32_t piece, std::int32_t triangle, const Real (&weight)[3]) PALPATE_RT;

// sum w_i f_i(e) and its tangent; zero for e <= 0 and NaN. Beyond the last knot the curves continue by their tangents.
// Bound: one binary search (6 steps).
LawPoint table_at(const TableLaw& law, Real e_m) PALPATE_RT;
// Energies of the three curves at e: their mean is the stored energy, their differences pull sideways.
struct CornerEnergies {
  Real energy_J[3] = {};
};
CornerEnergies table_energies(const TableLaw& law, Real e_m) PALPATE_RT;
// The three forces f_i(e), which the paper sums along the corners' own normals.
struct CornerForces {
  Real force_N[3] = {};
};
CornerForces table_forces(const TableLaw& law, Real e_m) PALPATE_RT;

}  // namespace palpate
