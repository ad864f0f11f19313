// Normal load of one contact region: the sum of its points' forces, their resultant, moment, centre and stiffness.
#pragma once

#include "rt_core/contact/contact_stiffness.h"
#include "rt_core/contact/cubic_law.h"
#include "rt_core/state.h"
#include "rt_core/vec.h"

namespace palpate {

// The contacts of one region: `contact[index[k]]`, k < count. Sorting indices instead of contacts copies nothing.
// Every contact named must hold finite numbers, a unit normal and a non-negative weight.
struct RegionContacts {
  Contact* contact = nullptr;
  const std::int32_t* index = nullptr;
  std::int32_t count = 0;

  Contact& operator[](std::int32_t k) const PALPATE_RT { return contact[index[k]]; }
};

// Turns area/reference area into the weights of the law (ContactWeight):
// kWinkler (default) leaves them: fixed per point, so forces are continuous when points enter and leave, and the force
//   grows with the area, as it must. kArea divides by their sum: independent of tessellation, but of the area too.
// kPaper (Luo & Xiao 2006) 1/n: mass shared evenly; the force depends on how densely points are spread.
// Weights that are not positive and finite become zero. Bound: the number of points.
void weigh_contacts(ContactWeight law, const RegionContacts& contacts) PALPATE_RT;

// Sum of force and of stiffness when every depth is reduced by shift_m. Bound: the number of points.
LawPoint scalar_load(const CubicLaw& law, const RegionContacts& contacts, Real shift_m) PALPATE_RT;

struct RegionCentre {
  Vec3 position_w;
  Vec3 normal_w;  // unit, of the resultant
};
// Centre of pressure sum f_i p_i / sum f_i of the forces in contact[].force_N, moved along the normal of their
// resultant onto the rest surface. Parallel forces have exactly the moment of their sum there; the geometric centre
// (Luo & Xiao 2006) has not. Where all forces are zero, the weighted mean; where they have no direction,
// `fallback_normal`. Bound: the number of points, twice.
RegionCentre region_centre(const RegionContacts& contacts, Vec3 fallback_normal) PALPATE_RT;

struct RegionLoad {
  Vec3 resultant_w;            // sum f_i n_i: force on the tool
  Vec3 torque_w;               // sum (p_i - pivot) x f_i n_i
  Real force_N = 0;            // sum f_i: what the coupling of regions is conjugate to
  Real energy_J = 0;           // sum w_i U(D_i)
  Real depth_max_m = 0;        // deepest point, after the shift
  ContactStiffness stiffness;  // about the pivot
};
// With every depth reduced by shift_m; writes contact[].force_N. Bound: the number of points.
RegionLoad region_load(const CubicLaw& law, const RegionContacts& contacts, Real shift_m, Vec3 pivot_w) PALPATE_RT;

}  // namespace palpate
