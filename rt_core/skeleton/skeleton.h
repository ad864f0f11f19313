// The beam skeleton: straight beams from one contact point to every anchor, sharing the contact force.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/limits.h"
#include "rt_core/model.h"
#include "rt_core/skeleton/straight_beam.h"

namespace palpate {

// The two unknown scales of the paper's force ratios.
struct RatioScales {
  Real alpha = 0, beta = 0;
  bool minimum_norm = false;  // the columns are parallel: the smallest solution was taken
  bool solvable = false;      // false: both columns are zero, but there is a force to share
};

// Columns nearer to parallel than this (sine of the angle) are taken as parallel. Below it the two scales are the
// difference of nearly equal things: an anchor misplaced by 1 % of the body moves them by their own size.
inline constexpr Real kParallelSine = 1e-2;

// alpha u + beta v = f in the least-squares sense: three equations for two unknowns.
inline RatioScales solve_ratio_scales(Vec3 u, Vec3 v, Vec3 f) PALPATE_RT {
  RatioScales scales;
  scales.solvable = true;
  const Real uu = squared_norm(u);
  const Real vv = squared_norm(v);
  const Vec3 normal = cross(u, v);
  const Real area2 = squared_norm(normal);  // |u|^2 |v|^2 sin^2
  if (area2 > kParallelSine * kParallelSine * uu * vv) {
    // Least squares by the dual basis: cross products keep the digits that the normal equations would square away.
    scales.alpha = dot(cross(v, normal), f) / area2;
    scales.beta = dot(cross(normal, u), f) / area2;
  } else if (uu + vv > 0) {
    // Pseudo-inverse of a matrix of rank one: its transpose over its squared Frobenius norm.
    scales.minimum_norm = true;
    scales.alpha = dot(u, f) / (uu + vv);
    scales.beta = dot(v, f) / (uu + vv);
  } else {
    scales.solvable = !(squared_norm(f) > 0);  // no force, nothing to share
  }
  return scales;
}

struct Skeleton {
  std::int32_t count = 0;     // beams, = anchors
  bool degenerate = false;    // no usable stiffness: all forces and displacements are zero
  bool minimum_norm = false;  // paper law only: its two columns are parallel, the smallest solution was taken
  bool common = false;        // stiffness law: every beam's tip moves by displacement_w
  Real alpha_Pa = 0;          // paper law only: scale of the axial ratios (6); E in the stiffness law
  Real beta_Pa = 0;     // paper law only: scale of the bending ratios (7); 3E in the Euler-Bernoulli stiffness law
  Vec3 displacement_w;  // stiffness law: displacement of the contact point, K^-1 F
  StraightBeam beam[kMaxAnchors];
  Vec3 force_w[kMaxAnchors];  // on each beam's tip
};

inline BeamSection section_of(const Anchor& anchor) PALPATE_RT {
  return {anchor.section_area_m2, anchor.section_inertia_m4, anchor.section_radius_m};
}

// Shape of the skeleton's beams, shared by both laws.
struct SkeletonSetup {
  BeamMaterial material;
  BeamTheory theory = BeamTheory::kTimoshenko;
  bool guard_length = true;  // l_eff = sqrt(l^2 + (2r)^2); false: the formulas as printed
};

// Of straight beams: equations (6) to (8) instead of stiffnesses.
inline bool shares_by_ratios(SkeletonLaw law) PALPATE_RT {
  return law == SkeletonLaw::kPaper || law == SkeletonLaw::kPaperGuarded;
}

// Setup for a model's parameters and skeleton law.
SkeletonSetup skeleton_setup(const Model& model) PALPATE_RT;

// Builds the beams from `contact_w` to anchor[i].position_m + offset_w[i]. An empty `offset_w` means rest anchors;
// otherwise it has at least as many elements as `anchor`. At most kMaxAnchors anchors are used.
void build_skeleton(const SkeletonSetup& setup, std::span<const Anchor> anchor, std::span<const Vec3> offset_w,
                    Vec3 contact_w, Skeleton& skeleton) PALPATE_RT;

// Stiffness law: K = sum K_i, d = K^-1 F, F_i = K_i d. Exact: sum F_i = F and F.d/2 = sum d.K_i d/2. K is factored by
// Cholesky, not inverted by cofactors: for one long thin beam (condition number near 1e6) the determinant is 1e-12 of
// its terms, which leaves four digits; Cholesky keeps sum F_i = F. Returns false (and sets degenerate) when K is
// singular or F is not finite.
bool distribute_by_stiffness(Vec3 force_on_body_w, Skeleton& skeleton) PALPATE_RT;

// The paper's ratios (Luo & Xiao 2006, equations (6), (7), (8)): F_i = alpha (S_i/l_i)(x_i.D) x_i +
// beta (I_i/l_i^3)(D - (x_i.D) x_i) with D the direction of the force and alpha, beta unknown. In space (8) gives three
// equations for the two scales: they are solved in the least-squares sense, so sum F_i = F holds only where F lies in
// the plane of the two columns. Where the columns are parallel (a force along a symmetry axis) the least-norm solution
// is taken. Needs beams built with BeamTheory::kEulerBernoulli. With the printed length a contact within
// kLeastLength_m of an anchor leaves its beam without direction and I/l^3 without bound: degenerate. Returns false
// then, and when there is no usable stiffness.
bool distribute_by_ratios(Real youngs_modulus_Pa, Vec3 force_on_body_w, Skeleton& skeleton) PALPATE_RT;

// Builds and distributes with the model's law. False: no anchors, SkeletonLaw::kNone, or degenerate (see the flag).
bool solve_skeleton(const Model& model, std::span<const Vec3> offset_w, Vec3 contact_w, Vec3 force_on_body_w,
                    Skeleton& skeleton) PALPATE_RT;

// The same on ends of the caller's choice instead of the model's anchors (at most kMaxAnchors are used).
bool solve_skeleton_on(const Model& model, std::span<const Anchor> end, std::span<const Vec3> offset_w, Vec3 contact_w,
                       Vec3 force_on_body_w, Skeleton& skeleton) PALPATE_RT;

// Displacement of anchor `index` (< count) under its beam's share of the force; zero for a fixed anchor.
inline Vec3 anchor_displacement(const Skeleton& skeleton, const Anchor& anchor, std::int32_t index) PALPATE_RT {
  if (anchor.fixed != 0) return {};
  // K_i^-1 F_i: the skeleton's own displacement in the stiffness law, each beam's own in the paper's.
  const StraightBeam& beam = skeleton.beam[index];
  const bool known = skeleton.common && beam.bending_N_per_m > 0;
  const Vec3 tip = known ? skeleton.displacement_w : beam_tip_displacement(beam, skeleton.force_w[index]);
  return released_displacement(beam, tip, anchor.release_length_m);
}

}  // namespace palpate
