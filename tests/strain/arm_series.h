// The series law of an elastic arm pushed at its round tip in any direction of a plane: displacement of the tip
// u = C f + H(f, f) / 2 from the complementary energy f C f / 2 + H(f, f, f) / 6. Linear in the material, second order
// in the arm's rotation: what a snap clip needs, whose arms turn by 10 degrees while its strain stays small.
#pragma once

#include <array>

#include "config/fem/large_strain_mesh.h"

namespace palpate::fem {

struct ArmState {
  Point<2> force_N{}, tip_m{};  // dead load at the tip and the tip's displacement
};
struct ArmSeries {
  std::array<double, 3> c_m_per_N{};   // xx, xy, yy
  std::array<double, 4> h_m_per_N2{};  // xxx, xxy, xyy, yyy
};
// `along_x` and `along_y`: linear states under a load along each axis. `large`: two large-strain states whose loads are
// not parallel, at about the largest load met.
ArmSeries fit_arm(const ArmState& along_x, const ArmState& along_y, const std::array<ArmState, 2>& large);

Point<2> arm_tip_m(const ArmSeries& arm, const Point<2>& force_N);

// Force on the tip's circle by a rigid disc whose edge it touches: zero while they are apart. `reach_m`: both radii
// together, `tip_rest_m` and `disc_m` the centres.
Point<2> arm_force_from_disc_N(const ArmSeries& arm, const Point<2>& tip_rest_m, const Point<2>& disc_m,
                               double reach_m);

}  // namespace palpate::fem
