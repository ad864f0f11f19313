#include "rt_core/surface/closest_point.h"

#include "rt_core/surface/candidate.h"
#include "rt_core/surface/plane_proof.h"
#include "rt_core/surface/ring.h"
#include "rt_core/surface/ring_proof.h"

namespace palpate {

namespace {

// Squared distance of the closest point from the border of its feature, at least; kHuge for a vertex, which has none.
// Also notes the vertices of the feature.
double border_distance2(const Surface& surface, Candidate& best) PALPATE_RT {
  const Triangle& t = surface.triangle[best.triangle];
  const auto code = static_cast<std::int32_t>(best.at.feature);
  const double inset2 = best.at.inset * best.at.inset;
  if (best.at.feature >= Feature::kVertex0) {
    best.shared[0] = best.shared[1] = t.vertex[code - 4];
    return kHuge;
  }
  if (best.at.feature != Feature::kFace) {
    best.shared[0] = t.vertex[code - 1];
    best.shared[1] = t.vertex[code % 3];
    return inset2 * squared_norm(surface.vertex[best.shared[1]] - surface.vertex[best.shared[0]]);
  }
  best.shared[0] = best.shared[1] = -1;
  const Vec3 a = surface.vertex[t.vertex[0]], b = surface.vertex[t.vertex[1]], c = surface.vertex[t.vertex[2]];
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const double longest2 = max_of(max_of(squared_norm(ab), squared_norm(bc)), squared_norm(ca));
  // The least weight times the least altitude, which is twice the area over the longest side.
  return longest2 > 0 ? inset2 * squared_norm(cross(ab, ca)) / longest2 : 0.0;
}

}  // namespace

void raise_ceiling(const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT {
  const double rounding = distance2_rounding(best);
  const bool usable = border_distance2(surface, best) > max_of(4 * rounding + 1e-16, 1e-10 * best.distance2);
  best.outward = usable ? p - best.at.point : Vec3{};
  best.ceiling = usable ? dot(best.at.point, best.outward) + rounding : -1.0;
}

void measure(const Surface& surface, const Vec3& p, std::int32_t index, Candidate& best) PALPATE_RT {
  if (keep_nearer(surface, p, index, best)) raise_ceiling(surface, p, best);
}

namespace {

// The short cut of a warm query: from last tick's triangle to the nearest, over neighbours, with proof.
enum class Proof : std::int32_t {
  kNone = 0,     // a nearer triangle may exist elsewhere: ask the hierarchy
  kNearest = 1,  // best.triangle is the nearest of all (lowest index among equals)
  kOutside = 2,  // the same, and p lies outside the body, farther than kDirectionFloor_m
};

// Triangles a walk may cross before the hierarchy is searched: a tool at 1 m/s moves 1 mm per tick, six edges of the
// finest meshes, and a leaf reached straight down the hierarchy lies within 20 of the nearest on a million triangles
// (ellipsoid, 2026-11-21). A step costs some 250 instructions, a search 3,000 to 12,000.
constexpr std::int32_t kMaxWalk = 24;

enum class Certificate : std::int32_t { kNone, kRing, kConvexOutside, kByPlanes };

// Whether every surface point as near to p as best.triangle lies in its ring (kRing): the ball about p is inside the
// ball about the triangle's clearance point, which holds no other surface. kConvexOutside: besides, p is outside and
// the ring lies below the planes of all triangles that hold the closest point c, so below the plane through c with
// normal p - c, a positive combination of theirs: only a triangle that holds c can be as near. c is inset enough that
// rounding cannot move it to another feature (the scene compiler checks kSafeInset against the size of those
// triangles). kByPlanes: p is outside, and what is as near lies below the planes that plane_proof.h goes by.
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
  const bool outside = distance > kDirectionFloor_m && dot(p - best.at.point, normal) > 0;
  if (ring_proof::is_by_planes(t)) return outside ? Certificate::kByPlanes : Certificate::kNone;
  const bool at_vertex = best.at.feature >= Feature::kVertex0;
  const bool convex = at_vertex ? t.ring_convex == 2 : t.ring_convex >= 1 && best.at.inset > kSafeInset;
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

// Improves `best`, which holds a measured triangle (its ceiling need not be up to date; it is afterwards when kNone is
// returned). The proof rests on Triangle::clear_*: see measure_clearance in the scene compiler. The price does not
// depend on the size of the mesh. Bound: kMaxWalk fans and two rings, `most_work` and what a ring or fan adds, and one
// turn with kMaxWarmWork.
Proof walk(const Surface& surface, Vec3 p, std::int32_t most_work, Candidate& best) PALPATE_RT {
  bool searched = false;  // a ring, without a certificate: dear, so a walk that needs a second gives up
  bool turned = false;    // about a fan's middle: once it does not count
  std::int32_t most_looked = best.looked + most_work;
  for (std::int32_t step = 0; step < kMaxWalk && best.looked < most_looked; ++step) {
    const std::int32_t centre = best.triangle;
    const Certificate found = certificate(surface, p, best);
    const bool convex = found == Certificate::kConvexOutside;
    if (convex && best.at.feature == Feature::kFace) return Proof::kOutside;
    if (found == Certificate::kByPlanes) {
      const Settled settled = settle_by_planes(surface, p, best);
      if (settled == Settled::kNearest) return Proof::kOutside;
      if (settled == Settled::kNone) break;
      if (settled == Settled::kTurned && !turned) most_looked = best.looked + kMaxWarmWork;
      turned |= settled == Settled::kTurned;
      continue;
    }
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

constexpr double kUnlimited_m = 1e9;

Vec3 face_normal(const Model& model, std::int32_t triangle) PALPATE_RT {
  const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
  const Vec3 a = model.vertex_m[static_cast<std::size_t>(t.vertex[0])];
  const Vec3 b = model.vertex_m[static_cast<std::size_t>(t.vertex[1])];
  const Vec3 c = model.vertex_m[static_cast<std::size_t>(t.vertex[2])];
  return cross(b - a, c - a);
}

// Fills the answer from the nearest triangle; `outside` when the side is already known. As a call it took 13
// instructions more of every query.
[[gnu::always_inline]] inline void report(const Model& model, Vec3 p, const Candidate& best, bool outside,
                                          SurfacePoint& result) PALPATE_RT {
  result.found = true;
  result.triangle = best.triangle;
  result.feature = best.at.feature;
  result.closest_w = best.at.point;
  const Vec3 offset = p - best.at.point;
  const double distance = square_root(best.distance2);
  if (outside) {
    result.signed_distance_m = distance;
    result.normal_w = (1.0 / distance) * offset;
    return;
  }
  const Vec3 pseudo = pseudo_normal(model, best.triangle, best.at.feature);
  const double side = dot(offset, pseudo) < 0 ? -1.0 : 1.0;
  result.signed_distance_m = side * distance;
  result.normal_w = distance > kDirectionFloor_m ? (side / distance) * offset : unit_or(pseudo, {0, 0, 1});
}

}  // namespace

Vec3 pseudo_normal(const Model& model, std::int32_t triangle, Feature feature) PALPATE_RT {
  const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
  const Vec3 face = face_normal(model, triangle);
  if (feature == Feature::kFace) return face;
  const auto code = static_cast<std::size_t>(feature);
  if (feature >= Feature::kVertex0) return model.vertex_normal[static_cast<std::size_t>(t.vertex[code - 4])];
  const std::int32_t other = t.adjacent[code - 1];
  const Vec3 unit = unit_or(face, {});
  return other < 0 ? unit : unit + unit_or(face_normal(model, other), {});
}

SurfacePoint closest_surface_point(const Model& model, Vec3 p, double search_radius_m, std::int32_t warm_triangle,
                                   std::int32_t most_searched) PALPATE_RT {
  SurfacePoint result;
  if (!is_finite(p)) return result;
  Candidate best;
  const double radius = search_radius_m < kUnlimited_m ? max_of(search_radius_m, 0.0) : 2 * kHuge;
  best.distance2 = radius * radius;
  const Surface surface{model.triangle.data(), model.vertex_m.data()};
  const auto triangles = static_cast<std::int32_t>(model.triangle.size());
  Proof proof = Proof::kNone;
  if (warm_triangle >= 0 && warm_triangle < triangles && keep_nearer(surface, p, warm_triangle, best)) {
    proof = walk(surface, p, kMaxWarmWork, best);
  }
  if (proof == Proof::kNone && land(model, surface, p, best)) proof = walk(surface, p, kMaxLandedWork, best);
  if (proof == Proof::kNone) {
    const DescentResult descent = descend(model, surface, p, most_searched, best);
    result.nodes = descent.nodes;
    best.looked += descent.nodes;
    result.stack_high_water = descent.stack_high_water;
    result.lower_bound_m = descent.lower_bound_m;
    result.truncated = descent.truncated;
  } else {
    result.lower_bound_m = square_root(best.distance2);
  }
  result.looked = best.looked;
  if (best.triangle != INT32_MAX) report(model, p, best, proof == Proof::kOutside, result);
  return result;
}

SurfacePoint nearer_surface_point(const Model& model, Vec3 p, double than_m, std::int32_t most_searched) PALPATE_RT {
  SurfacePoint result;
  if (!is_finite(p) || !(than_m > 0)) return result;
  Candidate best;
  best.distance2 = than_m * than_m;
  const DescentResult descent = descend(model, {model.triangle.data(), model.vertex_m.data()}, p, most_searched, best);
  result.nodes = descent.nodes;
  result.looked = best.looked + descent.nodes;
  result.stack_high_water = descent.stack_high_water;
  result.lower_bound_m = descent.lower_bound_m;
  result.truncated = descent.truncated;
  if (best.triangle != INT32_MAX) report(model, p, best, false, result);
  return result;
}

}  // namespace palpate
