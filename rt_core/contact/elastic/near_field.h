// What tips on one body do to one another where its linear modes are too coarse to tell.
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"

namespace palpate {

// What one tip does to the surface under another beyond the linear modes, m/N. Those end at a length l, below which the
// body is a half space: A (1/r - 1/sqrt(r^2 + l^2)), A = (1 - nu^2) / (pi E), which has 1/r near and falls off like
// r^-3 beyond l; its Fourier transform is positive. Under a tip itself half space and modes give what half space and c
// do:
//   sum phi^2 / lambda - A / l = c
// says how long l is there. Opposite faces of a wall push one another out (the normals' cosine); faces across a gap do
// not know of one another.
struct NearField {
  Real scale_m2_per_N;

  // 1 / l at a place.
  Real cut_1_per_m(Real modes_m_per_N, Real c_m_per_N) const PALPATE_RT {
    return max_of(modes_m_per_N - c_m_per_N, 0.0) / scale_m2_per_N;
  }
  // Two tips at one place: the mean of 1/r over a contact a fifth of their radii wide is finite.
  static constexpr Real kCore = 0.1;  // of the radii
  // Parts of a solid meet at its corners, where each has a share of one contact, which is all in their own laws: 1 / r
  // between them is r / (r^2 + d^2), d of the edges' radius. Boundary elements: docs/models_elastic.md.
  static constexpr Real kSolid = 0.75;
};

}  // namespace palpate
