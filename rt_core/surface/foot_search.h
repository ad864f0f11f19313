// The search behind smooth_foot(), for any surface with the mesh's triangles: at rest, or carried by an elastic body.
#pragma once

#include "rt_core/limits.h"
#include "rt_core/surface/plane_proof.h"
#include "rt_core/surface/ring_proof.h"
#include "rt_core/surface/smooth_foot.h"

namespace palpate::foot {

// An area coordinate this far below zero still counts as on the edge.
inline constexpr Real kOutside = 1e-9;
// One this far below zero will not come back in two more steps: the triangle is left at once. A tip that crosses five
// triangles in a tick took a fifth less (ring, thrown about: 50,500 -> 46,800 instructions, 2026-11-23). Nor will one
// that is outside by so much of the last step's square, of which the next is: a clip's arm that springs back crosses
// two triangles in four steps instead of eight (2026-11-26).
inline constexpr Real kFarOutside = -0.25, kOutsideOfSquare = -0.25;
// A foot this far outside a triangle that it has just come to is passed on without a step. Both where corners are dear:
// on the body at rest a step is what a tick counts.
inline constexpr Real kPassed = -0.05;
// An area coordinate this near to one: at a vertex, on all the triangles that meet there. Where they lie in one plane
// any of them is as good, and Newton's steps would be sent on round the vertex.
inline constexpr Real kAtVertex = 1e-6;
// Newton has converged when neither the foot nor the height moves by more than this: far below an atom.
inline constexpr Real kStill_m = 1e-14;
// Of a fan, that cost what one of Newton's steps does.
inline constexpr std::int32_t kSpokesPerStep = 16;

struct Corners {
  Vec3 v[3], u[3];
};

// Place on one triangle: area coordinates 1 - b - c, b, c, and distance t along the mixed normal.
struct Place {
  Real b = 0, c = 0, t = 0;
};

// One linearisation of the projection, and the step that solves it.
struct Step {
  bool usable = false;
  Vec3 normal, along_b, along_c;  // gradients of b and c with respect to p
  Real db = 0, dc = 0, dt = 0;
};

inline Step newton_step(const Corners& k, Vec3 p, const Place& at) PALPATE_RT {
  const Vec3 e1 = k.v[1] - k.v[0], e2 = k.v[2] - k.v[0], u1 = k.u[1] - k.u[0], u2 = k.u[2] - k.u[0];
  Step step;
  step.normal = k.u[0] + at.b * u1 + at.c * u2;
  const Vec3 rest = k.v[0] + at.b * e1 + at.c * e2 - at.t * step.normal - p;
  const Vec3 x = e1 - at.t * u1, y = e2 - at.t * u2, xy = cross(x, y);
  const Real jacobian = dot(xy, step.normal), flat = dot(cross(e1, e2), step.normal);
  if (!(flat > 0 && jacobian > kLeastJacobian * flat)) return step;
  const Real inverse = 1.0 / jacobian;
  step.along_b = inverse * cross(y, step.normal);
  step.along_c = inverse * cross(step.normal, x);
  step.db = -dot(rest, step.along_b);
  step.dc = -dot(rest, step.along_c);
  step.dt = inverse * dot(rest, xy);
  step.usable = true;
  return step;
}

inline Real least_coordinate(const Place& at) PALPATE_RT { return min_of(min_of(1.0 - at.b - at.c, at.b), at.c); }

inline bool is_at_flat_vertex(const Triangle& t, const Place& at) PALPATE_RT {
  if (!ring_proof::is_by_planes(t)) return false;
  const Real a = 1.0 - at.b - at.c;
  const int corner = a > 1 - kAtVertex ? 0 : at.b > 1 - kAtVertex ? 1 : at.c > 1 - kAtVertex ? 2 : -1;
  return corner >= 0 && least_coordinate(at) > -kAtVertex && ring_proof::is_flat_about(t, corner);
}

// Edge to cross: that of the most negative coordinate; -1 when the foot is inside. Edge k joins corners k and k + 1, so
// it is left through the coordinate of corner k + 2.
inline int edge_to_cross(const Place& at) PALPATE_RT {
  const Real a = 1.0 - at.b - at.c, least = least_coordinate(at);
  if (least >= -kOutside) return -1;
  return least == at.c ? 0 : least == a ? 1 : 2;
}

// The triangle across an edge, or -1 where the smooth surface ends there: its normals differ on the two sides.
inline std::int32_t across(const Model& model, std::int32_t triangle, int edge) PALPATE_RT {
  const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
  const CornerNormals& here = model.corner_normal[static_cast<std::size_t>(triangle)];
  const std::int32_t next = t.adjacent[edge];
  if (next < 0) return -1;
  const Triangle& n = model.triangle[static_cast<std::size_t>(next)];
  const CornerNormals& normals = model.corner_normal[static_cast<std::size_t>(next)];
  for (int end = 0; end < 2; ++end) {  // bound: 2 x 3
    const int corner = (edge + end) % 3;
    for (int k = 0; k < 3; ++k) {
      if (n.vertex[k] == t.vertex[corner] && !(normals.normal[k] == here.normal[corner])) return -1;
    }
  }
  return next;
}

// The corner about which a foot that leaves through an edge is turned on to the triangle below it, needles and needles
// away maybe: an end of the edge in a flat fan; -1: neither, and the triangle across is next.
inline int corner_to_turn_about(const Triangle& t, int edge) PALPATE_RT {
  if (!ring_proof::is_by_planes(t)) return -1;
  const int end = edge == 2 ? 0 : edge + 1, hub = ring_proof::hub_corner(t);
  if (hub == edge || hub == end) return hub;
  return ring_proof::is_flat_about(t, edge) ? edge : ring_proof::is_flat_about(t, end) ? end : -1;
}

// Area coordinates on another triangle of the point nearest to `foot` in its plane. `v`: its corners.
inline Place place_on(const Vec3* v, Vec3 foot, Real t) PALPATE_RT {
  const Vec3 e1 = v[1] - v[0], e2 = v[2] - v[0], d = foot - v[0], n = cross(e1, e2);
  const Real square = squared_norm(n);
  if (!(square > 0)) return {1.0 / 3, 1.0 / 3, t};
  return {dot(cross(d, e2), n) / square, dot(cross(e1, d), n) / square, t};
}

inline Place place_on(const Corners& k, Vec3 foot, Real t) PALPATE_RT { return place_on(k.v, foot, t); }

inline Vec3 flat_foot(const Vec3* v, const Place& at) PALPATE_RT {
  return v[0] + at.b * (v[1] - v[0]) + at.c * (v[2] - v[0]);
}
inline Vec3 flat_foot(const Corners& k, const Place& at) PALPATE_RT { return flat_foot(k.v, at); }

// A triangle's corners on the body at rest.
struct RestCorners {
  Vec3 v[3];
  RestCorners(const Model& model, std::int32_t triangle) PALPATE_RT {
    const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
    for (int k = 0; k < 3; ++k) v[k] = model.vertex_m[static_cast<std::size_t>(t.vertex[k])];  // bound: 3
  }
};

// Over the triangles that a foot is clearly beyond, as flat ones at rest tell, which need neither be carried along nor
// have normals. `triangle`: the first, then where it ends. Returns the place there.
inline Place pass(const Model& model, Vec3 rest_foot, Real t, std::int32_t most, std::int32_t& walked,
                  std::int32_t& triangle) PALPATE_RT {
  Place at = place_on(RestCorners(model, triangle).v, rest_foot, t);
  for (; walked < most && least_coordinate(at) < kPassed; ++walked) {  // bound: most
    const std::int32_t next = across(model, triangle, edge_to_cross(at));
    if (next < 0) break;
    triangle = next;
    at = place_on(RestCorners(model, triangle).v, rest_foot, t);
  }
  return at;
}

// kSags: off the facet by the parabola of smooth_foot(); else on it, and the caller adds what it stands off.
template <bool kSags>
inline SmoothFoot foot_at(const Corners& k, std::int32_t triangle, const Place& at, const Step& step) PALPATE_RT {
  SmoothFoot foot;
  const Real length = norm(step.normal);
  if (!(length > 0.5)) return foot;
  foot.state = FootState::kFound;
  foot.triangle = triangle;
  foot.weight[0] = 1.0 - at.b - at.c;
  foot.weight[1] = at.b;
  foot.weight[2] = at.c;
  foot.gradient_per_m[1] = step.along_b;
  foot.gradient_per_m[2] = step.along_c;
  foot.gradient_per_m[0] = -(step.along_b + step.along_c);
  const Vec3 flat = flat_foot(k, at);
  Real sag = 0;
  for (int i = 0; i < 3 && kSags; ++i) sag += 0.5 * foot.weight[i] * dot(k.v[i] - flat, k.u[i]);  // bound: 3
  foot.normal_w = (1.0 / length) * step.normal;
  foot.foot_w = flat + sag * foot.normal_w;
  foot.height_m = -(at.t * length + sag);
  return foot;
}

// As smooth_foot(), on the surface whose corners `corners_of(triangle)` gives, from the foot of `near_w`. The last step
// is at most `still_m`; what is left then is its square over the radius of the surface. At most `most_crossed` edges
// are crossed, and one fan passed round: `at_rest(corner, off)` takes what is off a corner back to the body at rest.
// `steps`: counts Newton's. `passed`: adds the spokes of the fan. kCarried: its corners are not those at rest, and the
// foot is on the facet, off which the caller moves it.
template <bool kCarried, class CornersOf, class AtRest>
SmoothFoot search(const Model& model, const CornersOf& corners_of, const AtRest& at_rest, Vec3 p, std::int32_t triangle,
                  Vec3 near_w, Real still_m = kStill_m, std::int32_t most_crossed = kFootWalk,
                  std::int32_t* steps = nullptr, std::int32_t* passed = nullptr) PALPATE_RT {
  if (triangle < 0 || static_cast<std::size_t>(triangle) >= model.corner_normal.size() || !is_finite(p)) return {};
  Corners corners = corners_of(triangle);
  Place at = place_on(corners, near_w, 0.0);
  at.t = dot(flat_foot(corners, at) - p, corners.u[0]);
  std::int32_t walked = 0, on_this = 0;
  bool turned = false;
  for (std::int32_t i = 0; i < kFootNewtonSteps; ++i) {  // bound: kFootNewtonSteps
    const Step step = newton_step(corners, p, at);
    if (steps != nullptr) *steps = i + 1;
    if (!step.usable) return {};
    const Real size = norm(corners.v[1] - corners.v[0]) + norm(corners.v[2] - corners.v[0]);
    const Real went = abs_of(step.db) + abs_of(step.dc);
    const bool still = size * went + abs_of(step.dt) <= still_m;
    at.b += step.db;
    at.c += step.dc;
    at.t += step.dt;
    on_this += 1;
    const Real far = kCarried ? max_of(kFarOutside, kOutsideOfSquare * went * went) : kFarOutside;
    const bool outside = least_coordinate(at) < far;
    if (!still && !outside && on_this < 3) continue;
    const int edge = edge_to_cross(at);
    if (edge < 0 || is_at_flat_vertex(model.triangle[static_cast<std::size_t>(triangle)], at)) {
      if (still) return foot_at<!kCarried>(corners, triangle, at, step);
      continue;
    }
    std::int32_t next = walked < most_crossed ? across(model, triangle, edge) : -1;
    if (next < 0) {
      SmoothFoot lost;
      lost.state = walked < most_crossed ? FootState::kEdge : FootState::kFar;
      return lost;
    }
    const Vec3 foot = flat_foot(corners, at);
    const Vec3 rest_foot = kCarried ? flat_foot(RestCorners(model, triangle).v, at) : foot;
    const Triangle& here = model.triangle[static_cast<std::size_t>(triangle)];
    const int corner = turned ? -1 : corner_to_turn_about(here, edge);
    if (corner >= 0) {
      const Turn turn = turn_about({model.triangle.data(), model.vertex_m.data()},
                                   at_rest(corner, foot - corners.v[corner]), triangle, here.vertex[corner]);
      if (turn.triangle >= 0 && turn.triangle != triangle) next = turn.triangle;
      if (passed != nullptr) *passed += turn.passed;
      turned = true;
    }
    triangle = next;
    walked += 1;
    if constexpr (kCarried) at = pass(model, rest_foot, at.t, most_crossed, walked, triangle);
    corners = corners_of(triangle);
    if constexpr (!kCarried) at = place_on(corners, rest_foot, at.t);
    on_this = 0;
  }
  return {};
}

}  // namespace palpate::foot
