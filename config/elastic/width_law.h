// How what a body gives under its own contact changes as the contact widens, and what the tick makes of it.
//
// Under a patch of deviation sigma a place gives R(sigma) beyond a half space. Two patches tell R by one of three
// forms:
//   on a layer, R0 < 0: what a bonded layer of thickness h gives (config/response/layer_contact.h) + q sigma^2,
//     (1 / pi E* h) int_0 (L - 1) exp(-s^2 w^2) dw,  s = sigma / h;  where R falls faster than that, a share of what a
//     thinner one gives, as on a base that gives too. A stone five times as stiff, 7 mm down, is told as a layer of 7.3
//     mm; as one on a rigid base, of 16, a ball of 8 mm over it came out 7 % too soft (2026-11-25);
//   on a wall that gives less the wider: R0 + what a plate with free faces of thickness h does, the same integral from
//     w = 0.5 and less its value at s = 0, with L = (sinh w cosh w + w) / (sinh^2 w - w^2). Tubes of 10 and 9 mm are
//     then plates of 10.8 and 9.7, a ring of 20 one of 16.7, domes of 10 and 9 ones of 13; a parabola through both
//     patches instead left R0 1 to 7 % too small (2026-11-25);
//   elsewhere R0 + q sigma^2.
// A point force pulls the surface about it outwards, sigma_rr = (1 - 2 nu) F / (2 pi r^2). Where the surface bends that
// stress has a part across it, which a free surface has not: what takes it off, (1 - 2 nu) F k / (2 pi r) towards the
// middle with k the mean curvature, sinks the middle. So a convex place gives more the narrower the patch, by
//   s ln(1 / sigma),   s = (1 - 2 nu)^2 k / (2 pi (1 - nu) E*)
// beside the forms above (Cerruti's and Boussinesq's solutions). Nothing where nu = 1/2.
// A ball's contact of radius a is the patch a^2 / 5 (Hertz' pressure). With F(a), e(a) of the half space, on a curved
// body those of the ball and of a sphere as curved as the body one on the other, the complementary energy is that of
// the dent + F^2 R(a) / 2, to first order in what R does to the pressure, so that
//   travel = e + F R + (F^2 / 2) dR/da / (dF/da).
// On a bonded layer that is too stiff by (0.27 - 0.2 t) (D / h)^3 beside the layer's integral equation, and is divided
// by it: 0.3 % are left to D / h = 0.43 (t below). The tick takes R0 = c where it is positive as a spring in series and
// has the rest in closed form, with D the depth, rho = max(-c, 0), f = m D^1.5 the half space's law, z = rho m D^0.5:
//   F = f (1 + 1.5 z + 2.625 z^2) + beta R m^2 D^3,
// its first three terms those of D = e - rho F (m and R those of the tip on the curved body). beta and a part of c are
// fitted to the travel above and to what large strain adds, up to the deepest depth. Other tips have rho's terms alone.
//
// Large strain, of the force at the same depth, with t = (1 - 2 nu) / (1 - nu), x = sqrt(D / R), k the curvature of the
// body's sphere, g = 1/2 sum R k_i / (1 + 2 R k_i) of its principal curvatures that are positive:
//   1 + (0.25 t - 0.82 t^2.5 g - 0.066 (1 - k R)) x + 0.21 t^2 x^2 + (3.45 t - 0.1) l E* |R0| D,
//   l = 1 - 1 / (1 + 1.5 z0 + 2.625 z0^2),   E* |R0| D at most 0.25,
// z0 = |R0| m D^0.5. The part with t x is the surface's way along itself towards the axis, to where the ball is lower
// (Hay & Wolff 2001 have it as 0.21 t). The last is a layer that gets thinner, l the layer's share of the force;
// nothing where R0 > 0. The numbers are those of `press_axisymmetric` (neo-Hookean, nu 0 to 0.49, thickness 0.8 to 6
// radii, 0.4 radii deep, 0.7 on two) over the linear layer's: 0.4 % of its forces are left at nu = 0.3, 3.1 at nu = 0,
// 2.2 at 0.49 (2026-11-25, tests/strain/slow/test_width_calibration.cpp). Before, the travel had 2 % of a / R more
// whatever nu: a layer of nu 0.3 came out 17 % too soft at 29 % of its thickness. g was read off balls of 2 to 10
// radii, half a radius deep, over linear elements (the same test), and off a cylinder, a torus and the inside of one at
// nu 0.1 to 0.35 by elements in space (docs/accuracy.md): 1 to 3 % of their forces are left. Without it they were 5 to
// 11 % too stiff where nu is 0.2 or less (2026-11-28). On a plate of thickness h a share 1 / (1 + (4 R / h)^4) of what
// it adds is left: of seven walls of 1 to 2 radii, nu 0.2 to 0.47, five are nearer to their references with nothing of
// it, a dome of nu 0.2 by half of 6 %, and two farther by 0.1 and 0.2 %, a box by 0.6 (2026-11-28); the 4 is between
// them and a half space, and was not measured.
#pragma once

#include <array>
#include <cstdint>

namespace palpate::elastic {

class WidthLaw {
 public:
  WidthLaw() = default;
  // What two patches met, the second wider, where the surface has this mean curvature, convex positive.
  WidthLaw(const double (&met_mpN)[2], const double (&sigma_m)[2], double modulus_Pa, double poisson_ratio,
           double curvature_1pm);
  double give_mpN(double sigma_m) const;
  // Of the layer or plate that stands for the place, of a layer on a rigid base; 0: none.
  double thickness_m() const { return thickness_m_ / share_; }
  bool is_layer() const { return kind_ == Kind::kLayer; }
  bool is_plate() const { return kind_ == Kind::kPlate; }

 private:
  double less_noise_mpN(const double (&give_mpN)[2], const double (&sigma_m)[2]) const;
  enum class Kind : std::uint8_t { kPlain, kLayer, kPlate };
  void tell_layer(const double (&give_mpN)[2], const double (&sigma_m)[2]);
  void tell_plate(const double (&give_mpN)[2], const double (&sigma_m)[2]);
  double layer_mpN(double sigma_m, double thickness_m) const;  // on a rigid base
  double plate_mpN(double sigma_m, double thickness_m) const;  // less its give under no width
  Kind kind_ = Kind::kPlain;
  double narrow_mpN_ = 0;   // R0
  double square_1pmN_ = 0;  // q
  double share_ = 1;        // of the layer's loss: less than one where its base gives
  double curved_mpN_ = 0;   // less by so much with every e-fold of the deviation, that of the narrower patch = met_m_
  double thickness_m_ = 0, modulus_Pa_ = 0, poisson_ratio_ = 0, met_m_ = 1;
};

// A ball, or a paraboloid of the same radius, against a half space or a body curved like one.
struct BallLaw {
  double radius_m = 0, modulus_Pa = 0;
  bool paraboloid = false;
  double poisson_ratio = 0.5;
  double body_curvature_1pm = 0;          // of its sphere (equal_sphere_1pm), convex positive
  std::array<double, 2> principal_1pm{};  // of the body itself

  struct Point {
    double dent_m, force_N, force_slope_Npm;  // the slope in a
  };
  Point at(double a_m) const;
  double widest_m() const;  // a that at() takes
};

// Curvature of the sphere that a ball dents as it does a body of these principal curvatures: Hertz' ellipse. With their
// mean instead a ball on a torus of half again its radius was 1.7 % too soft at any depth.
double equal_sphere_1pm(const std::array<double, 2>& principal_1pm, double radius_m);

// Force at a depth on a place that gives `narrow_mpN` = R0 under no width, over that by small strain.
double large_strain_factor(const BallLaw& ball, double narrow_mpN, double depth_m);

// What the tick has of a place where it gives c_mpN under no width, the soft modes' share taken off: c_mpN +
// more_give_mpN, and beta.
struct PlaceFit {
  double more_give_mpN = 0, beta_1pmN = 0;
};
PlaceFit fit_place(const BallLaw& ball, const WidthLaw& width, double c_mpN, double depth_max_m);

}  // namespace palpate::elastic
