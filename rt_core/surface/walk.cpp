#include "rt_core/surface/walk.h"

#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/ring.h"

namespace palpate {

namespace {

// Triangles a walk may cross before the hierarchy is searched: a tool at 1 m/s moves 1 mm per tick, six edges of the
// finest meshes, and a leaf reached straight down the hierarchy lies within 20 of the nearest on a million triangles
// (ellipsoid, 2026-11-21). A step costs some 250 instructions, a search 3,000 to 12,000.
constexpr std::int32_t kMaxWalk = 24;

enum class Certificate : std::int32_t { kNone, kRing, kConvexOutside };

// Whether every surface point as near to p as best.triangle lies in its ring (kRing): the ball about p is inside the
// ball about the triangle's clearance point, which holds no other surface. kConvexOutside: besides, p is outside and
// the ring lies below the planes of all triangles that hold the closest point c, so below the plane through c with
// normal p - c, a positive combination of theirs: only a triangle that holds c can be as near. c is inset enough that
// rounding cannot move it to another feature (the scene compiler checks kSafeInset against the size of those
// triangles).
Certificate certificate(const Surface& surface, Vec3 p, const Candidate& best) PALPATE_RT {
  const Triangle& t = surface.triangle[best.triangle];
  const double distance = square_root(best.distance2);
  const double spare = static_cast<double>(t.clear_radius_m) - distance;
  if (!(spare > 0)) return Certificate::kNone;
  const Vec3 a = surface.vertex[t.vertex[0]], b = surface.vertex[t.vertex[1]], c = surface.vertex[t.vertex[2]];
  const Vec3 normal = cross(b - a, c - a);
  const Vec3 clear = (1.0 / 3.0) * (a + b + c) + static_cast<double>(t.clear_scale_per_m) * normal;
  // The shrinking covers the rounding of this test, so that a triangle outside the ring cannot even tie.
  if (!(squared_norm(p - clear) < (1 - 1e-9) * (spare * spare))) return Certificate::kNone;
  const bool at_vertex = best.at.feature >= Feature::kVertex0;
  const bool convex = at_vertex ? t.ring_convex == 2 : t.ring_convex >= 1 && best.at.inset > kSafeInset;
  const bool outside = distance > kDirectionFloor_m && dot(p - best.at.point, normal) > 0;
  return convex && outside ? Certificate::kConvexOutside : Certificate::kRing;
}

// Measures the other triangles that hold the closest point of best.triangle. Returns whether one of them is nearer or
// as near with a lower index; false in `complete` where some could not be reached.
bool measure_sharers(const Surface& surface, Vec3 p, Candidate& best, bool& complete) PALPATE_RT {
  const std::int32_t centre = best.triangle;
  const Triangle& t = surface.triangle[centre];
  const auto code = static_cast<std::int32_t>(best.at.feature);
  complete = true;
  if (best.at.feature < Feature::kVertex0) {
    const std::int32_t across = t.adjacent[code - 1];
    complete = across >= 0;
    return complete && keep_nearer(surface, p, across, best);
  }
  const int corner = code - 4;
  const auto visit = [&](std::int32_t index, std::int32_t) PALPATE_RT { keep_nearer(surface, p, index, best); };
  complete = for_each_in_fan(surface.triangle, centre, corner, visit);
  // The one that closes the fan lies across the edge that ends at the corner.
  const std::int32_t last = t.adjacent[corner == 0 ? 2 : corner - 1];
  if (complete) keep_nearer(surface, p, last, best);
  return best.triangle != centre;
}

// Measures the ring of best.triangle, or as much of it as can matter. False where the ring is not complete.
bool search_ring(const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT {
  const std::int32_t centre = best.triangle;
  bool above = false;
  const auto test = [&](std::int32_t, std::int32_t newest)
                        PALPATE_RT { above |= !(dot(surface.vertex[newest], best.outward) <= best.ceiling); };
  if (!for_each_in_ring(surface.triangle, centre, test)) return false;
  if (above || best.at.feature >= Feature::kVertex0) {
    const auto visit = [&](std::int32_t index, std::int32_t) PALPATE_RT { consider(surface, p, index, best); };
    for_each_in_ring(surface.triangle, centre, visit);
  } else if (best.at.feature != Feature::kFace) {  // only the triangle across the edge can tie
    measure(surface, p, surface.triangle[centre].adjacent[static_cast<std::int32_t>(best.at.feature) - 1], best);
  }
  return true;
}

}  // namespace

Proof walk(const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT {
  bool searched = false;  // a ring, without a certificate: dear, so a walk that needs a second gives up
  for (std::int32_t step = 0; step < kMaxWalk; ++step) {
    const std::int32_t centre = best.triangle;
    const Certificate found = certificate(surface, p, best);
    const bool convex = found == Certificate::kConvexOutside;
    if (convex && best.at.feature == Feature::kFace) return Proof::kOutside;
    const bool at_border = found == Certificate::kNone && best.at.feature != Feature::kFace;
    if (convex || at_border) {
      const double lowest2 = best.distance2 - distance2_rounding(best);
      bool complete = false;
      const bool moved = measure_sharers(surface, p, best, complete);
      if (convex && complete && best.distance2 >= lowest2) return Proof::kOutside;  // all of them meet in one point
      if (moved) continue;
    }
    raise_ceiling(surface, p, best);
    if (found == Certificate::kNone && searched) return Proof::kNone;
    const bool complete = search_ring(surface, p, best);
    if (found != Certificate::kNone) return complete ? Proof::kNearest : Proof::kNone;
    if (!complete || best.triangle == centre) return Proof::kNone;
    searched = true;
  }
  raise_ceiling(surface, p, best);
  return Proof::kNone;
}

}  // namespace palpate
