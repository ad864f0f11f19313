// The tips in contact with an elastic body, with their own far fields and the body's, and what accounting asks of them.
#pragma once

#include "rt_core/contact/elastic/own_field.h"
#include "rt_core/contact/elastic/pair_lanes.h"
#include "rt_core/contact/elastic/placed_law.h"
#include "rt_core/contact/region_load.h"
#include "rt_core/contact/region_solve.h"
#include "rt_core/contact/tips/travel.h"

namespace palpate {

// What the energy stored under a tip gains, at a held travel, as the place's numbers fall: c, c1, curvature, beta; and
// the modulus.
struct PlaceForce {
  Real by[elastic_layout::kOwnSlopes] = {}, by_modulus = 0;
  void scale(Real factor) PALPATE_RT {
    for (Real& one : by) one *= factor;
    by_modulus *= factor;
  }
  Vec3 along(const ElasticRow& row) const PALPATE_RT {
    return by[0] * row.c_gradient + by[1] * row.c1_gradient + by[2] * row.curvature_gradient +
           by[3] * row.beta_gradient + by_modulus * row.modulus_gradient;
  }
};

struct ElasticLoad : TipLaws {
  static constexpr bool kPullsAside = true, kTellsTangent = true;  // tool_tangent.h
  // After a step: another one ends at rounding, and the next tick begins with one wherever rounding is not reached.
  static constexpr Real kEnoughStepped_m = 1e-12;
  // Of lines' dents: a step after which their tangents tell the forces within a thousandth, and one after which they
  // tell as much as the laws would. What a place adds to a line has a tangent within 1.4 % (pinch_block, 2026-11-26).
  static constexpr Real kForeseen = 0.1, kKnown = LineLaw::kNear, kOffTangents = 0.02, kKnown_m = 1e-10;
  // By region, each of which is one tip (regions.h).
  Tip tip[kMaxRegions];
  const ElasticRow* placed[kMaxRegions];
  PlacedLaw law[kMaxRegions];
  TipRegion tip_of[kMaxRegions];
  OwnField own[kMaxRegions];     // c and c1 of the region, without the modes
  Vec3 pair_aside[kMaxRegions];  // slope along the surface of what the others' forces move under a region
  const Real* before_N;          // the last tick's forces, of all regions
  PairLanes pair;                // of several regions
  Real* own_bend_m_per_N;        // room for evaluate() to tell newton_step(): d2W/dF^2 of every region
  Real* change_N;                // and for newton_step() to tell foresees(): the forces' change by their tangents
  std::int32_t evaluations_left = kTipEvaluations;  // to the tick's solves
  bool goes_on = false;  // from the depths found_m in the tips, of every region, that the last solve found
  Real found_m[kMaxRegions];

  // Normal stiffness under region r as if the soft modes held still; of the laws' tangent there the root.
  Real place_N_per_m(std::int32_t r, Real force_N, Real root_tangent) const PALPATE_RT {
    const Real tangent = root_tangent * root_tangent;
    return tangent / (1.0 + far_slope_m_per_N(own[r].far, force_N) * tangent);
  }
  // Mindlin's, which friction's spring is a share of: of the dent and c. c1 is what the whole body's travel makes of
  // the place: where it halves what the place gives, a spring with it grew by a quarter for 2 % of the force, and a
  // thumb that stuck turned the tool to and fro (2026-11-26).
  Real rubbed_N_per_m(std::int32_t r, Real root_tangent) const PALPATE_RT {
    const Real tangent = root_tangent * root_tangent;
    return tangent / (1.0 + own[r].far.c0_m_per_N * tangent);
  }
  // A part that is hardly touched is told as stiff as one well in contact: from next to no force Newton's step went
  // 0.16 mm into the seat of a clip, and the next tick said 800 N (2026-11-26).
  Real told_root_tangent(std::int32_t r, Real force_N, Real root_tangent) const PALPATE_RT {
    const ElasticRow& row = *placed[r];
    if (!(force_N > 0 && row.tip.is_of_part() && law[r].is_line)) return root_tangent;
    return max_of(root_tangent, square_root(row.told.tangent_N_per_m));
  }
  // The force along the surface that the stored energy asks for where c, c1 and the curvature change along it. Of a
  // line none: its numbers are those of the one place where it stands, whose slopes over a millimetre are not those of
  // the mean along it. With them, on tool and modes, jaws that had dragged a block turned to and fro between two
  // triangles in 424 of 5,700 ticks, by 0.38 N; without in 2, by 5 mN (2026-11-26).
  RowLoad row(std::int32_t r, std::int32_t, Real shift_m) const PALPATE_RT {
    const ElasticRow& stands = *placed[r];
    const Real e = tip[r].depth_m - shift_m;
    const LawPoint point = tip_at(tip[r], e);
    const Real energy = tip_energy_J(tip[r], e), f = point.force_N;
    Vec3 aside = f * (stands.rise - stands.foot.normal_w + pair_aside[r]);
    if (!law[r].is_line && !law[r].is_plate) aside += place_force(r, e, energy, f).along(stands);
    // Never steeper than 45 degrees: far beyond the range the second power of the force is no physics.
    const Real length = norm(aside), share = length > f ? f / length : 1.0;
    // Where the second order goes on by its tangent, and off the smooth surface, no press of the bake has been.
    const Real range_m = law[r].is_plate ? stands.tip.depth_max_m : tip[r].local.tip->depth_max_m;
    const bool is_beyond = e > range_m || f > own[r].far.force_max_N || stands.foot.state != FootState::kFound;
    RowLoad out{point, energy, stands.tip.centre_w(), share * aside, is_beyond};
    if (law[r].is_line) lean(r, e, out);
    return out;
  }
  // The force of a capsule that leans acts beside where the tick had it stand.
  void lean(std::int32_t r, Real e, RowLoad& out) const PALPATE_RT {
    const LineLaw::Lean line = law[r].line.lean_near(e);
    const Vec3 axis = unit_or(placed[r]->tip.half_axis_w, {});
    out.lever_w += line.to_pressure_m * axis;
    out.lean_Nm_per_rad = law[r].line.arm_back_m(line, e) * out.at.force_N;
    out.lean_w = unit_or(cross(axis, placed[r]->foot.normal_w), {});
  }
  // How the energy of the far field and, the other way, that of the tip's law change with the numbers of a ball's or
  // flat tip's place.
  PlaceForce place_force(std::int32_t r, Real e, Real energy_J, Real force_N) const PALPATE_RT {
    const ElasticRow& stands = *placed[r];
    const PlacedLaw& here = law[r];
    const PlaceEnergies place = place_energies(tip[r].local.tip->depth_max_m, e);
    const Real alone = (energy_J - place.J(here.terms)) / here.scale;
    const Real by_scale = alone + place.J(here.by_scale);
    PlaceForce out{};
    out.by[2] = -here.scale_by_curvature * by_scale;
    out.by[3] = -place.J(here.by_beta);
    const FarChange change = far_change(own[r], stands.c_m_per_N, stands.c1_m_per_N2, force_N);
    out.by[0] = change.per_c0_N2;
    out.by[1] = change.per_c1_N3;
    if (stands.c_m_per_N < 0) out.by[0] -= alone * here.scale_by_c + place.J(here.by_c);
    if (stands.modulus_gradient == Vec3{}) return out;
    const Real inverse = 1.0 / stands.modulus;  // the terms' powers of it: rho's by their own, beta's as of m^2
    const PlaceTerms by_modulus = {2 * inverse * here.terms.second_N_per_m2, 3 * inverse * here.terms.between_N_per_m25,
                                   2 * inverse * here.terms.third_N_per_m3, 3 * inverse * here.terms.fourth_N_per_m4};
    out.by_modulus = -(alone * here.scale_by_modulus + place.J(by_modulus));
    return out;
  }
  // Region alone: what the last force asks for.
  Real shift_alone_m(std::int32_t r) const PALPATE_RT { return keeps_dent(r, far_shift_m(region[r].far, before_N[r])); }
  // Where a body gives a thousand times as much as the dent under a part's line, the dent is what hardly changes: begun
  // with the last force, a clip's tick took up to 18 laws more. Nor does any line's from one solve of friction to the
  // next: begun with the first one's force, under which a body that slips gives way by ten dents more, the second of a
  // clip took 24 laws in each of two regions. A touch that begins has the share that the body leaves it (2026-11-26).
  Real keeps_dent(std::int32_t r, Real shift_m) const PALPATE_RT {
    if (!law[r].is_line) return shift_m;
    const ElasticRow& row = *placed[r];
    const Real touches_m = law[r].line.touches_at_m(), depth_m = tip[r].depth_m;
    if (row.tip.is_of_part() && row.dent_m > 0) return depth_m - (touches_m + row.dent_m);
    if (goes_on && found_m[r] > touches_m) return depth_m - found_m[r];
    const Real over_m = depth_m - shift_m - touches_m;
    if (before_N[r] > 0 || !(over_m > 0)) return shift_m;
    return depth_m - (touches_m + left_of_m(r, over_m, region[r].far.c0_m_per_N));
  }
  // The dent that a body which gives c leaves of an overlap with a line that is not in touch yet.
  Real left_of_m(std::int32_t r, Real over_m, Real c_m_per_N) const PALPATE_RT {
    return over_m / (1.0 + max_of(c_m_per_N, 0.0) * placed[r]->told.tangent_N_per_m);
  }
  // And its force there.
  Real begins_N(std::int32_t r) const PALPATE_RT;
  // The next solve begins with the dents of this one.
  void go_on_from(const Real* shift_m) PALPATE_RT {
    for (std::int32_t r = 0; r < n; ++r) found_m[r] = tip[r].depth_m - shift_m[r];  // bound: kMaxRegions
    goes_on = true;
  }
  // What the region solver asks (region_solve.h), all regions at once. The start: what the last forces ask for.
  void start(Real* shift_m) const PALPATE_RT;
  Real evaluate(const Real* shift_m, RegionSystem& s) const PALPATE_RT;
  bool newton_step(RegionSystem& s) const PALPATE_RT;
  bool newton_step_of_two(RegionSystem& s) const PALPATE_RT;
  // I + g H g of newton_step(); H with its second order, in the forces, or without.
  bool factor(const RegionSystem& s, Real second_order, FactorLanes& system) const PALPATE_RT;
  Real own_bend(std::int32_t r, Real second_order) const PALPATE_RT {
    return second_order > 0 ? own_bend_m_per_N[r] : region[r].far.c0_m_per_N;
  }
  bool foresees(RegionSystem& s, Real most) const PALPATE_RT;
  // A Newton step that knows how a law bends, as the power of the dent that it is there: of a power under a body that
  // gives much it finds the force at once, where Newton's went out to ten times the dent or back by half of it.
  Real bent_step_m(std::int32_t r, const RegionSystem& s) const PALPATE_RT;
  // How deep region r's tip is beyond where it touches.
  Real dent_m(std::int32_t r, Real shift_m) const PALPATE_RT {
    return tip[r].depth_m - shift_m - (law[r].is_line ? law[r].line.touches_at_m() : 0.0);
  }
  // d2W/dF_i dF_j of i != j.
  Real curvature(const Real* force, std::int32_t i, std::int32_t j) const PALPATE_RT {
    return pair.c_m_per_N[i][j] + pair.h_m_per_N2[i][j] * force[i] + pair.h_m_per_N2[j][i] * force[j];
  }
  Real coupling_J(std::int32_t r, Real force_N, Real) const PALPATE_RT { return far_energy_J(own[r].far, force_N); }
  // Forces and shifts of several regions, to `enough_m` (solve_regions()). Of a solve that is farther off than
  // kNoAnswer_m the energy of the pairs may have no least: their second order, cubic in the forces, is told up to those
  // of the last tick. Without it there is a least: so it is dropped, if the pairs have any and evaluations are left,
  // and `given_up` tells what the first solve took.
  static constexpr Real kNoAnswer_m = 1e-4;
  RegionSolution solve(RegionSystem& system, Real enough_m, bool roughly, RegionSolution& given_up) PALPATE_RT;
  // Goes on with one that may have been foreseen, to its end.
  void finish(RegionSystem& system, RegionSolution& result) PALPATE_RT;

 private:
  RegionSolution solve_once(RegionSystem& system, Real enough_m, bool roughly) PALPATE_RT;
};

}  // namespace palpate
