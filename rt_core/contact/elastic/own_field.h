// What a place of an elastic body gives beyond a half space and beyond the soft modes, as a far field of the tips
// there, w(F) = c F + c1 F^2: c where it is positive (else it is in the tip's own law), c1 on either side of zero. c
// crosses zero on most bodies. Were c1 let go there, what is stored would step by 2/3 c1 F^3, and the force along the
// surface that asks for it 3.4 % of the tip's, in one tick of a slide over a block (2026-11-26).
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"
#include "rt_core/contact/tips/travel.h"

namespace palpate {

struct OwnField {
  FarField far;
  Real room_m_per_N = 0;  // what c and the dent give: of which c1 may spend a share, until far.force_max_N
  // On a layer, c < 0, the law of large strain has the second order in it (config/elastic/width_law.h): what is left of
  // c1, and its slope in c.
  Real second_share = 1, second_slope_N_per_m = 0;
};
OwnField own_field(const TipLaw& law, const ElasticRow& row) PALPATE_RT;

// How the integral of an own field over its force, at one force, changes with c and c1.
struct FarChange {
  Real per_c0_N2, per_c1_N3;
};
FarChange far_change(const OwnField& own, Real c_m_per_N, Real c1_m_per_N2, Real force_N) PALPATE_RT;

}  // namespace palpate
