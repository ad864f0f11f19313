// One straight beam of the skeleton: clamped at an anchor, loaded at the contact point (Luo & Xiao 2006, section V).
// Inline, because everything here is called once per anchor and tick and passing these structs costs as much as the
// sums.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

// kTimoshenko adds the shear compliance l/(kappa G S); without it beams about as thick as they are long, which
// skeletons are full of, are absurdly stiff in bending. kEulerBernoulli is the paper's theory.
enum class BeamTheory : std::int32_t { kTimoshenko = 0, kEulerBernoulli = 1 };

struct BeamMaterial {
  Real youngs_modulus_Pa = 0;
  Real poisson_ratio = 0;  // (-1, 0.5]
};

// Circular section of radius r: S = pi r^2, I = pi r^4 / 4. Area, inertia and radius are > 0.
struct BeamSection {
  Real area_m2 = 0;
  Real inertia_m4 = 0;
  Real radius_m = 0;
};

struct StraightBeam {
  Vec3 axis;                 // unit, from the anchor to the contact point
  Real length_m = 0;         // true length
  Real axial_N_per_m = 0;    // k_a = E S / l
  Real bending_N_per_m = 0;  // k_b = 1 / (l^3/(3EI) + l/(kappa G S)), or 3EI/l^3
};

// k_b >= 1e-6 k_a: the smallest ratio that leaves 3x3 solves ten digits (condition number 1e6).
inline constexpr Real kLeastBendingRatio = 1e-6;

// A beam shorter than a nanometre has no direction: that is the rounding of places on a body of metres, and forces of
// (l / 1 mm)^-3 would leave the range of doubles' squares soon after.
inline constexpr Real kLeastLength_m = 1e-9;

// Beam from `anchor` to `contact`. `fallback_axis` (unit) is used where the two coincide. The stiffness is taken at
// l_eff = sqrt(l^2 + min_length_m^2), which keeps it finite for a contact at the anchor; min_length_m = 0 gives the
// bare formulas (then l must be above kLeastLength_m). Bending stiffness is kept at or above 1e-6 of the axial one, so
// that a skeleton of collinear beams stays regular. Zero stiffness when an input is not finite or not positive.
inline StraightBeam make_straight_beam(const BeamMaterial& material, const BeamSection& section, Vec3 anchor,
                                       Vec3 contact, Vec3 fallback_axis, BeamTheory theory,
                                       Real min_length_m) PALPATE_RT {
  StraightBeam beam;
  const Vec3 span = contact - anchor;
  beam.axis = unit_or(span, fallback_axis);
  beam.length_m = norm(span);
  const Real l2 = beam.length_m * beam.length_m + min_length_m * min_length_m;
  const Real l = square_root(l2);
  const Real e = material.youngs_modulus_Pa;
  const Real nu = material.poisson_ratio;
  // The first term is false for NaN, which norm() hides; the second bounds the rest.
  const bool usable = squared_norm(span) >= 0 && l > kLeastLength_m && l < kHuge && e > 0 && section.area_m2 > 0 &&
                      section.inertia_m4 > 0 && nu > -1;
  if (!usable) return beam;

  beam.axial_N_per_m = e * section.area_m2 / l;
  Real compliance = l2 * l / (3.0 * e * section.inertia_m4);
  if (theory == BeamTheory::kTimoshenko) {
    // l/(kappa G S) with kappa = 6(1+nu)/(7+6nu) (circle, Cowper 1966) and G = E/(2(1+nu)): (1+nu) cancels.
    compliance += l * (7.0 + 6.0 * nu) / (3.0 * e * section.area_m2);
  }
  beam.bending_N_per_m = max_of(1.0 / compliance, kLeastBendingRatio * beam.axial_N_per_m);
  return beam;
}

// K_i d = k_b d + (k_a - k_b) (x.d) x: force on the tip for tip displacement d.
inline Vec3 beam_force(const StraightBeam& beam, Vec3 tip_displacement) PALPATE_RT {
  const Real along = (beam.axial_N_per_m - beam.bending_N_per_m) * dot(beam.axis, tip_displacement);
  return beam.bending_N_per_m * tip_displacement + along * beam.axis;
}
// K_i^-1 f; zero for a beam without stiffness.
inline Vec3 beam_tip_displacement(const StraightBeam& beam, Vec3 tip_force) PALPATE_RT {
  if (!(beam.axial_N_per_m > 0 && beam.bending_N_per_m > 0)) return {};
  const Vec3 along = dot(beam.axis, tip_force) * beam.axis;
  return (1.0 / beam.axial_N_per_m) * along + (1.0 / beam.bending_N_per_m) * (tip_force - along);
}

// Displacement of the anchor when its clamp is released over `release_length_m` (s): that of the beam's point at x = s,
// g d + (lambda - g)(x.d) x with lambda = min(1, s/l), g = (3 lambda^2 - lambda^3)/2, the Euler-Bernoulli deflection
// line scaled to the tip displacement d. A strain at one point fixes no displacement, so the paper's "compute the
// displacement from the strain" needs this length; s = pi r (1 - nu^2)/2 makes the axial part that of a rigid circular
// foot on a half space. Same formula with d = the dent instead of the skeleton's own tip displacement: the kinematic
// variant, in which E cancels. s <= 0: the anchor keeps still.
inline Vec3 released_displacement(const StraightBeam& beam, Vec3 tip_displacement, Real release_length_m) PALPATE_RT {
  if (!(release_length_m > 0)) return {};
  const Real lambda = release_length_m < beam.length_m ? release_length_m / beam.length_m : 1.0;
  const Real g = lambda * lambda * (3.0 - lambda) / 2.0;
  return g * tip_displacement + ((lambda - g) * dot(beam.axis, tip_displacement)) * beam.axis;
}

}  // namespace palpate
