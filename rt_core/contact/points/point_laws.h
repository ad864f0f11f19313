// Laws of tool points with cubic springs (a penalty method), coupled by the far field of their regions: what the region
// solver asks of them.
#pragma once

#include "rt_core/contact/region_load.h"

namespace palpate {

// Force of region r at shift d: F_r = sum w_i f(D_i - d), f the cubic law. W = F.C F / 2, C symmetric positive
// semi-definite.
struct PointLaws {
  static constexpr std::int32_t kIterations = kCoupledNewtonIterations;
  // Another Newton step would change nothing but rounding: 1e-11 of a millimetre's depth. Fifteen fingers on rubber
  // need two or three steps (2026-11-21).
  static constexpr Real kEnough_m = 1e-14;
  // 0.1 um, a few mN on the stiffest objects a haptic device can render.
  static constexpr Real kTolerance_m = 1e-7;
  static constexpr bool kPullsAside = false;
  static constexpr bool kTellsTangent = false;

  CubicLaw law;
  const RegionRows* region;
  const Real* compliance_m_per_N;  // C, n x n; nullptr: the regions are not coupled
  std::int32_t n;

  // Each region alone, its law replaced by the tangent at its force-weighted mean depth (the only depth, for one
  // point). Overshoots a little for a hardening law, which Newton's first step mends.
  Real start(std::int32_t r) const PALPATE_RT {
    Real force = 0, moment = 0, tangent = 0;
    const RegionRows& rows = region[r];
    for (std::int32_t k = 0; k < rows.count; ++k) {  // bound: points
      const Contact& contact = rows[k];
      const LawPoint point = law_at(law, contact.depth_m);
      force += contact.weight * point.force_N;
      moment += contact.weight * point.force_N * contact.depth_m;
      tangent += contact.weight * point.tangent_N_per_m;
    }
    const Real softening = self_compliance_m_per_N(r) * tangent;
    return force > 0 ? moment / force * (softening / (1.0 + softening)) : 0.0;
  }
  LawPoint load(std::int32_t r, Real shift_m) const PALPATE_RT {
    LawPoint sum;
    const RegionRows& rows = region[r];
    for (std::int32_t k = 0; k < rows.count; ++k) {  // bound: points
      const Contact& contact = rows[k];
      const LawPoint point = law_at(law, contact.depth_m - shift_m);
      sum.force_N += contact.weight * point.force_N;
      sum.tangent_N_per_m += contact.weight * point.tangent_N_per_m;
    }
    return sum;
  }
  Real shift_under(const Real* force, std::int32_t r) const PALPATE_RT {
    Real sum = 0;
    for (std::int32_t j = 0; j < n; ++j) sum += compliance_m_per_N[r * n + j] * force[j];  // bound: regions
    return sum;
  }
  Real curvature(const Real*, std::int32_t i, std::int32_t j) const PALPATE_RT { return compliance_m_per_N[i * n + j]; }
  Real self_compliance_m_per_N(std::int32_t r) const PALPATE_RT {
    return compliance_m_per_N == nullptr ? 0.0 : compliance_m_per_N[r * n + r];
  }

  // Accounting. The points' own tangents go into the tool's: the yielding of the surface under them is left out, so the
  // stiffness is too high rather than too low where the corrector divides by it.
  Real softening(std::int32_t, Real) const PALPATE_RT { return 1.0; }
  RowLoad row(std::int32_t r, std::int32_t k, Real shift_m) const PALPATE_RT {
    const Contact& contact = region[r][k];
    const Real depth = contact.depth_m - shift_m;
    const LawPoint point = law_at(law, depth);
    return {{contact.weight * point.force_N, contact.weight * point.tangent_N_per_m},
            contact.weight * law_energy_J(law, depth),
            contact.position_w,
            {},
            depth > law.max_depth_m};
  }
  Real coupling_J(std::int32_t, Real force_N, Real shift_m) const PALPATE_RT { return 0.5 * force_N * shift_m; }
};

// Turns area/reference area into the weights of the law (ContactWeight):
// kWinkler (default) leaves them: fixed per point, so forces are continuous when points enter and leave, and the force
//   grows with the area, as it must. kArea divides by their sum: independent of tessellation, but of the area too.
// kPaper (Luo & Xiao 2006) 1/n: mass shared evenly; the force depends on how densely points are spread.
// Weights that are not positive and finite become zero. Bound: the number of points.
void weigh_contacts(ContactWeight law, const RegionRows& rows) PALPATE_RT;

// The papers' contributions of contact regions to one another, for kTemporalPaper (Cui & Xiao 2008, section IV.C).
// For the regions slot[0..count), first born first: adds to added_N[i] the component along normal_w of slot[i] of what
// every later slot[j] carries over to it through its skeleton: sum_a w_a(p_i) K_a K^-1 F_j, where K_a are the beams
// from the centre of j to the anchors, w_a the surface interpolation's weights at the centre of i, and
// F_j = normal_force_N * normal_w + friction_force_w, the force of the body on the tool. The skeleton of j stands on
// the anchors as the regions before it displaced them; baked beams stand on the anchors at rest.
//
// The paper adds "force effects", interpolated stresses: magnitudes. So what is added is the size of that component: a
// contact made later presses the body against the earlier ones, beside it and, through the body, opposite to it. (With
// the sign of F_j, as until 2026-11-23, a thumb lost all its load to the fingers that came after it.) Not reciprocal:
// the law as a whole is not conservative.
//
// Reads centre_w, normal_w, normal_force_N and friction_force_w of all slots as they are at the call. Nothing is added
// where there is no interpolation, or a number is not finite. False when some region's skeleton was degenerate: it
// carries nothing over. Bound: kMaxRegions skeletons and kMaxRegions^2 / 2 sums over the anchors.
bool add_transferred_forces(const Model& model, const State& state, const std::int32_t* slot, std::int32_t count,
                            Real* added_N) PALPATE_RT;

// The same for kMutualPaper, "the stress contributions from every other contact region" (Luo & Xiao 2006, section VI):
// each skeleton has beams to the other regions, too, and what is added to slot[i] is the size of the component along
// its normal of the shares of all other forces in the beams that end at it. No order, no interpolation. Bound:
// kMaxRegions skeletons of kMaxAnchors beams.
bool add_mutual_forces(const Model& model, const State& state, const std::int32_t* slot, std::int32_t count,
                       Real* added_N) PALPATE_RT;

// The other half of the temporal order: the depth of a region is measured "on top of the deformed shape due to contacts
// occurred before" it (Cui & Xiao 2008, section IV.C). First born first: the regions before it displace the anchors
// through their skeletons, the surface between the anchors follows by interpolation, and its motion along the region's
// normal is the region's shift in scratch.system; inward never farther than max_depth_m, since the ratios' scales have
// no bound, outward never farther than the region's own depth, since contact is found on the rest surface. Writes the
// centres of regions, too. Nothing for a single region or without an interpolation. Status: kSkeletonDegenerate. Bound:
// kMaxRegions skeletons and as many interpolations.
void shift_in_order(const Model& model, State& state, Scratch& scratch, const PointLaws& laws) PALPATE_RT;

}  // namespace palpate
