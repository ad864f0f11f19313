// The surface of a level top that one contact has pressed, and how far another contact sinks with it, to second order:
// c and h of the pair's complementary energy U* = U1*(F1) + U2*(F2) + c F1 F2 + h12 F1^2 F2 / 2 + h21 F2^2 F1 / 2 from
// presses of one contact each. With F2 = 0 the energy's terms in F1^2 F2 say how far the surface at the other place has
// sunk, c F + h F^2 / 2: no state with two contacts is needed. Exact where forces are small.
#pragma once

#include <vector>

#include "config/fem/series_fit.h"

namespace palpate::fem {

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

}  // namespace palpate::fem
