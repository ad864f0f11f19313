// The short cut of a warm query: from last tick's triangle to the nearest, over neighbours, with proof.
#pragma once

#include "rt_core/surface/candidate.h"

namespace palpate {

enum class Proof : std::int32_t {
  kNone = 0,     // a nearer triangle may exist elsewhere: ask the hierarchy
  kNearest = 1,  // best.triangle is the nearest of all (lowest index among equals)
  kOutside = 2,  // the same, and p lies outside the body, farther than kDirectionFloor_m
};

// Improves `best`, which holds a measured triangle (its ceiling need not be up to date; it is afterwards when kNone is
// returned). The proof rests on Triangle::clear_*: see measure_clearance in the scene compiler. The price does not
// depend on the size of the mesh. Bound: kMaxWalk fans and two rings.
Proof walk(const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT;

}  // namespace palpate
