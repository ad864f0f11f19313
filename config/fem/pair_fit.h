// Two contacts on one body, to second order, from a complementary energy (so that loops return no energy):
//   U*(F1, F2) = U1*(F1) + U2*(F2) + c F1 F2 + h12 F1^2 F2 / 2 + h21 F2^2 F1 / 2
//   d1 = D1(F1) + c F2 + h12 F1 F2 + h21 F2^2 / 2,   d2 likewise.
#pragma once

#include <optional>
#include <vector>

#include "config/fem/series_fit.h"

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

// The same from presses of one contact each. With G = 0 the energy's terms in F^2 G say how far the surface at the
// other place has sunk, c F + h F^2 / 2: no state with two contacts is needed. Exact where forces are small; in bodies
// that sway fit_pair's states do better.
//
// Nodes of a level top (y = 0 at rest) where `u_m` takes them, by rising rest x.
std::vector<Point<2>> top_line(const StrainMesh<2>& mesh, const std::vector<double>& u_m);
// How far a tool must come down at x = `at_m` to touch the line: of a ball the tilt counts too.
double touch_depth_m(const std::vector<Point<2>>& line, const RigidTool& tool, double at_m);
// c and h of one press, from travels at which the other tool just touches over the force of the one that presses: a
// straight line through travel / force. (A linear press's c is 6 % off on a plane block under a patch a fifth as wide
// as the distance, because it takes the patch's width at that depth for the limit: measured 2026-11-21.)
struct TouchFit {
  double c_m_per_N = 0, h_m_per_N2 = 0;
};
TouchFit fit_touch(const std::vector<LoadPoint>& touch);

// Forces at given depths, none below zero. The energy must be convex where the answer lies.
PairState solve_pair(const DepthOfForce& first, const DepthOfForce& second, const PairCoupling& coupling,
                     double first_m, double second_m);

// Travel over force by straight lines between points that start at the origin and rise; the last line goes on.
DepthOfForce depth_table(std::vector<LoadPoint> points);

}  // namespace palpate::fem
