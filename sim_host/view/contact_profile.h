// The surface of an elastic half space under and around a tip that presses it, for everything that draws a dent.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

// Frictionless, axisymmetric (Sneddon 1965). kBall: a paraboloid (Hertz; Johnson 1985, eqs. 3.42).
enum class TipShape { kBall, kCone, kFlat };

// Displacement over its value at the centre, at `rho` >= 0 contact radii from it. Inside (rho <= 1) it is the tip:
//   ball 1 - rho^2/2, cone 1 - 2 rho/pi, flat 1;
// outside, as far as the half space goes:
//   ball ((2 - rho^2) asin(1/rho) + sqrt(rho^2 - 1))/pi, cone 2/pi (asin(1/rho) - rho + sqrt(rho^2 - 1)),
//   flat 2/pi asin(1/rho).
// All fall like 1/rho from far away. Continuous; for ball and cone the slope is, too.
Real contact_profile(TipShape shape, Real rho);

// Pressure under the tip over its mean F/(pi a b), by the same solutions; it adds up to the force:
//   ball 3/2 sqrt(1 - rho^2), cone acosh(1/rho), flat 1/(2 sqrt(1 - rho^2)); 0 from rho = 1 on.
// Infinite at a cone's point and at the edge of a flat end.
Real contact_pressure(TipShape shape, Real rho);

// How far a frictionless ball's contact draws the surface in towards its middle, over that at the contact's edge
// (contact_drawn_in_by_force), by Hertz' pressure (Johnson 1985, eqs. 3.41b and 3.42b): nothing in the middle, inside
// (1 - (1 - rho^2)^1.5) / rho, outside 1/rho.
Real contact_drawn_in(Real rho);
// At the edge, of force / (contact modulus x radius): (1 - 2 nu) / (2 pi (1 - nu)). 0 for a material that keeps its
// volume.
Real contact_drawn_in_by_force(Real poisson_ratio);

// How far a deep ball moves the surface outwards beyond that, of force / (contact modulus x ball's radius), at Hertz'
// radius for the force: its pressure leans outwards by its slope, and around the contact the surface is drawn down into
// the dent, from far away like 1 / rho^3, as F^2 is. Second order in contact over ball. Outward tractions p r / R alone
// would do 3/8 rho (1 - 3/4 rho^2) to a half space; elements take half of it back. Read off neo-Hookean axisymmetric
// elements on a block ten balls high (2026-11-26), nu of 0.15 to 0.49: within an eighth of its largest where the
// contact is 0.6 of the ball's radius or wider, and up to a quarter of it too much at 0.4, where it is that much less.
Real contact_spread(Real rho, Real poisson_ratio);

// Half spaces end: 1 up to `from_m`, 0 from `to_m` on, between them falling without a kink.
Real fade_out(Real distance_m, Real from_m, Real to_m);

// The edge of a contact: an ellipse on the surface about a place, its longer axis along `along` (unit).
struct ContactEllipse {
  Vec3 along;
  Real across_m = 0, along_m = 0;  // half axes, > 0

  // Distance from its middle in contact radii. The whole distance counts, not that on the surface: what lies far below
  // the tip, as a ring's other side, is far from it.
  Real radii(Vec3 from_middle) const;
  // Beyond the edge (radii() >= 1) by the ellipses with the same foci instead, as far as the mean of their half axes in
  // those of the edge: from far away all directions are alike.
  Real radii_outside(Vec3 from_middle) const;
};

// How a surface bends at a place: principal curvatures (1/m, positive where it bulges), the smaller one along `along`.
struct SurfaceBend {
  Vec3 along{1, 0, 0};
  Real most_1_per_m = 0, least_1_per_m = 0;
};

// The edge of a ball's contact `depth_m` deep (> 0): where the surface leaves the ball, at half the depth. In each
// principal direction the square of the half axis is depth over relative curvature, 1/ball_radius_m + that of the
// surface, or a quarter of the ball's where a hollow surface fits it.
ContactEllipse ball_contact(Real depth_m, Real ball_radius_m, const SurfaceBend& surface);

}  // namespace palpate
