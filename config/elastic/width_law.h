// How what a body gives under its own contact changes as the contact widens, and what the tick makes of it.
//
// Under a patch of deviation sigma a place gives R(sigma) beyond a half space. On a wall R falls as R0 - k sigma^2 (the
// wall bends less under a wider load). On a layer R0 < 0, and R = R0 / sqrt(1 + b sigma^2): the layer's whole give
// half space + R falls to zero for a wide contact, never below, which asks b = 4 pi (E* R0)^2 at least; by the integral
// kernel of a bonded layer (Hayes et al. 1972) it is that within 2 %. Two patches tell b or k.
// A ball's contact of radius a is the patch a^2 / 5 (Hertz' pressure). With F(a), e(a) of the half space the
// complementary energy is that of the dent + F^2 R(a) / 2, to first order in what R does to the pressure, so that
//   travel = e + F R + (F^2 / 2) dR/da / (dF/da).
// On a bonded layer as thick as the ball's radius 1.6 that is within 2.7 % of large-strain elements to 40 % of its
// thickness (2026-11-23). The tick takes R0 = c where it is positive as a spring in series and has the rest in closed
// form, with D the depth, rho = max(-c, 0), f = m D^1.5 the half space's law, z = rho m D^0.5:
//   F = f (1 + 1.5 z + 2.625 z^2) + beta R m^2 D^3,
// its first three terms those of D = e - rho F, beta fitted to the travel above up to the deepest depth (0.3 to 1.2 %
// on that layer), and to what large strain adds to the dent. Other tips have rho's terms alone.
#pragma once

namespace palpate::elastic {

class WidthLaw {
 public:
  WidthLaw() = default;
  // What two patches met, the second wider.
  WidthLaw(const double (&give_mpN)[2], const double (&sigma_m)[2], double modulus_Pa);
  double give_mpN(double sigma_m) const;

 private:
  double narrow_mpN_ = 0;  // R0
  double change_ = 0;      // b in 1/m^2 on a layer, otherwise k in 1/(N m)
  bool is_layer_ = false;
};

// A ball, or a paraboloid of the same radius, against a half space.
struct BallLaw {
  double radius_m = 0, modulus_Pa = 0;
  bool paraboloid = false;

  struct Point {
    double dent_m, force_N, force_slope_Npm;  // the slope in a
  };
  Point at(double a_m) const;
};

// beta, where the place gives c_mpN under no width, the soft modes' share taken off.
double fit_beta(const BallLaw& ball, const WidthLaw& width, double c_mpN, double depth_max_m);

}  // namespace palpate::elastic
