// Descent of the surface hierarchy: finds the nearest triangle from any start.
#pragma once

#include "rt_core/surface/candidate.h"

namespace palpate {

struct DescentResult {
  std::int32_t nodes = 0;             // opened
  std::int32_t stack_high_water = 0;  // traversal stack entries used
  double lower_bound_m = 0;           // no surface point is nearer than this
  bool truncated = false;             // a cap was hit and a nearer triangle may have been missed
};

// Goes straight down to one leaf near p and measures it: a start for a walk. Returns whether `best` improved; its
// ceiling is out of date then. Bound: kMaxTraversalStack nodes.
bool land(const Model& model, const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT;

// Improves `best`, whose distance2 bounds the search and whose ceiling is up to date, until no triangle is nearer.
// Bound: kMaxQueryNodes nodes of four children, kMaxTraversalStack pending nodes.
DescentResult descend(const Model& model, const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT;

}  // namespace palpate
