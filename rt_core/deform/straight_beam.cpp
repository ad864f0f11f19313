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
  const bool usable =
      is_finite(span) && l > 1e-12 && l < kHuge && e > 0 && section.area_m2 > 0 && section.inertia_m4 > 0 && nu > -1;
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

}  // namespace palpate
