// Where a tip touches a carried body beyond a sharp edge, at which the smooth surface ends.
#pragma once

#include "rt_core/contact/elastic/carried_triangle.h"

namespace palpate {

// The cosine by which a facet of a part must look at what touches it or its edge; and more than the facet across the
// edge does, where that is of another part. A tube through a clip's hollow does not touch the flanks' rims.
inline constexpr Real kGrazing = 0.3;

// The nearest place of a sharp edge or its end, where the smooth surface stops.
struct EdgePlace {
  int edge = -1;  // from this corner to the next
  Real share = 0;
  Vec3 place_w, along_w;  // the edge; zero at its end
  Real square_m2 = kHuge;
  bool is_behind = false;  // of a part: what is above it there is inside the body, or above another part
};

// Foot of a tip's centre on the smooth surface, begun on the triangle that `last` stands on; `last` follows it.
void find_carried_foot(Vec3 centre_w, Vec3 near_w, CarriedTriangle& last, ElasticRow& row) PALPATE_RT;

// After a foot was lost at a sharp edge: on its other side where the tip is above that (row.foot is found, edge -1),
// else on the edge or its end as the body carries it. A facet at rest, moved as one of its corners is, was up to a
// millimetre off on a ring that had turned, and another one on either side of the edge: the ring jumped between the two
// (2026-11-23). Of hollow edges, and from inside, nothing: edge -1. A tip of a part stands on its edges whatever is
// beyond but another part, a capsule where its axis is nearest. Bound: two ends, two searches.
EdgePlace place_on_edge(Vec3 centre_w, CarriedTriangle& last, ElasticRow& row) PALPATE_RT;

}  // namespace palpate
