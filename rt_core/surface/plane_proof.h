// The end of a query over a triangle certified by planes (ring_proof.h): which of the triangles that hold its closest
// point is the answer, whatever number meets there.
#pragma once

#include <cstdint>

#include "rt_core/surface/candidate.h"

namespace palpate {

// Triangles that meet about a corner, measured at most where a closest point is within rounding of it, some 2 nm;
// beyond its neighbours a needle is out of the question at once.
inline constexpr std::int32_t kMaxNearCorner = 128;
// Spokes of a fan passed at most on the way to the triangle a point is over; kSpokesPerLook cost what a triangle does.
inline constexpr std::int32_t kMaxTurn = 256, kSpokesPerLook = 8;

// What rounding may have a closest point on besides its triangle: the neighbour across an edge, or all about a corner.
struct Border {
  int edge = -1, corner = -1;
};
// Of the closest point c in the face of t.
Border border_in_face(const Surface& surface, const Triangle& t, Vec3 c) PALPATE_RT;

enum class Settled : std::int32_t {
  kNone = 0,     // nearer ones may exist
  kMoved = 1,    // best.triangle is another, nearer one
  kTurned = 2,   // the same, after many spokes maybe
  kNearest = 3,  // best.triangle is the nearest of all, the lowest index among equals
};

// The triangle of a flat fan below a place `off` its middle, round it from `index` by which side of the spokes the
// place is on; -1: none of the next kMaxTurn. Bound: kMaxTurn.
struct Turn {
  std::int32_t triangle = -1, passed = 0;
};
Turn turn_about(const Surface& surface, Vec3 off, std::int32_t index, std::int32_t middle) PALPATE_RT;

// For a best.triangle whose certificate by planes holds. Bound: kMaxTurn spokes, and kMaxNearCorner triangles.
Settled settle_by_planes(const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT;

}  // namespace palpate
