// Two contacts on one body, to second order, from a complementary energy (so that loops return no energy):
//   U*(F1, F2) = U1*(F1) + U2*(F2) + c F1 F2 + h12 F1^2 F2 / 2 + h21 F2^2 F1 / 2
//   d1 = D1(F1) + c F2 + h12 F1 F2 + h21 F2^2 / 2,   d2 likewise.
// What the references fit to states of both contacts; a scene's pairs come from presses of one (config/fem/pair_fit.h).
#pragma once

#include <optional>
#include <vector>

#include "config/fem/pair_fit.h"

namespace palpate::fem {

struct PairState {
  double first_m = 0, second_m = 0;
  double first_N = 0, second_N = 0;
};
struct PairCoupling {
  double c_m_per_N = 0;
  double h12_m_per_N2 = 0, h21_m_per_N2 = 0;
};

// Least squares over two or more large-strain states with both forces positive. `c_m_per_N` is best known from a linear
// solve with one contact: the surface's displacement at the other one, along its press, per force (as the difference of
// two contact laws it drowns in their mesh error). Without it c is fitted too.
PairCoupling fit_pair(std::optional<double> c_m_per_N, const DepthOfForce& first, const DepthOfForce& second,
                      const std::vector<PairState>& large);

// Forces at given depths, none below zero. The energy must be convex where the answer lies.
PairState solve_pair(const DepthOfForce& first, const DepthOfForce& second, const PairCoupling& coupling,
                     double first_m, double second_m);

// Travel over force by straight lines between points that start at the origin and rise; the last line goes on.
DepthOfForce depth_table(std::vector<LoadPoint> points);

}  // namespace palpate::fem
