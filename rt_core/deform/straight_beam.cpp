#include "rt_core/deform/straight_beam.h"

namespace palpate {
namespace {

// k_b >= 1e-6 k_a: the smallest ratio that leaves 3x3 solves ten digits (condition number 1e6).
constexpr Real kLeastBendingRatio = 1e-6;

}  // namespace

StraightBeam make_straight_beam(const BeamMaterial& material, const BeamSection& section, Vec3 anchor, Vec3 contact,
                                Vec3 fallback_axis, BeamTheory theory, Real min_length_m) PALPATE_RT {
  StraightBeam beam;
  const Vec3 span = contact - anchor;
  beam.axis = unit_or(span, fallback_axis);
  beam.length_m = norm(span);
  const Real l2 = beam.length_m * beam.length_m + min_length_m * min_length_m;
  const Real l = square_root(l2);
  const Real e = material.youngs_modulus_Pa;
  const Real nu = material.poisson_ratio;
  const bool usable = l > 1e-12 && l < kHuge && e > 0 && section.area_m2 > 0 && section.inertia_m4 > 0 && nu > -1;
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

Vec3 beam_force(const StraightBeam& beam, Vec3 tip_displacement) PALPATE_RT {
  const Real along = (beam.axial_N_per_m - beam.bending_N_per_m) * dot(beam.axis, tip_displacement);
  return beam.bending_N_per_m * tip_displacement + along * beam.axis;
}

Vec3 beam_tip_displacement(const StraightBeam& beam, Vec3 tip_force) PALPATE_RT {
  if (!(beam.axial_N_per_m > 0 && beam.bending_N_per_m > 0)) return {};
  const Vec3 along = dot(beam.axis, tip_force) * beam.axis;
  return (1.0 / beam.axial_N_per_m) * along + (1.0 / beam.bending_N_per_m) * (tip_force - along);
}

BeamStress anchor_stress(const StraightBeam& beam, const BeamSection& section, Real poisson_ratio,
                         Vec3 tip_force) PALPATE_RT {
  BeamStress stress;
  if (!(section.area_m2 > 0 && section.inertia_m4 > 0)) return stress;
  const Real axial_N = dot(beam.axis, tip_force);
  const Real transverse_N = norm(tip_force - axial_N * beam.axis);
  stress.axial_Pa = axial_N / section.area_m2;
  stress.bending_Pa = transverse_N * beam.length_m * section.radius_m / section.inertia_m4;
  stress.shear_Pa = section_shear(section, poisson_ratio, transverse_N, 0, 0).xy_Pa;
  return stress;
}

SectionShear section_shear(const BeamSection& section, Real poisson_ratio, Real transverse_force_N, Real y_m,
                           Real z_m) PALPATE_RT {
  const Real nu = poisson_ratio;
  const Real denominator = 2.0 * (1.0 + nu) * section.inertia_m4;
  if (!(denominator > 0)) return {};
  const Real scale = transverse_force_N / denominator;
  const Real r2 = section.radius_m * section.radius_m;
  const Real y2 = y_m * y_m;
  const Real z2 = z_m * z_m;
  const Real phi_y = (3.0 + 2.0 * nu) * r2 / 4.0 + (1.0 + 2.0 * nu) * (y2 - z2) / 4.0;
  const Real phi_z = -(1.0 + 2.0 * nu) * y_m * z_m / 2.0;
  return {scale * (phi_y + nu * z2 - (1.0 + nu) * y2), scale * phi_z};
}

Vec3 released_displacement(const StraightBeam& beam, Vec3 tip_displacement, Real release_length_m) PALPATE_RT {
  if (!(release_length_m > 0)) return {};
  const Real lambda = release_length_m < beam.length_m ? release_length_m / beam.length_m : 1.0;
  const Real g = lambda * lambda * (3.0 - lambda) / 2.0;
  return g * tip_displacement + ((lambda - g) * dot(beam.axis, tip_displacement)) * beam.axis;
}

}  // namespace palpate
