// Force curves tabulated at the surface's vertices (Mahvash & Hayward 2002, eqs. 3 and 4): monotone C1 in depth,
// barycentric over a triangle.
#pragma once

#include "rt_core/contact/cubic_law.h"
#include "rt_core/model.h"
#include "rt_core/vec.h"

namespace palpate {

// The three curves of one triangle with the area coordinates of a contact's foot.
struct TableLaw {
  const double* knot = nullptr;  // ascending from 0
  const ResponseKnot* curve[3] = {};
  Real weight[3] = {};
  std::int32_t knots = 0;
  bool root = false;  // the knots are roots of depths
};

TableLaw table_law(const Model& model, std::int32_t triangle, const Real (&weight)[3]) PALPATE_RT;

// sum w_i f_i(e) and its tangent; zero for e <= 0 and NaN. Beyond the last knot the curves continue by their tangents.
// Bound: one binary search (6 steps).
LawPoint table_at(const TableLaw& law, Real e_m) PALPATE_RT;
// Energies of the three curves at e: their mean is the stored energy, their differences pull sideways.
struct CornerEnergies {
  Real energy_J[3] = {};
};
CornerEnergies table_energies(const TableLaw& law, Real e_m) PALPATE_RT;

}  // namespace palpate
