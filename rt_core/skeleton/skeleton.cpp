#include "rt_core/skeleton/skeleton.h"

#include "rt_core/cholesky.h"

namespace palpate {
namespace {

void clear_forces(Skeleton& skeleton) PALPATE_RT {
  skeleton.degenerate = false;
  skeleton.minimum_norm = false;
  skeleton.common = false;
  skeleton.alpha_Pa = 0;
  skeleton.beta_Pa = 0;
  skeleton.displacement_w = {};
  for (std::int32_t i = 0; i < skeleton.count; ++i) skeleton.force_w[i] = {};
}

}  // namespace

SkeletonSetup skeleton_setup(const Model& model) PALPATE_RT {
  SkeletonSetup setup;
  setup.material = {model.params.youngs_modulus_Pa, model.params.poisson_ratio};
  const SkeletonLaw law = model.params.skeleton_law;
  setup.theory = shares_by_ratios(law) ? BeamTheory::kEulerBernoulli : BeamTheory::kTimoshenko;
  setup.guard_length = law != SkeletonLaw::kPaper;
  return setup;
}

void build_skeleton(const SkeletonSetup& setup, std::span<const Anchor> anchor, std::span<const Vec3> offset_w,
                    Vec3 contact_w, Skeleton& skeleton) PALPATE_RT {
  const auto available = static_cast<std::int64_t>(anchor.size());
  skeleton.count = available < kMaxAnchors ? static_cast<std::int32_t>(available) : kMaxAnchors;
  for (std::int32_t i = 0; i < skeleton.count; ++i) {  // <= kMaxAnchors
    const auto at = static_cast<std::size_t>(i);
    const Anchor& a = anchor[at];
    const Vec3 position = offset_w.empty() ? a.position_m : a.position_m + offset_w[at];
    const Real min_length_m = setup.guard_length ? 2.0 * a.section_radius_m : 0.0;
    skeleton.beam[i] =
        make_straight_beam(setup.material, section_of(a), position, contact_w, a.normal, setup.theory, min_length_m);
  }
  clear_forces(skeleton);
}

bool distribute_by_stiffness(Vec3 force_on_body_w, Skeleton& skeleton) PALPATE_RT {
  clear_forces(skeleton);
  Real k[9] = {};                                      // lower triangle of K
  for (std::int32_t i = 0; i < skeleton.count; ++i) {  // <= kMaxAnchors
    const StraightBeam& beam = skeleton.beam[i];
    const Vec3 x = beam.axis;
    const Vec3 w = (beam.axial_N_per_m - beam.bending_N_per_m) * x;
    k[0] += beam.bending_N_per_m + w.x * x.x;
    k[3] += w.y * x.x;
    k[4] += beam.bending_N_per_m + w.y * x.y;
    k[6] += w.z * x.x;
    k[7] += w.z * x.y;
    k[8] += beam.bending_N_per_m + w.z * x.z;
  }
  skeleton.degenerate = !(cholesky_factor(k, 3) && is_finite(force_on_body_w));
  if (skeleton.degenerate) return false;

  Real d[3] = {force_on_body_w.x, force_on_body_w.y, force_on_body_w.z};
  cholesky_solve(k, d, 3);
  skeleton.displacement_w = {d[0], d[1], d[2]};
  skeleton.common = true;
  for (std::int32_t i = 0; i < skeleton.count; ++i) {
    skeleton.force_w[i] = beam_force(skeleton.beam[i], skeleton.displacement_w);
  }
  return true;
}

bool distribute_by_ratios(Real youngs_modulus_Pa, Vec3 force_on_body_w, Skeleton& skeleton) PALPATE_RT {
  clear_forces(skeleton);
  skeleton.degenerate = !(is_finite(force_on_body_w) && youngs_modulus_Pa > 0);
  if (skeleton.degenerate) return false;
  const Vec3 direction = unit_or(force_on_body_w, {});

  // Columns u = A D and v = B D, with A = sum S/l x x^T and B = sum I/l^3 (1 - x x^T).
  const Real per_axial = 1.0 / youngs_modulus_Pa;
  const Real per_bending = per_axial / 3.0;
  Vec3 u, v;
  for (std::int32_t i = 0; i < skeleton.count; ++i) {  // <= kMaxAnchors
    const StraightBeam& beam = skeleton.beam[i];
    const Vec3 along = dot(beam.axis, direction) * beam.axis;
    u += (per_axial * beam.axial_N_per_m) * along;
    v += (per_bending * beam.bending_N_per_m) * (direction - along);
  }
  // A contact at an anchor: its beam has no direction, and I/l^3 is not a number.
  for (std::int32_t i = 0; i < skeleton.count; ++i)  // bound: kMaxAnchors
    if (!(skeleton.beam[i].axial_N_per_m > 0)) skeleton.degenerate = true;
  if (skeleton.degenerate) return false;
  const RatioScales scales = solve_ratio_scales(u, v, force_on_body_w);
  skeleton.alpha_Pa = scales.alpha;
  skeleton.beta_Pa = scales.beta;
  skeleton.minimum_norm = scales.minimum_norm;
  skeleton.degenerate = !scales.solvable;
  if (skeleton.degenerate) return false;
  for (std::int32_t i = 0; i < skeleton.count; ++i) {
    const StraightBeam& beam = skeleton.beam[i];
    const Vec3 along = dot(beam.axis, direction) * beam.axis;
    skeleton.force_w[i] = (skeleton.alpha_Pa * per_axial * beam.axial_N_per_m) * along +
                          (skeleton.beta_Pa * per_bending * beam.bending_N_per_m) * (direction - along);
  }
  return true;
}

bool solve_skeleton(const Model& model, std::span<const Vec3> offset_w, Vec3 contact_w, Vec3 force_on_body_w,
                    Skeleton& skeleton) PALPATE_RT {
  return solve_skeleton_on(model, model.anchor, offset_w, contact_w, force_on_body_w, skeleton);
}

bool solve_skeleton_on(const Model& model, std::span<const Anchor> end, std::span<const Vec3> offset_w, Vec3 contact_w,
                       Vec3 force_on_body_w, Skeleton& skeleton) PALPATE_RT {
  const auto law = model.params.skeleton_law;
  skeleton.count = 0;
  clear_forces(skeleton);
  if (law == SkeletonLaw::kNone || end.empty()) return false;
  build_skeleton(skeleton_setup(model), end, offset_w, contact_w, skeleton);
  if (shares_by_ratios(law)) {
    return distribute_by_ratios(model.params.youngs_modulus_Pa, force_on_body_w, skeleton);
  }
  return distribute_by_stiffness(force_on_body_w, skeleton);
}

}  // namespace palpate
