#include "rt_core/surface/plane_proof.h"

#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/ring.h"
#include "rt_core/surface/ring_proof.h"

namespace palpate {

namespace {

constexpr int after(int k) { return k == 2 ? 0 : k + 1; }
constexpr int before(int k) { return k == 0 ? 2 : k - 1; }

TrianglePoint closest_on(const Surface& surface, Vec3 p, std::int32_t index) PALPATE_RT {
  const Triangle& t = surface.triangle[index];
  return closest_on_triangle(p, surface.vertex[t.vertex[0]], surface.vertex[t.vertex[1]], surface.vertex[t.vertex[2]]);
}

Border border_of(const Surface& surface, const Candidate& best) PALPATE_RT {
  const Triangle& t = surface.triangle[best.triangle];
  const auto code = static_cast<std::int32_t>(best.at.feature);
  if (best.at.feature >= Feature::kVertex0) return {-1, code - 4};
  const bool inset = best.at.inset > kSafeInset;
  if (best.at.feature == Feature::kFace) return inset ? Border{} : border_in_face(surface, t, best.at.point);
  const int k = code - 1, l = after(k);
  if (inset) return {k, -1};
  const Vec3 c = best.at.point;
  return {-1, squared_norm(c - surface.vertex[t.vertex[k]]) < squared_norm(c - surface.vertex[t.vertex[l]]) ? k : l};
}

std::int32_t turn_below(const Surface& surface, Vec3 p, std::int32_t index, std::int32_t middle,
                        Candidate& best) PALPATE_RT {
  const Turn turn = turn_about(surface, p - surface.vertex[middle], index, middle);
  best.looked += turn.passed / kSpokesPerLook;
  return turn.triangle;
}

// Measures the triangles of a flat fan about best.triangle's corner that can be as near as it within rounding: to both
// sides, as long as they are, since beyond a spoke that is farther all are, as far as the other side's. False where not
// all of them were.
bool measure_beside(const Surface& surface, Vec3 p, int corner, Candidate& best) PALPATE_RT {
  const std::int32_t begin = best.triangle, middle = surface.triangle[begin].vertex[corner];
  const double farther2 = best.distance2 + 4 * distance2_rounding(best);
  std::int32_t left = kMaxNearCorner;
  for (const bool counter : {true, false}) {  // bound: kMaxNearCorner
    std::int32_t at = begin;
    int k = corner;
    for (; left > 0; --left) {
      at = surface.triangle[at].adjacent[counter ? before(k) : k];
      if (at < 0) return false;
      if (at == begin) return true;
      k = corner_at(surface.triangle[at], middle);
      best.looked += 1;
      const TrianglePoint on = closest_on(surface, p, at);
      const double distance2 = squared_norm(p - on.point);
      if (distance2 > farther2) break;
      if (!(distance2 < best.distance2 || (distance2 == best.distance2 && at < best.triangle))) continue;
      best.distance2 = distance2;
      best.triangle = at;
      best.at = on;
    }
  }
  return left > 0;
}

// Over the middle of a fan in a plane across an axis, so near that what its triangles differ by does not show beside
// the height: every one of them is as near to the bit, and the lowest is the answer. Exactly over it all products are
// zero and all tell the middle itself; nearer than kEven_m the rounding of a needle's weights, which the scene compiler
// bounds, would show.
bool stands_over(Vec3 off) PALPATE_RT {
  constexpr Real kEven_m = 1e-4;
  const Real x = off.x * off.x, y = off.y * off.y, z = off.z * off.z;
  const Real height2 = max_of(x, max_of(y, z)), aside2 = min_of(x, y) + min_of(max_of(x, y), z);
  return aside2 == 0 || (height2 > kEven_m * kEven_m && 8 * aside2 < 0x1p-54 * height2);
}

Settled settle_at_corner(const Surface& surface, Vec3 p, int corner, Candidate& best) PALPATE_RT {
  const Triangle& t = surface.triangle[best.triangle];
  const std::int32_t middle = t.vertex[corner];
  const Vec3 hub = surface.vertex[middle];
  if (corner == ring_proof::hub_corner(t) && stands_over(p - hub)) {
    const std::int32_t lowest = ring_proof::lowest_about_hub(t);
    const TrianglePoint on = closest_on(surface, p, lowest);
    best.looked += 1;
    if (squared_norm(p - on.point) == squared_norm(p - hub)) {
      best.triangle = lowest;
      best.at = on;
      best.distance2 = squared_norm(p - on.point);
      return Settled::kNearest;
    }
  }
  const double lowest2 = best.distance2 - distance2_rounding(best);
  if (best.at.feature != Feature::kFace) {
    const std::int32_t below = turn_below(surface, p, best.triangle, middle, best);
    if (below < 0) return Settled::kNone;
    keep_nearer(surface, p, below, best);
    if (best.distance2 < lowest2) return Settled::kTurned;
  }
  const bool all = measure_beside(surface, p, corner_at(surface.triangle[best.triangle], middle), best);
  if (best.distance2 < lowest2) return Settled::kMoved;
  return all ? Settled::kNearest : Settled::kNone;
}

}  // namespace

Border border_in_face(const Surface& surface, const Triangle& t, Vec3 c) PALPATE_RT {
  const Vec3 v[3] = {surface.vertex[t.vertex[0]], surface.vertex[t.vertex[1]], surface.vertex[t.vertex[2]]};
  const Vec3 n = cross(v[1] - v[0], v[2] - v[0]);
  const double least = kSafeInset * squared_norm(n);
  Border border;
  int near = 0, far_edge = 0;
  for (int k = 0; k < 3; ++k) {  // bound: 3
    const bool is_near = dot(cross(v[after(k)] - v[k], c - v[k]), n) <= least;
    near += is_near ? 1 : 0;
    border.edge = is_near ? k : border.edge;
    far_edge = is_near ? far_edge : k;
  }
  if (near == 2) border = {-1, before(far_edge)};  // the corner that is not on the edge it is far from
  return border;
}

Turn turn_about(const Surface& surface, Vec3 off, std::int32_t index, std::int32_t middle) PALPATE_RT {
  const Vec3 hub = surface.vertex[middle];
  const Triangle* t = surface.triangle + index;
  const Vec3 a = surface.vertex[t->vertex[0]];
  const Vec3 s = cross(off, cross(surface.vertex[t->vertex[1]] - a, surface.vertex[t->vertex[2]] - a));
  int k = corner_at(*t, middle);
  // Left of a spoke: counter-clockwise.
  const auto is_left = [&](int end) PALPATE_RT { return dot(surface.vertex[t->vertex[end]] - hub, s) >= 0; };
  const bool left = is_left(before(k));
  Turn turn;
  while (turn.passed < kMaxTurn && (left ? is_left(before(k)) : !is_left(after(k)))) {  // bound: kMaxTurn
    index = t->adjacent[left ? before(k) : k];
    if (index < 0) return turn;
    t = surface.triangle + index;
    k = corner_at(*t, middle);
    turn.passed += 1;
  }
  turn.triangle = turn.passed < kMaxTurn ? index : -1;
  return turn;
}

Settled settle_by_planes(const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT {
  const Triangle& t = surface.triangle[best.triangle];
  const Border border = border_of(surface, best);
  if (border.corner >= 0)
    return ring_proof::is_flat_about(t, border.corner) ? settle_at_corner(surface, p, border.corner, best)
                                                       : Settled::kNone;
  if (border.edge < 0) return Settled::kNearest;
  const std::int32_t across = t.adjacent[border.edge];
  if (across < 0) return Settled::kNone;
  const double lowest2 = best.distance2 - distance2_rounding(best);
  keep_nearer(surface, p, across, best);
  if (!(best.distance2 < lowest2)) return Settled::kNearest;
  // Over a spoke of a fan: on to the needle below, if that is not it.
  for (const int end : {border.edge, after(border.edge)}) {  // bound: 2
    if (!ring_proof::is_flat_about(t, end)) continue;
    const std::int32_t below = turn_below(surface, p, across, t.vertex[end], best);
    if (below >= 0 && below != across && keep_nearer(surface, p, below, best)) return Settled::kTurned;
  }
  return Settled::kMoved;
}

}  // namespace palpate
