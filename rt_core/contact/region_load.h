// Load of one contact region: the sum of its rows' forces, their resultant, moment, centre and stiffness; what points
// and tips share once the region solver has found how far the surface gives way (accounting of a penalty method).
#pragma once

#include "rt_core/contact/contact_stiffness.h"
#include "rt_core/contact/cubic_law.h"
#include "rt_core/contact/friction.h"
#include "rt_core/contact/region_solve.h"
#include "rt_core/state.h"
#include "rt_core/tool/articulate.h"
#include "rt_core/tool/two_tools.h"

namespace palpate {

// Sorts the tick's contacts by region: those whose numbers are finite and whose region exists and is in contact; the
// others are left out, and so are regions without such a contact, which exert nothing from now on. None with a tool
// that is nowhere. Writes scratch.rows. Bound: contacts + regions^2 / 2.
void sort_rows(State& state, Scratch& scratch) PALPATE_RT;

inline RegionRows rows_of(Scratch& scratch, std::int32_t r) PALPATE_RT {
  const RowsByRegion& rows = scratch.rows;
  return {&scratch.contact[0], rows.index + rows.first[r], rows.first[r + 1] - rows.first[r], rows.geometric};
}

struct RegionCentre {
  Vec3 position_w;
  Vec3 normal_w;  // unit, of the resultant
};
// Centre of pressure sum f_i p_i / sum f_i of the forces in rows[].force_N, moved along the normal of their resultant
// onto the rest surface. Parallel forces have exactly the moment of their sum there; the geometric centre (Luo & Xiao
// 2006; rows.geometric) has not. Where all forces are zero, the weighted mean; where they have no direction,
// `fallback_normal`. Bound: the number of rows, twice.
RegionCentre region_centre(const RegionRows& rows, Vec3 fallback_normal) PALPATE_RT;
// The same with the region's last normal as the fallback; before the first, that of the first row.
RegionCentre centre_of(const Region& region, const RegionRows& rows) PALPATE_RT;

// The deepest row of a region (ties: the first), whose place its far field is that of. Not for an empty one. Bound:
// rows.
inline const Contact& deepest_of(const RegionRows& rows) PALPATE_RT {
  std::int32_t deepest = 0;
  for (std::int32_t k = 1; k < rows.count; ++k) {  // bound: rows
    if (rows[k].depth_m > rows[deepest].depth_m) deepest = k;
  }
  return rows[deepest];
}

// Where a region leans on the body, once, at its first touch: from the forces in rows[].force_N, which are those at the
// depths of the rest surface. Fixed to the tool from then on, so that the compliance between two regions of a rigid
// tool is a constant of their common life. Were it to follow the centres of pressure, its change under load, F.dC F /
// 2, would be work that no force renders: a compass sliding on a heart gave back 4e-6 J in a loop (measured
// 2026-11-21). Fingers move against one another, so for an articulated tool it is the body that the place is fixed to:
// constant again, at the price of a far field that stays behind when a finger slides.
void set_lean(const Model& model, const State& state, Region& region, const RegionRows& rows) PALPATE_RT;
inline bool has_lean(const Region& region) PALPATE_RT { return squared_norm(region.lean_normal_tool) > 0.5; }

// One row with the surface under it moved by its region's shift: force and tangent of its local law, energy held by it,
// where on the tool the force acts.
struct RowLoad {
  LawPoint at;
  Real energy_J = 0;
  Vec3 lever_w;            // point of attack
  Vec3 aside_w;            // force along the surface that its energy asks for
  bool is_beyond = false;  // of the law's stated range
  // Of a line: against turning the tool about this unit vector.
  Real lean_Nm_per_rad = 0;
  Vec3 lean_w{};
};

// Sum over the rows of a region.
struct RegionLoad {
  Vec3 resultant_w;            // sum f_i n_i: force on the tool
  Vec3 aside_w;                // forces along the surface
  Vec3 torque_w;               // of both, about the pivot
  Real force_N = 0;            // sum f_i: what the coupling of regions is conjugate to
  Real energy_J = 0;           // of the local laws
  bool is_beyond = false;      // some row
  bool leans = false;          // too; `stiffness` has it
  ContactStiffness stiffness;  // about the pivot
};
// Writes rows[].force_N. Laws::row(r, k, shift) gives a RowLoad; Laws::softening(r, shift) how much less stiff every
// row is because the surface under all of them yields; Laws::kTellsTangent: the tangent is the method's own, and
// `stiffness` is against leaning alone. Bound: the number of rows.
template <class Laws>
RegionLoad region_load(const Laws& laws, std::int32_t r, const RegionRows& rows, Real shift_m,
                       Vec3 pivot_w) PALPATE_RT {
  Real softening = 0;
  if constexpr (!Laws::kTellsTangent) softening = laws.softening(r, shift_m);
  RegionLoad load;
  for (std::int32_t k = 0; k < rows.count; ++k) {  // bound: rows
    Contact& contact = rows[k];
    const RowLoad row = laws.row(r, k, shift_m);
    const Vec3 arm = row.lever_w - pivot_w, turn = cross(arm, contact.normal_w);
    contact.force_N = row.at.force_N;
    load.resultant_w += contact.force_N * contact.normal_w;
    load.torque_w += contact.force_N * turn;
    if constexpr (Laws::kPullsAside) {
      load.aside_w += row.aside_w;
      load.torque_w += cross(arm, row.aside_w);
      if (row.lean_Nm_per_rad > 0) {
        add_spring(load.stiffness, row.lean_Nm_per_rad, {}, row.lean_w);
        load.leans = true;
      }
    }
    load.force_N += contact.force_N;
    load.energy_J += row.energy_J;
    load.is_beyond = load.is_beyond || row.is_beyond;
    if constexpr (!Laws::kTellsTangent)
      add_spring(load.stiffness, softening * row.at.tangent_N_per_m, contact.normal_w, turn);
  }
  return load;
}

// The tool's origin about which the rows of a region turn it: of its hand's tool.
inline Vec3 pivot_w(const State& state, const RegionRows& rows) PALPATE_RT {
  return tool_of(state, rows[0].hand).position_m;
}
inline ContactStiffness& stiffness_of(Scratch& scratch, std::int32_t hand) PALPATE_RT {
  return hand == 0 ? scratch.stiffness : scratch.other.stiffness;
}

// Normal load of one region into State: centre, normal, wrench and energy; the stretch follows the turn of
// the normal, while a centre that wanders over the surface (rolling) does not change it.
void press(Scratch& scratch, Region& region, const RegionRows& rows, const RegionLoad& load,
           Real coupling_J) PALPATE_RT;
// Every region's load at the shifts in scratch.system. Laws::coupling_J(r, force, shift): energy that the yielding
// surface holds on account of region r. Status: kDepthBeyondRange.
template <class Laws>
void press_regions(const Laws& laws, State& state, Scratch& scratch) PALPATE_RT {
  scratch.stiffness = scratch.other.stiffness = {};
  for (std::int32_t r = 0; r < scratch.rows.regions; ++r) {  // bound: kMaxContacts rows
    const RegionRows rows = rows_of(scratch, r);
    const Real shift_m = scratch.system.shift_m[r];
    const RegionLoad load = region_load(laws, r, rows, shift_m, pivot_w(state, rows));
    Region& region = state.region[scratch.rows.slot[r]];
    press(scratch, region, rows, load, laws.coupling_J(r, load.force_N, shift_m));
    if constexpr (!Laws::kTellsTangent)
      region.tangent_N_per_m = stiffness_along_N_per_m(load.stiffness, region.normal_w);
    if (!Laws::kTellsTangent || load.leans) add_to(stiffness_of(scratch, region.hand), load.stiffness);
  }
}

// What a solution took, with so many laws in each evaluation. Returns how many were evaluated.
inline std::int32_t count_solution(const RegionSolution& result, std::int32_t n, std::int32_t laws,
                                   Work& work) PALPATE_RT {
  work.region_pairs += (result.evaluations + 2 * result.steps) * n * n;
  work.region_cubes += result.steps * n * n * n;
  return result.evaluations * laws;
}

// Friction at the region's centre, added to its wrench and energy. The caller fills region.depth_equivalent_m and
// `load`'s step, tangent and depth rate; normal and force are taken from the region. `arm_w`: of its centre from the
// tool's origin.
FrictionForce rub_region(const FrictionParameters& parameters, FrictionLoad& load, Vec3 arm_w,
                         Region& region) PALPATE_RT;
// The directions of a friction's two stiffnesses.
struct TangentAxes {
  Vec3 along, across;
};
TangentAxes tangent_axes(const FrictionForce& friction, Vec3 normal) PALPATE_RT;
// Friction on a body that holds still: rub_region() with the step of the tool's material, and its springs in
// scratch.stiffness.
void slide(const Model& model, const State& state, Scratch& scratch, const FrictionParameters& parameters,
           const RegionRows& rows, FrictionLoad& load, Region& region) PALPATE_RT;

// Motion since the last tick of the tool material that is at `point` now, rotation included: exact where one piece
// touches; the mean by force where pieces that move against one another share the region.
Vec3 material_motion(const Model& model, const State& state, const RegionRows& rows, Vec3 point_w) PALPATE_RT;

// Friction of whole tips, region by region, with the spring of their normal stiffness; then sum_up.
void rub_tips(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

// Sums of all regions in contact: wrench, energy, tangent stiffness; and where the tool goes under them.
void sum_up(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

}  // namespace palpate
