// What a patch of unit force on half a space does to its surface: a Gaussian of deviation sigma, along the inward
// normal, frictionless.
#pragma once

namespace palpate::elastic {

struct PatchAnswer {
  double inward_mpN = 0, outward_mpN = 0;  // outward: away from the patch's middle, along the surface
};
// At a distance from its middle. By Hankel transforms (Johnson 1985, eqs. 3.18 and 3.19 for the point force):
//   inward = sqrt(pi / 2) exp(-z) I0(z) / (pi E* sigma), z = r^2 / (4 sigma^2),
//   outward = -(1 - 2 nu) / (2 pi (1 - nu) E*) (1 - exp(-r^2 / (2 sigma^2))) / r.
PatchAnswer gaussian_patch_answer(double distance_m, double sigma_m, double modulus_Pa, double poisson_ratio);

}  // namespace palpate::elastic
