// The dent under one contact on a half space: travel, slope and stored energy over the force. What the body gives
// beyond it is the self term R and the modes.
#pragma once

namespace palpate::elastic {

// In space: a tool of revolution of radius R on a body of mean curvature k (method of dimensionality reduction, Popov &
// Hess 2015). With the contact's radius a:
//   sphere: travel 1/2 a L + k a^2, force E* (1/2 (a^2 + R^2) L - a R + 4/3 k a^3), L = ln((R + a)/(R - a)),
// the travel times (1 + 0.02 a/R) for large strain (bulk bodies in the prototype: 0.4 to 2.1 % without it).
// In the plane: Hertz's line contact, travel F/(pi E* w) (2 ln(2 l/a) + 1), a^2 = 4 F/(pi E* w (1/R + k)). A half plane
// has no travel at infinity: it is measured to the length l, which R of the body takes off again.
struct LocalLaw {
  bool plane = false;
  double tool_curvature_1pm = 0;  // 1/R; 0: a flat face
  double body_curvature_1pm = 0;  // mean; of the plane: of the line
  double modulus = 0;             // RestBody::contact_modulus: E*, in the plane times the width
  double length_m = 1;            // l of the plane

  struct State {
    double travel_m = 0;
    double compliance_mpN = 0;  // d travel / d force; infinite at no force
    double work_J = 0;          // int travel dF: the complementary energy
    double radius_m = 0;        // of the contact; in the plane half its width
  };
  State at(double force_N) const;
};

// Travel of a half space under its Gaussian load of unit force, averaged with the same Gaussian of deviation sigma:
// what R of a sample takes off the body's own. In the plane to the length l.
double gaussian_self_compliance_mpN(bool plane, double modulus, double sigma_m, double length_m);

}  // namespace palpate::elastic
