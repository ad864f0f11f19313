#include <type_traits>

#include "rt_core/contact/elastic/carried_edge.h"
#include "rt_core/contact/elastic/line_place.h"
#include "rt_core/contact/elastic/place_numbers.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/facet_sag.h"

namespace palpate {

namespace {

using namespace elastic_layout;

// What a change of each corner's 12 numbers (displacement, deformation gradient) does to one number.
struct CornerSlope {
  alignas(32) Real of[3][kTermFloats];
};
// To the travel, and the other way to the foot's area coordinates 1 and 2.
struct FootSlopes {
  CornerSlope travel, slide[2];
};

// How a corner's unit normal U = cof(F) n / |cof(F) n| turns with the rows r_i of its F.
struct CornerTurn {
  Vec3 across[3];  // n x r_i
  Real inverse;    // 1 / |cof(F) n|

  CornerTurn(const CarriedVertex& vertex, Vec3 n, Real inverse_length) PALPATE_RT : inverse(inverse_length) {
    for (int i = 0; i < 3; ++i) across[i] = cross(n, vertex.row[i]);  // bound: 3
  }
  // What changes of the corner's place and of its normal are, in its 12 numbers.
  void show(Vec3 unit_normal, Vec3 by_place, Vec3 by_normal, Real* out) const PALPATE_RT {
    const Vec3 b = inverse * tangential_part(by_normal, unit_normal);
    const Vec3 rows[4] = {by_place, b.y * across[2] - b.z * across[1], b.z * across[0] - b.x * across[2],
                          b.x * across[1] - b.y * across[0]};
    for (int i = 0; i < 4; ++i) {  // bound: 4
      out[3 * i] = rows[i].x;
      out[3 * i + 1] = rows[i].y;
      out[3 * i + 2] = rows[i].z;
    }
  }
};
using CornerTurns = CornerTurn[3];

// Where the foot holds: the height's derivative in corners and normals, backwards through
//   sum w_i V_i - t sum w_i U_i = centre,  height = -(t |N| + sag),  N = sum w_i U_i,
// the sag and the corners' normals. The plain n . sum w_i dV_i misses how the surface bends between its
// vertices: 1 to 3 % of a mode's pull on an arch (2026-11-22), and forces that are no slope of the energy.
// Returns t.
Real travel_slope(const CornerTurns& turns, const FacetSag& sag, ElasticRow& row, const CarriedTriangle& t,
                  CornerSlope& slope) PALPATE_RT {
  const Vec3 *v = t.corners.v, *u = t.corners.u;
  const Real* w = row.foot.weight;
  const Vec3 mixed = w[0] * u[0] + w[1] * u[1] + w[2] * u[2];
  const Real length = norm(mixed), below = -(row.foot.height_m + sag.value_m) / length, ratio = below / length;
  const Vec3 e1 = v[1] - v[0], e2 = v[2] - v[0], u1 = u[1] - u[0], u2 = u[2] - u[0];
  const Vec3 xy = cross(e1 - below * u1, e2 - below * u2);
  const Double4 sags = sag.slope_m();
  const Real along_b = ratio * dot(mixed, u1) + sags[1] - sags[0];
  const Real along_c = ratio * dot(mixed, u2) + sags[2] - sags[0];
  const Vec3 moved =
      along_b * row.foot.gradient_per_m[1] + along_c * row.foot.gradient_per_m[2] - (length / dot(xy, mixed)) * xy;
  row.rise = -moved;
  const Double4 weight{w[0], w[1], w[2], w[2]};
  const Vec3x4 by_place = sag.by_place() - weight * splat4(moved);
  const Vec3x4 by_normal = sag.by_normal() + weight * splat4(below * moved + ratio * mixed);
  for (std::uint32_t k = 0; k < 3; ++k) turns[k].show(u[k], by_place[k], by_normal[k], slope.of[k]);  // bound: 3
  return below;
}

// Moves a foot off its facet.
FacetSag smooth_sag(const Model& model, const CarriedTriangle& t, SmoothFoot& foot) PALPATE_RT {
  const FacetSag sag(t.corners, foot::RestCorners(model, foot.triangle).v, foot.weight);
  foot.foot_w += sag.value_m * foot.normal_w;
  foot.height_m -= sag.value_m;
  return sag;
}

// The same equation differentiated: sum w_i (dV_i - t dU_i) moves the foot along the material as the centre going the
// other way does.
void slide_slopes(const CornerTurns& turns, const ElasticRow& row, const CarriedTriangle& t, Real below,
                  CornerSlope (&slide)[2]) PALPATE_RT {
  for (int i = 0; i < 2; ++i) {  // bound: 2 x 3
    const Vec3 to = row.foot.gradient_per_m[i + 1];
    for (int k = 0; k < 3; ++k) {
      const Vec3 by_place = row.foot.weight[k] * to;
      turns[k].show(t.corners.u[k], by_place, -below * by_place, slide[i].of[k]);
    }
  }
}

// On a facet, where the normal holds still.
CornerSlope facet_slope(const ElasticRow& row) PALPATE_RT {
  CornerSlope slope{};
  for (int k = 0; k < 3; ++k) {  // bound: 3
    slope.of[k][0] = row.foot.weight[k] * row.foot.normal_w.x;
    slope.of[k][1] = row.foot.weight[k] * row.foot.normal_w.y;
    slope.of[k][2] = row.foot.weight[k] * row.foot.normal_w.z;
  }
  return slope;
}

Real first_of(Real one) PALPATE_RT { return one; }
Real first_of(const Double4& four) PALPATE_RT { return four[0]; }
// The sums of three vectors, each in the order of sum().
Double4 sums(const Double4& a, const Double4& b, const Double4& c) PALPATE_RT {
  const Double4 two = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Double4 third = c + __builtin_shufflevector(c, c, 1, 0, 3, 2);
  return __builtin_shufflevector(two, third, 0, 1, 4, 4) + __builtin_shufflevector(two, third, 2, 3, 6, 6);
}

// How far each shape moves the surface towards the tip and, with kSlides, the foot along the material, how the corners
// under it move with each amplitude, and the material there: one pass over the shapes. What the corners' places do to
// the slides comes last, by `corner`.
template <bool kSlides, class Count>
void show_modes(const Model& model, Count soft, const Real* y, const FootSlopes& slopes, ElasticRow& row,
                Double4 (&corner)[3][kMaxSoftModes]) PALPATE_RT {
  using Along = std::conditional_t<kSlides, Double4, Real>;  // travel, slides
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(row.foot.triangle)];
  const float* block[3];
  for (int k = 0; k < 3; ++k) block[k] = vertex_block(model, triangle.vertex[k]);  // bound: 3
  const auto along = [&](std::int32_t term, Double4(&moved)[3]) PALPATE_RT {
    Double4 total{}, slide[2] = {};
    for (int k = 0; k < 3; ++k) {  // bound: 3 x 3
      const float* u = block[k] + kTermFloats * term;
      moved[k] = widen4(u);
      total += load4(slopes.travel.of[k]) * moved[k];
      for (int i = 4; i < kTermFloats; i += 4) {
        const Double4 part = widen4(u + i);
        total += load4(slopes.travel.of[k] + i) * part;
        if constexpr (kSlides)
          for (int s = 0; s < 2; ++s) slide[s] += load4(slopes.slide[s].of[k] + i) * part;
      }
    }
    if constexpr (kSlides)
      return sums(total, slide[0], slide[1]);
    else
      return sum(total);
  };
  Along gain[kMaxSoftModes];
  Double4 moved[3];
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: 3 soft
    gain[a] = along(a, moved);
    for (int k = 0; k < 3; ++k) corner[k][a] = moved[k];
  }
  std::int32_t pair = 0;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: 3 pairs
    for (std::int32_t b = a; b < soft; ++b, ++pair) {
      const Along h = along(soft + pair, moved);
      gain[a] += h * y[b];
      gain[b] += h * y[a];
      row.turn[pair] = a == b ? 2 * first_of(h) : first_of(h);
      for (int k = 0; k < 3; ++k) {
        corner[k][a] += splat4(y[b]) * moved[k];
        corner[k][b] += splat4(y[a]) * moved[k];
      }
    }
  }
  const Real* w = row.foot.weight;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: 3 soft
    const Double4 sweep = splat4(w[0]) * corner[0][a] + splat4(w[1]) * corner[1][a] + splat4(w[2]) * corner[2][a];
    row.sweep_w[a] = {sweep[0], sweep[1], sweep[2]};
    if constexpr (kSlides) {
      Double4 slide[2] = {};
      for (int k = 0; k < 3; ++k)
        for (int s = 0; s < 2; ++s) slide[s] += load4(slopes.slide[s].of[k]) * corner[k][a];
      gain[a] += sums(Double4{}, slide[0], slide[1]);
      for (int s = 0; s < 2; ++s) row.slide[s][a] = gain[a][s + 1];
    }
    row.pull[a] = first_of(gain[a]);
  }
}

// How the normal displacement of each shape slopes along the surface as the centre moves.
template <class Count>
void show_slopes(Count soft, const ElasticRow& row, const Double4 (&corner)[3][kMaxSoftModes], Vec3* slope) PALPATE_RT {
  const Vec3 n = row.foot.normal_w;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: 3 soft
    slope[a] = {};
    for (int k = 0; k < 3; ++k) {
      const Double4& u = corner[k][a];
      slope[a] += (n.x * u[0] + n.y * u[1] + n.z * u[2]) * row.foot.gradient_per_m[k];
    }
  }
}

// What the foot's slide adds to the travel's second derivative. The travel is the tip's radius less the distance f from
// its centre to the nearest place s, whose derivatives in amplitudes and place are, at distance d over curvature k,
//   f_a = -n.u_a,   f_ab = t_a.t_b / d - n.u_ab,   f_as = t_a / d - g_a,   f_ss = 1 / d + k,
// with t_a the tangential part of u_a and g_a the slope of n.u_a along the surface, 1 + k d times its slope G_a as the
// centre moves; and f_ab - f_as f_sb / f_ss is that of the nearest. Without it H lacked F d g_a.g_b, by which a body is
// held upright under a ball: one of 60 mm on a block of 20 threw it from side to side every tick (2026-11-23).
struct RoundTurn {
  Real slopes, curvature;
  RoundTurn(Real d, Real k) PALPATE_RT {
    const Real bend = max_of(1 + k * d, 0.5);
    slopes = d * bend;
    curvature = bend > 1 ? k / bend : 0.0;
  }
  Real turn(Vec3 along_a, Vec3 slope_a, Vec3 along_b, Vec3 slope_b) const PALPATE_RT {
    return slopes * dot(slope_a, slope_b) - dot(along_a, slope_b) - dot(slope_a, along_b) -
           curvature * dot(along_a, along_b);
  }
};
template <class Count>
void turn_with_foot(Count soft, ElasticRow& row, const Double4 (&corner)[3][kMaxSoftModes]) PALPATE_RT {
  const Vec3 n = row.foot.normal_w;
  const RoundTurn round(max_of(row.foot.height_m, 0.0), row.curvature_1_per_m);
  Vec3 along[kMaxSoftModes], slope[kMaxSoftModes];
  show_slopes(soft, row, corner, slope);
  for (std::int32_t a = 0; a < soft; ++a) along[a] = tangential_part(row.sweep_w[a], n);  // bound: soft
  std::int32_t pair = 0;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: pairs
    for (std::int32_t b = a; b < soft; ++b, ++pair)
      row.turn[pair] += round.turn(along[a], slope[a], along[b], slope[b]);
  }
}

// How the material under a tip goes along the surface with each amplitude, and how the surface slopes there.
struct Turning {
  Vec3 along[kMaxSoftModes], slope[kMaxSoftModes];
};
template <class Count>
void show_turning(Count soft, const ElasticRow& row, const Double4 (&corner)[3][kMaxSoftModes],
                  Turning& turning) PALPATE_RT {
  show_slopes(soft, row, corner, turning.slope);
  for (std::int32_t a = 0; a < soft; ++a) turning.along[a] = tangential_part(row.sweep_w[a], row.foot.normal_w);
}

// Along an axis on which a tip goes to where its force acts the pull goes with it, by `step_m`, and what leans the
// surface, G_a + k t_a / (1 + k d), is resisted by `arm_m` (LineLaw::Lean, PlateAxis): a rod that touches with no end
// slides to where it is deepest, and t_a does nothing. With the pull where the last tick's force acted, jaws pressed
// 1 mm into a block set it swinging about its height (2026-11-26); without the arm a plate on a ball threw its top to
// and fro (2026-11-29). What both have along the axis is taken from them.
template <class Count>
void turn_along(Count soft, Vec3 axis, Real step_m, Real curvature_1_per_m, Real arm_m, Turning& turning,
                ElasticRow& row) PALPATE_RT {
  const Real d = max_of(row.foot.height_m, 0.0), bent = 1 + curvature_1_per_m * d, on_axis = curvature_1_per_m / bent;
  const Real by_slope = d * bent + arm_m, by_both = arm_m * on_axis - 1, by_way = on_axis * by_both;
  Real way[kMaxSoftModes], lean[kMaxSoftModes];
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: soft
    way[a] = dot(turning.along[a], axis);
    lean[a] = dot(turning.slope[a], axis);
    turning.along[a] -= way[a] * axis;
    turning.slope[a] -= lean[a] * axis;
    row.pull[a] += step_m * (lean[a] + on_axis * way[a]);
  }
  std::int32_t pair = 0;
  for (std::int32_t a = 0; a < soft; ++a)  // bound: pairs
    for (std::int32_t b = a; b < soft; ++b, ++pair)
      row.turn[pair] +=
          by_slope * lean[a] * lean[b] + by_both * (lean[a] * way[b] + way[a] * lean[b]) + by_way * way[a] * way[b];
}

// Across a capsule's axis as a ball.
template <class Count>
void turn_with_line(Count soft, Real step_m, ElasticRow& row, const Double4 (&corner)[3][kMaxSoftModes]) PALPATE_RT {
  const RoundTurn round(max_of(row.foot.height_m, 0.0), row.line.across_1_per_m);
  Turning turning;
  show_turning(soft, row, corner, turning);
  turn_along(soft, unit_or(tangential_part(row.tip.half_axis_w, row.foot.normal_w), {}), step_m, row.line.along_1_per_m,
             row.arm_m, turning, row);
  std::int32_t pair = 0;
  for (std::int32_t a = 0; a < soft; ++a)  // bound: pairs
    for (std::int32_t b = a; b < soft; ++b, ++pair)
      row.turn[pair] += round.turn(turning.along[a], turning.slope[a], turning.along[b], turning.slope[b]);
}
template <class Count>
void turn_with_plate(Count soft, const PlateAxis (&axes)[2], ElasticRow& row,
                     const Double4 (&corner)[3][kMaxSoftModes]) PALPATE_RT {
  const Vec3 n = row.foot.normal_w, first = unit_or(tangential_part(row.tip.half_axis_w, n), {}),
             second = cross(n, first), unit[2] = {first, dot(second, row.tip.half_across_w) < 0 ? -second : second};
  const Real d = clamp_to(row.foot.height_m, 0.0, row.tip.margin_m);
  Turning turning;
  show_turning(soft, row, corner, turning);
  for (int i = 0; i < 2; ++i)  // bound: 2 pairs
    turn_along(soft, unit[i], axes[i].step_m, axes[i].bend_1_per_m / (1 - axes[i].bend_1_per_m * d), axes[i].arm_m,
               turning, row);
}

// On an edge the nearest place slides along it alone, at an end not at all: f_ab = s_a.s_b / d - n.u_ab, s_a what u_a
// has across. Where it is, w = (centre - V) . along / along^2, changes as the edge turns, too.
template <class Count>
void turn_on_edge(Count soft, const EdgePlace& on, const Double4 (&corner)[3][kMaxSoftModes],
                  ElasticRow& row) PALPATE_RT {
  const Vec3 n = row.foot.normal_w;
  const Real square = squared_norm(on.along_w), bend = 1.0 / row.foot.height_m, inverse = square > 0 ? 1 / square : 0.0;
  const int next = (on.edge + 1) % 3;
  Vec3 across[kMaxSoftModes];
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: soft
    const Real along = inverse * dot(row.sweep_w[a], on.along_w);
    across[a] = tangential_part(row.sweep_w[a], n) - along * on.along_w;
    const Double4 turned = corner[next][a] - corner[on.edge][a];
    const Real slid = along - inverse * row.foot.height_m * (n.x * turned[0] + n.y * turned[1] + n.z * turned[2]);
    for (int s = 0; s < 2; ++s) row.slide[s][a] = s + 1 == next ? slid : s + 1 == on.edge ? -slid : 0.0;  // bound: 2
  }
  std::int32_t pair = 0;
  for (std::int32_t a = 0; a < soft; ++a)  // bound: pairs
    for (std::int32_t b = a; b < soft; ++b, ++pair) row.turn[pair] -= bend * dot(across[a], across[b]);
}

// How the height bends along unit vectors a and b, at height t above a surface of curvature k by k / (1 + k t) along
// one of its own directions.
Real height_bend(const foot::Corners& corners, const ElasticRow& row, Vec3 a, Vec3 b) PALPATE_RT {
  const Vec3 n = row.foot.normal_w;
  Vec3 mixed;
  for (int k = 0; k < 3; ++k) mixed += row.foot.weight[k] * corners.u[k];  // bound: 3
  Real turned = 0;
  for (int k = 0; k < 3; ++k)  // bound: 3
    turned += dot(row.foot.gradient_per_m[k], a) * (dot(corners.u[k], b) - dot(corners.u[k], n) * dot(n, b));
  return turned / norm(mixed);
}
// Along one, and none below zero.
Real height_bend(const foot::Corners& corners, const ElasticRow& row, Vec3 axis) PALPATE_RT {
  const Vec3 unit = unit_or(axis, {});
  return max_of(height_bend(corners, row, unit, unit), 0.0);
}

// The same over a sharp edge or its end, which a line that crosses it turns about. Without it the line was to go on
// along what it leans by, as if there were no end to that (2026-11-29).
Real edge_bend(const EdgePlace& on, const ElasticRow& row) PALPATE_RT {
  const Vec3 axis = unit_or(row.tip.half_axis_w, {}), across = tangential_part(axis, unit_or(on.along_w, {}));
  const Real lean = dot(axis, row.foot.normal_w);
  return max_of(squared_norm(across) - lean * lean, 0.0) / row.foot.height_m;
}

// n . x of each linear mode, x its shape blended of the foot's triangle, in lanes of four.
void blend_linear_modes(const Model& model, const ElasticRow& row, const Real (&w)[3], Real* along) PALPATE_RT {
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(row.foot.triangle)];
  const Vec3 n = row.foot.normal_w;
  const std::int32_t count = model.params.elastic_linear;
  const float* shape[3];
  for (int k = 0; k < 3; ++k) shape[k] = linear_shapes(model, triangle.vertex[k]);  // bound: 3
  const auto blend = [&](std::int32_t i) PALPATE_RT {
    return splat4(w[0]) * widen4(shape[0] + i) + splat4(w[1]) * widen4(shape[1] + i) +
           splat4(w[2]) * widen4(shape[2] + i);
  };
  std::int32_t m = 0;
  for (; m + 4 <= count; m += 4) {  // bound: kMaxLinearModes / 4, and 3
    Vec3 four[4];
    for (int i = 0; i < 3; ++i) store(&four[0].x + 4 * i, blend(3 * m + 4 * i));
    store(along + m, dot(load4(four), splat4(n)));
  }
  for (; m < count; ++m) {
    const auto at = [&](std::int32_t i) PALPATE_RT {
      const std::int32_t of = 3 * m + i;
      return w[0] * static_cast<Real>(shape[0][of]) + w[1] * static_cast<Real>(shape[1][of]) +
             w[2] * static_cast<Real>(shape[2][of]);
    };
    along[m] = at(0) * n.x + at(1) * n.y + at(2) * n.z;
  }
  for (; m < whole_lanes(count, 4); ++m) along[m] = 0;
}

// How much sooner than where it stands a capsule that leans may touch: the axis's own lean lowers its line towards the
// surface's tangent (line_law.h), and a solid's edge or plate may come down on its end.
Real lead_of(const RoundTip& tip, Vec3 normal_w) PALPATE_RT {
  if (tip.is_of_solid()) {
    const Real along = dot(normal_w, tip.half_axis_w), across = dot(normal_w, tip.half_across_w);
    return abs_of(along) + along * tip.along + abs_of(across) + across * tip.across;
  }
  if (!tip.is_of_part()) return 0;
  const Real lean = dot(normal_w, unit_or(tip.half_axis_w, {}));
  return 0.5 * tip.margin_m * lean * lean;
}

}  // namespace

Vec3 CarriedSurface::displacement(std::int32_t vertex) const PALPATE_RT {
  const Vec3 rest = model.vertex_m[static_cast<std::size_t>(vertex)];
  return carry(model, y, vertex).position_w - rest;
}

void CarriedSurface::place(const RoundTip& tip, std::int32_t triangle, Vec3 near_w, Real nearer_m, const Box& box,
                           ElasticRow& row, Real force_N) const PALPATE_RT {
  CarriedTriangle last{model, y, work, -1, {}, {}};
  row.tip = tip;
  row.has_along = false;
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
  if (!found && on.edge < 0 && tip.is_of_part()) {
    row.foot = {};
    row.foot.state = FootState::kFar;
    row.foot.triangle = last.triangle;
    return;
  }
  if (!found && on.edge < 0 && !place_on_facet(centre_w, triangle, row)) return;
  const FacetSag sag = found ? smooth_sag(model, last, row.foot) : FacetSag{};
  row.travel_m = on.is_behind ? -kHuge : tip.margin_m - row.foot.height_m;
  row.leads_m = found || tip.is_of_solid() ? lead_of(tip, row.foot.normal_w) : 0.0;
  if (!(row.travel_m + row.leads_m + nearer_m > 0) || tip.stands_on_end(row.foot.normal_w)) return;
  row.has_slide = tip.is_ball() && !tip.is_of_part() && force_N > 0 && (found || on.edge >= 0);
  FootSlopes slopes;
  Real step_m = 0;
  PlateAxis plate[2];
  if (found) {
    const Vec3* n = model.corner_normal[static_cast<std::size_t>(row.foot.triangle)].normal;
    const Real* inverse = last.normal_inverse;
    const CornerTurns turns = {
        {last.vertex[0], n[0], inverse[0]}, {last.vertex[1], n[1], inverse[1]}, {last.vertex[2], n[2], inverse[2]}};
    const Real below = travel_slope(turns, sag, row, last, slopes.travel);
    show_place_numbers(model, row);
    if (tip.is_line())
      step_m = stand_on_line(model, box, height_bend(last.corners, row, tip.half_axis_w), force_N, row);
    if (tip.is_plate()) {
      const Vec3 along = unit_or(tip.half_axis_w, {}), across = unit_or(tip.half_across_w, {});
      const PlateBends bends{
          height_bend(last.corners, row, along), height_bend(last.corners, row, across),
          0.5 * (height_bend(last.corners, row, along, across) + height_bend(last.corners, row, across, along))};
      stand_on_plate(model, box, bends, force_N, row, plate);
    }
    if (row.has_slide) slide_slopes(turns, row, last, below, slopes.slide);
  } else {
    show_place_numbers(model, row);
    row.rise = row.foot.normal_w;
    slopes.travel = facet_slope(row);
    const bool turns = on.edge >= 0 && row.foot.height_m > 0;
    if (tip.is_line()) stand_on_line(model, box, turns ? edge_bend(on, row) : 0.0, force_N, row);
  }
  with_mode_count(model.params.elastic_soft, [&](auto n) PALPATE_RT {
    Double4 corner[3][kMaxSoftModes];
    if (found && row.has_slide)
      show_modes<true>(model, n, y, slopes, row, corner);
    else
      show_modes<false>(model, n, y, slopes, row, corner);
    if (on.edge >= 0) turn_on_edge(n, on, corner, row);
    if (!found) return;
    if (tip.is_line())
      turn_with_line(n, step_m, row, corner);
    else if (tip.is_plate())
      turn_with_plate(n, plate, row, corner);
    else
      turn_with_foot(n, row, corner);
  });
  work->placed += 1;
  work->shapes += (row.has_slide ? kMostOfShapes : kMostOfShapes - 1) * terms(model.params.elastic_soft);
  work->lines += tip.is_ball() ? 0 : 1;
}

bool CarriedSurface::place_on_facet(Vec3 centre_w, std::int32_t triangle, ElasticRow& row) const PALPATE_RT {
  row.foot = {};
  if (*looked > kMostBefore) return false;
  const Vec3 moved = displacement(model.triangle[static_cast<std::size_t>(triangle)].vertex[0]);
  const SurfacePoint facet = closest_surface_point(model, centre_w - moved, kHuge, triangle, kMaxTipSearched);
  *looked += facet.looked;
  work->shown += terms(model.params.elastic_soft);
  if (!facet.found) return false;
  row.foot.triangle = facet.triangle;
  facet_weights(model, facet.triangle, facet.closest_w, row.foot.weight);
  row.foot.normal_w = facet.normal_w;
  row.foot.foot_w = facet.closest_w + moved;
  row.foot.height_m = facet.signed_distance_m;
  return true;
}

void show_linear_modes(const Model& model, ElasticRow& row) PALPATE_RT {
  if (row.has_along) return;
  row.has_along = true;
  blend_linear_modes(model, row, row.foot.weight, row.along);
}

}  // namespace palpate
