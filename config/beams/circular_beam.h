// One circular cantilever beam: a curved bar of rectangular section, clamped at an anchor and loaded at the contact
// point, as exact plane-stress elasticity (the beams of objects with holes).
//
// Polar frame: centre C; theta = 0 at the loaded tip, theta = angle at the clamp; inner radius a, outer radius b,
// thickness t across the plane. The face at the tip has the outward normal -theta^. Forces and displacements at the tip
// are components along r^ and theta^ there; the out-of-plane axis is r^ x theta^.
// Golovin's solution (Timoshenko & Goodier 1951, sections 28, 29 and 33) in the form
//   N = a^2 - b^2 + (a^2 + b^2) s,  N' = (b^2 - a^2)^2 - 4 a^2 b^2 s^2,  s = ln(b/a).
#pragma once

#include "rt_core/skeleton/straight_beam.h"

namespace palpate {

struct ArcSection {
  Real inner_m = 0;      // a > 0
  Real outer_m = 0;      // b > a
  Real thickness_m = 0;  // t > 0
};
inline Real middle_radius_m(const ArcSection& section) PALPATE_RT { return 0.5 * (section.inner_m + section.outer_m); }

// Everything at the tip: a force whose line of action passes through the centre C (radial and tangential parts) and a
// couple about the out-of-plane axis. A tangential force that acts at the radius r_p instead of at C is itself through
// C plus the couple r_p times itself.
struct ArcLoad {
  Real radial_N = 0;      // along r^ at the tip
  Real tangential_N = 0;  // along theta^ at the tip, its line through C
  Real couple_Nm = 0;
};
inline ArcLoad tip_force(Real radial_N, Real tangential_N, Real radius_m) PALPATE_RT {
  return {radial_N, tangential_N, tangential_N * radius_m};
}

struct PolarStress {
  Real radial_Pa = 0, hoop_Pa = 0, shear_Pa = 0;
};
struct PolarVector {
  Real radial_m = 0, tangential_m = 0;
};

// The functions of s every quantity here is made of, without cancellation at any s in (0, 8]: power series of positive
// terms below kArcSeriesBelow, hyperbolic functions above. Both are good to 4e-15 at the switch; the closed forms have
// lost 3e-11 at s = 0.1 and everything at s = 1e-4, the series needs more than its terms beyond s = 1.5 (measured
// against 60 digits, 2026-11-21: docs/models_circular_beams.md).
inline constexpr Real kArcSeriesBelow = 1.0;
struct ArcFunctions {
  Real s = 0;        // ln(b/a)
  Real q_m2 = 0;     // ab
  Real n_hat = 0;    // N / (ab) = 2 (s cosh s - sinh s)
  Real n_bar = 0;    // N' / (ab)^2 = 4 (sinh^2 s - s^2)
  Real t = 0;        // 4 / (s - tanh s)
  Real j2 = 0;       // int of S_r^2, scaled
  Real j3_sqrt = 0;  // J3 sqrt(ab), negative
  Real j4_area = 0;  // J4 ab
};
// ln(b/a), accurate for thin sections too.
Real arc_log_ratio(const ArcSection& section) PALPATE_RT;
ArcFunctions arc_functions(const ArcSection& section, Real poisson_ratio) PALPATE_RT;

// Stresses at radius r in [a, b] and angle theta. Equilibrium, compatibility and free curved faces hold exactly.
PolarStress arc_stress(const ArcSection& section, const ArcLoad& load, Real r_m, Real theta) PALPATE_RT;
// The stresses as printed in the circular-beam paper (2009, section III.A): those of a force through the centre, with
// the sign of its tangential part reversed, no shear, no couple. Per unit thickness there; divided by t here.
PolarStress arc_stress_paper(const ArcSection& section, Real f1_N, Real f2_N, Real r_m, Real theta) PALPATE_RT;

// Displacement at (r, theta) with the clamp of Timoshenko & Goodier: u = v = dv/dr = 0 at the middle radius of the
// section theta = angle. Strains follow from it by eps_r = du/dr, eps_theta = u/r + (dv/dtheta)/r, gamma =
// (du/dtheta)/r + dv/dr - v/r; the paper prints (d/dr, d/dtheta), which is not the polar kinematics.
PolarVector arc_displacement(const ArcSection& section, const BeamMaterial& material, Real angle, const ArcLoad& load,
                             Real r_m, Real theta) PALPATE_RT;

// Compliance of the tip for forces at radius r_p, from the exact strain energy: symmetric, positive definite.
struct ArcCompliance {
  Real rr_m_per_N = 0;  // radial displacement per radial force
  Real rt_m_per_N = 0;
  Real tt_m_per_N = 0;
  Real zz_m_per_N = 0;  // out of plane: thin-ring bending, torsion (Saint-Venant's constant of a rectangle) and shear
};
ArcCompliance arc_tip_compliance(const ArcSection& section, const BeamMaterial& material, Real angle,
                                 Real force_radius_m) PALPATE_RT;

// The paper's own relation at radius r_p: displacements (u, v) of the tip per unit F1 and F2 of equations (2) to (5).
// F1 pushes inwards, -F1 r^; F2 acts through the centre, so that u and v per F2 are not those of a force at the tip,
// and the matrix is neither symmetric nor definite.
struct ArcPaperCompliance {
  Real u1_m_per_N = 0, u2_m_per_N = 0, v1_m_per_N = 0, v2_m_per_N = 0;
};
ArcPaperCompliance arc_paper_compliance(const ArcSection& section, const BeamMaterial& material, Real angle,
                                        Real force_radius_m) PALPATE_RT;

// Saint-Venant's torsion constant of a rectangle (Roark), m^4: within 0.5 % of the series solution.
Real rectangle_torsion_m4(Real side_m, Real other_side_m) PALPATE_RT;

}  // namespace palpate
