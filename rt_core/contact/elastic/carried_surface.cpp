#include "rt_core/contact/elastic/carried_edge.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

using namespace elastic_layout;

// What a change of each corner's 12 numbers (displacement, deformation gradient) does to the travel.
struct TravelSlope {
  alignas(32) Real of[3][kTermFloats];
};

// Where the foot holds: the height's derivative in corners and normals, backwards through
//   sum w_i V_i - t sum w_i U_i = centre,  height = -(t |N| + sag),  N = sum w_i U_i,  sag = sum w_i (V_i - X) . U_i /
//   2,
// and the normals U = cof(F) n / |cof(F) n|. The plain n . sum w_i dV_i misses how the surface bends between its
// vertices: 1 to 3 % of a mode's pull on an arch (2026-11-22), and forces that are no slope of the energy.
TravelSlope travel_slope(const Model& model, ElasticRow& row, const CarriedTriangle& t) PALPATE_RT {
  const Vec3 *v = t.corners.v, *u = t.corners.u;
  const Real* w = row.foot.weight;
  const Vec3 mixed = w[0] * u[0] + w[1] * u[1] + w[2] * u[2], place = w[0] * v[0] + w[1] * v[1] + w[2] * v[2];
  Real share[3], sag = 0;
  for (int k = 0; k < 3; ++k) {  // bound: 3
    share[k] = 0.5 * dot(v[k] - place, u[k]);
    sag += w[k] * share[k];
  }
  const Real length = norm(mixed), below = -(row.foot.height_m + sag) / length, ratio = below / length;
  const Vec3 e1 = v[1] - v[0], e2 = v[2] - v[0], u1 = u[1] - u[0], u2 = u[2] - u[0];
  const Vec3 xy = cross(e1 - below * u1, e2 - below * u2);
  const Real along_b = ratio * dot(mixed, u1) + share[1] - share[0] - 0.5 * dot(e1, mixed);
  const Real along_c = ratio * dot(mixed, u2) + share[2] - share[0] - 0.5 * dot(e2, mixed);
  const Vec3 moved =
      along_b * row.foot.gradient_per_m[1] + along_c * row.foot.gradient_per_m[2] - (length / dot(xy, mixed)) * xy;
  row.rise = -moved;
  TravelSlope slope;
  const CornerNormals& rest = model.corner_normal[static_cast<std::size_t>(row.foot.triangle)];
  for (int k = 0; k < 3; ++k) {  // bound: 3
    const Vec3 by_place = -w[k] * (moved - 0.5 * (u[k] - mixed));
    const Vec3 by_normal = w[k] * (below * moved + ratio * mixed + 0.5 * (v[k] - place));
    const Vec3 n = rest.normal[k], *r = t.vertex[k].row;
    const Vec3 b = (1.0 / norm(t.vertex[k].carried(n))) * tangential_part(by_normal, u[k]);
    const Vec3 rows[4] = {by_place, b.y * cross(n, r[2]) + b.z * cross(r[1], n),
                          b.x * cross(r[2], n) + b.z * cross(n, r[0]), b.x * cross(n, r[1]) + b.y * cross(r[0], n)};
    for (int i = 0; i < 4; ++i) {
      slope.of[k][3 * i] = rows[i].x;
      slope.of[k][3 * i + 1] = rows[i].y;
      slope.of[k][3 * i + 2] = rows[i].z;
    }
  }
  return slope;
}

// On a facet, where the normal holds still.
TravelSlope facet_slope(const ElasticRow& row) PALPATE_RT {
  TravelSlope slope{};
  for (int k = 0; k < 3; ++k) {  // bound: 3
    slope.of[k][0] = row.foot.weight[k] * row.foot.normal_w.x;
    slope.of[k][1] = row.foot.weight[k] * row.foot.normal_w.y;
    slope.of[k][2] = row.foot.weight[k] * row.foot.normal_w.z;
  }
  return slope;
}

// How far each shape moves the surface towards the tip, how the corners under it move with each amplitude, and the
// material there: one pass over the shapes.
template <class Count>
void show_modes(const Model& model, Count soft, const Real* y, const TravelSlope& slope, ElasticRow& row,
                Double4 (&corner)[3][kMaxSoftModes]) PALPATE_RT {
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(row.foot.triangle)];
  const float* block[3];
  for (int k = 0; k < 3; ++k) block[k] = vertex_block(model, triangle.vertex[k]);  // bound: 3
  const auto along = [&](std::int32_t term, Double4(&moved)[3]) PALPATE_RT {
    Double4 total{};
    for (int k = 0; k < 3; ++k) {  // bound: 3 x 3
      const float* u = block[k] + kTermFloats * term;
      moved[k] = widen4(u);
      total += load4(slope.of[k]) * moved[k];
      for (int i = 4; i < kTermFloats; i += 4) total += load4(slope.of[k] + i) * widen4(u + i);
    }
    return sum(total);
  };
  Double4 moved[3];
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: 3 soft
    row.pull[a] = along(a, moved);
    for (int k = 0; k < 3; ++k) corner[k][a] = moved[k];
  }
  std::int32_t pair = 0;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: 3 pairs
    for (std::int32_t b = a; b < soft; ++b, ++pair) {
      const Real h = along(soft + pair, moved);
      row.pull[a] += h * y[b];
      row.pull[b] += h * y[a];
      row.turn[pair] = a == b ? 2 * h : h;
      for (int k = 0; k < 3; ++k) {
        corner[k][a] += splat4(y[b]) * moved[k];
        corner[k][b] += splat4(y[a]) * moved[k];
      }
    }
  }
  const Real* w = row.foot.weight;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: soft
    const Double4 sweep = splat4(w[0]) * corner[0][a] + splat4(w[1]) * corner[1][a] + splat4(w[2]) * corner[2][a];
    row.sweep_w[a] = {sweep[0], sweep[1], sweep[2]};
  }
}

// What the foot's slide adds to the travel's second derivative. The travel is the tip's radius less the distance f from
// its centre to the nearest place s, whose derivatives in amplitudes and place are, at distance d over curvature k,
//   f_a = -n.u_a,   f_ab = t_a.t_b / d - n.u_ab,   f_as = t_a / d - g_a,   f_ss = 1 / d + k,
// with t_a the tangential part of u_a and g_a the slope of n.u_a along the surface, 1 + k d times its slope G_a as the
// centre moves; and f_ab - f_as f_sb / f_ss is that of the nearest. Without it H lacked F d g_a.g_b, by which a body is
// held upright under a ball: one of 60 mm on a block of 20 threw it from side to side every tick (2026-11-23).
// The centre of a capsule's side slides too, so that along its axis f_ss is the body's curvature alone and t_a does
// nothing; where that is flat the touch goes to the capsule's end.
template <class Count>
void turn_with_foot(Count soft, ElasticRow& row, const Double4 (&corner)[3][kMaxSoftModes]) PALPATE_RT {
  const Vec3 n = row.foot.normal_w;
  const Real half = norm(row.tip.half_axis_w), side = row.tip.sideness(), on_side = max_of(row.along_1_per_m, 0.0);
  const Vec3 axis = half > 0 ? (side / half) * tangential_part(row.tip.half_axis_w, n) : Vec3{};
  const Real d = max_of(row.foot.height_m, 0.0),
             mean = row.curvature_1_per_m + side * (row.curvature_1_per_m - on_side);
  const Real bend = max_of(1 + mean * d, 0.5), curvature = bend > 1 ? mean / bend : 0.0, bent = 1 + on_side * d;
  const Real slide = half * bent * bent / (1 + on_side * half);
  Vec3 along[kMaxSoftModes], slope[kMaxSoftModes];
  Real on_axis[kMaxSoftModes];
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: 3 soft
    along[a] = tangential_part(row.sweep_w[a], n);
    for (int k = 0; k < 3; ++k) {
      const Double4& u = corner[k][a];
      slope[a] += (n.x * u[0] + n.y * u[1] + n.z * u[2]) * row.foot.gradient_per_m[k];
    }
    on_axis[a] = dot(slope[a], axis);
    slope[a] -= on_axis[a] * axis;
    along[a] -= dot(along[a], axis) * axis;
  }
  std::int32_t pair = 0;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: pairs
    for (std::int32_t b = a; b < soft; ++b, ++pair)
      row.turn[pair] += d * bend * dot(slope[a], slope[b]) - dot(along[a], slope[b]) - dot(slope[a], along[b]) -
                        curvature * dot(along[a], along[b]) + slide * on_axis[a] * on_axis[b];
  }
}

// On an edge the nearest place slides along it alone, at an end not at all: f_ab = s_a.s_b / d - n.u_ab, s_a what u_a
// has across.
template <class Count>
void turn_on_edge(Count soft, const EdgePlace& on, ElasticRow& row) PALPATE_RT {
  const Vec3 n = row.foot.normal_w;
  const Real square = squared_norm(on.along_w), bend = 1.0 / row.foot.height_m;
  Vec3 across[kMaxSoftModes];
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: soft
    across[a] = tangential_part(row.sweep_w[a], n);
    if (square > 0) across[a] -= (dot(across[a], on.along_w) / square) * on.along_w;
  }
  std::int32_t pair = 0;
  for (std::int32_t a = 0; a < soft; ++a)  // bound: pairs
    for (std::int32_t b = a; b < soft; ++b, ++pair) row.turn[pair] -= bend * dot(across[a], across[b]);
}

// A number between the vertices that hold it and its gradient g: the cubic that has both there, in Bezier form, its
// middle coefficient the one that keeps parabolas. Along an edge it is the same from both sides, and at the vertices
// the gradient has no kink. Straight between the vertices, c1's kink on the crest of a ring threw the tip aside by 0.5
// N of 10 N and to the other side beyond the edge (2026-11-22).
struct VertexCubic {
  Real corner[3], next[3], before[3], middle;

  // `edge_m`: X_(k+1) - X_k.
  VertexCubic(const Vec3* edge_m, const float* const* own, std::int32_t which) PALPATE_RT {
    Real sides = 0, corners = 0;
    for (int k = 0; k < 3; ++k) {  // bound: 3
      const float* g = own[k] + kOwnValues + 3 * which;
      const Vec3 gradient{static_cast<Real>(g[0]), static_cast<Real>(g[1]), static_cast<Real>(g[2])};
      corner[k] = static_cast<Real>(own[k][which]);
      next[k] = corner[k] + dot(gradient, edge_m[k]) / 3;
      before[k] = corner[k] - dot(gradient, edge_m[(k + 2) % 3]) / 3;
      sides += next[k] + before[k];
      corners += corner[k];
    }
    middle = 0.25 * sides - corners / 6;
  }
  // And its derivatives in the area coordinates.
  Real at(const Real* w, Real (&slope)[3]) const PALPATE_RT {
    Real value = 0;
    for (int k = 0; k < 3; ++k) {  // bound: 3
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      slope[k] = 3 * (w[k] * w[k] * corner[k] + w[i] * w[i] * before[i] + w[j] * w[j] * next[j]) +
                 6 * (w[k] * (w[i] * next[k] + w[j] * before[k]) + w[i] * w[j] * middle);
      value += w[k] * slope[k] / 3;  // Euler: homogeneous of degree three
    }
    return value;
  }
};

void show_modulus(const Model& model, ElasticRow& row) PALPATE_RT {
  row.modulus = 1;
  row.modulus_gradient = {};
  if (!has_moduli(model)) return;
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(row.foot.triangle)];
  row.modulus = 0;
  for (int k = 0; k < 3; ++k) {  // bound: 3
    const Real ratio = modulus_ratio(model, triangle.vertex[k]);
    row.modulus += row.foot.weight[k] * ratio;
    row.modulus_gradient += ratio * row.foot.gradient_per_m[k];
  }
}

void show_own_terms(const Model& model, ElasticRow& row) PALPATE_RT {
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(row.foot.triangle)];
  const float* own[3];
  Vec3 edge_m[3];
  for (int k = 0; k < 3; ++k) {  // bound: 3
    own[k] = own_terms(model, triangle.vertex[k]);
    edge_m[k] = model.vertex_m[static_cast<std::size_t>(triangle.vertex[(k + 1) % 3])] -
                model.vertex_m[static_cast<std::size_t>(triangle.vertex[k])];
  }
  Real value[kOwnSlopes];
  Vec3 gradient[kOwnSlopes];
  for (int i = 0; i < kOwnSlopes; ++i) {  // bound: 4 x 3
    Real slope[3];
    value[i] = VertexCubic(edge_m, own, i).at(row.foot.weight, slope);
    for (int k = 0; k < 3; ++k) gradient[i] += slope[k] * row.foot.gradient_per_m[k];
  }
  row.c_m_per_N = value[0];
  row.c1_m_per_N2 = value[1];
  row.curvature_1_per_m = value[2];
  row.beta_1_per_mN = value[3];
  row.c_gradient = gradient[0];
  row.c1_gradient = gradient[1];
  row.curvature_gradient = gradient[2];
  row.beta_gradient = gradient[3];
  show_modulus(model, row);
}

// One Newton step along a capsule's axis to where its height is least; `rise` and how the normal turns as the centre
// moves are the height's slope and curvature. On a flat or hollow place it stays. At most half the half axis.
void slide_along(const foot::Corners& corners, ElasticRow& row) PALPATE_RT {
  const Vec3 axis = row.tip.half_axis_w, n = row.foot.normal_w;
  Vec3 mixed;
  for (int k = 0; k < 3; ++k) mixed += row.foot.weight[k] * corners.u[k];  // bound: 3
  Real curvature = 0;
  for (int k = 0; k < 3; ++k)  // bound: 3
    curvature +=
        dot(row.foot.gradient_per_m[k], axis) * (dot(corners.u[k], axis) - dot(corners.u[k], n) * dot(n, axis));
  curvature /= norm(mixed);
  // At height t above a surface of curvature k the height bends by k / (1 + k t).
  const Real slope = dot(row.rise, axis), before = row.tip.along, bend = curvature / squared_norm(axis);
  row.along_1_per_m = bend / max_of(1.0 - bend * row.foot.height_m, 0.1);
  if (!(curvature > 1e-3 * norm(axis))) return;  // a radius of a thousand half axes
  row.tip.along = clamp_to(before + clamp_to(-slope / curvature, -0.5, 0.5), -1.0, 1.0);
  const Real step = row.tip.along - before;
  row.travel_m -= step * (slope + 0.5 * step * curvature);
}

}  // namespace

Real RoundTip::sideness() const PALPATE_RT {
  const Real length = norm(half_axis_w), from_end = (1.0 - abs_of(along)) * length;
  const Real share = margin_m > 0 ? clamp_to(from_end / margin_m, 0.0, 1.0) : 0.0;
  return share * share * (3 - 2 * share);
}

Vec3 CarriedSurface::displacement(std::int32_t vertex) const PALPATE_RT {
  const Vec3 rest = model.vertex_m[static_cast<std::size_t>(vertex)];
  return carry(model, y, vertex).position_w - rest;
}

void CarriedSurface::place(const RoundTip& tip, std::int32_t triangle, Vec3 near_w, Real nearer_m,
                           ElasticRow& row) const PALPATE_RT {
  CarriedTriangle last{model, y, shown, -1, {}, {}};
  row.tip = tip;
  row.along_1_per_m = 0;
  const Vec3 centre_w = row.placed_w = tip.centre_w();
  last.move_to(triangle);
  last.walk_below(near_w);
  find_carried_foot(centre_w, near_w, last, row);
  bool found = row.foot.state == FootState::kFound;
  EdgePlace on;
  if (row.foot.state == FootState::kEdge) {
    on = place_on_edge(centre_w, last, row);
    found = row.foot.state == FootState::kFound;
  }
  if (!found && on.edge < 0 && !place_on_facet(centre_w, triangle, row)) return;
  row.travel_m = tip.margin_m - row.foot.height_m;
  if (!(row.travel_m + nearer_m > 0)) {
    // Newton's steps to a foot that is too far; with the terms below they count themselves (24,962 instructions against
    // 24,522 without, half_shell, 2026-11-23).
    *shown += 2 * terms(model.params.elastic_soft);
    return;
  }
  if (!found) row.rise = row.foot.normal_w;
  const TravelSlope slope = found ? travel_slope(model, row, last) : facet_slope(row);
  show_own_terms(model, row);
  with_mode_count(model.params.elastic_soft, [&](auto n) PALPATE_RT {
    Double4 corner[3][kMaxSoftModes];
    show_modes(model, n, y, slope, row, corner);
    if (on.edge >= 0) turn_on_edge(n, on, row);
    if (!found) return;
    if (!tip.is_ball()) slide_along(last.corners, row);
    turn_with_foot(n, row, corner);
  });
  *shown += 6 * terms(model.params.elastic_soft) + (found && !tip.is_ball() ? kSlideWork : 0);
}

bool CarriedSurface::place_on_facet(Vec3 centre_w, std::int32_t triangle, ElasticRow& row) const PALPATE_RT {
  row.foot = {};
  if (*looked >= surface_work_share(model.params)) return false;
  const Vec3 moved = displacement(model.triangle[static_cast<std::size_t>(triangle)].vertex[0]);
  const SurfacePoint facet = closest_surface_point(model, centre_w - moved, kHuge, triangle, kMaxTipSearched);
  *looked += facet.looked;
  *shown += terms(model.params.elastic_soft);
  if (!facet.found) return false;
  row.foot.triangle = facet.triangle;
  facet_weights(model, facet.triangle, facet.closest_w, row.foot.weight);
  row.foot.normal_w = facet.normal_w;
  row.foot.foot_w = facet.closest_w + moved;
  row.foot.height_m = facet.signed_distance_m;
  return true;
}

void show_linear_modes(const Model& model, const ElasticRow& row, Real* along) PALPATE_RT {
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(row.foot.triangle)];
  const Vec3 n = row.foot.normal_w;
  const std::int32_t count = model.params.elastic_linear;
  for (std::int32_t m = 0; m < count; ++m) along[m] = 0;  // bound: kMaxLinearModes
  for (int k = 0; k < 3; ++k) {                           // bound: 3 kMaxLinearModes
    const float* shape = linear_shapes(model, triangle.vertex[k]);
    const Vec3 push = row.foot.weight[k] * n;
    for (std::int32_t m = 0; m < count; ++m)
      along[m] += push.x * static_cast<Real>(shape[3 * m]) + push.y * static_cast<Real>(shape[3 * m + 1]) +
                  push.z * static_cast<Real>(shape[3 * m + 2]);
  }
}

}  // namespace palpate
