#include "rt_core/contact/elastic/carried_edge.h"

#include "rt_core/contact/elastic/part_search.h"
#include "rt_core/surface/ring.h"

namespace palpate {

namespace {

// The last Newton step to a foot: its square over a radius of a centimetre is beyond rounding.
constexpr Real kStillCarried_m = 1e-9;

// Facets that a foot crosses in a tick, at most: what follows a tip at 4 m/s over edges of a millimetre.
constexpr std::int32_t kMostCrossed = 5;
// Ends of edges that a foot passes.
constexpr std::int32_t kMostEnds = 2;
// Triangles looked at about such an end.
constexpr std::int32_t kMostRound = 8;
// Of a capsule and an edge the square of the angle between them, at least: more parallel ones come along by parts.
constexpr Real kLeastAcross = 0.01;
// One that lies along the edge, within 13 degrees, presses as a line along it, and is where it is nearest from 18 on: a
// jaw beside the edge that it was parallel to went to and fro along it by 3 mm (2026-11-29).
constexpr Real kAlong = 0.05;
// A part's corner normals are longer than one by 2e-12 and more, squared.
constexpr Real kPartLonger = 5e-13;
// Normals on both sides of a seam between two parts: its square.
constexpr Real kSame = 1e-18;

const Triangle& triangle_of(const CarriedTriangle& t) PALPATE_RT {
  return t.model.triangle[static_cast<std::size_t>(t.triangle)];
}

EdgePlace nearest_edge(const CarriedTriangle& t, Vec3 centre_w) PALPATE_RT {
  EdgePlace best;
  for (int k = 0; k < 3; ++k) {  // bound: 3
    if (foot::across(t.model, t.triangle, k) >= 0) continue;
    const Vec3 begin = t.corners.v[k], edge = t.corners.v[(k + 1) % 3] - begin;
    const Real share = clamp_to(dot(centre_w - begin, edge) / squared_norm(edge), 0.0, 1.0);
    const Vec3 place = begin + share * edge;
    const Real square = squared_norm(centre_w - place);
    if (square < best.square_m2) best = {k, share, place, share > 0 && share < 1 ? edge : Vec3{}, square};
  }
  return best;
}

// Round an edge's end to the triangle in which a sharp edge goes on; -1: none of the first few has one.
std::int32_t round_end(const Model& model, std::int32_t triangle, int edge, std::int32_t vertex) PALPATE_RT {
  for (std::int32_t i = 0; i < kMostRound; ++i) {  // bound: kMostRound x 3
    const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
    int other = -1;
    for (int k = 0; k < 3; ++k)
      if (k != edge && (t.vertex[k] == vertex || t.vertex[(k + 1) % 3] == vertex)) other = k;
    const std::int32_t next = other < 0 ? -1 : foot::across(model, triangle, other);
    if (next < 0) return other < 0 || i == 0 ? -1 : triangle;
    const Triangle& n = model.triangle[static_cast<std::size_t>(next)];
    edge = n.adjacent[0] == triangle ? 0 : n.adjacent[1] == triangle ? 1 : 2;
    triangle = next;
  }
  return -1;
}

// On along the edges while that comes nearer.
EdgePlace follow_edge(Vec3 centre_w, CarriedTriangle& last) PALPATE_RT {
  EdgePlace on = nearest_edge(last, centre_w);
  for (std::int32_t i = 0; i < kMostEnds; ++i) {  // bound: kMostEnds
    if (on.edge < 0 || squared_norm(on.along_w) > 0) break;
    const int end = on.share > 0 ? (on.edge + 1) % 3 : on.edge;
    const std::int32_t before = last.triangle;
    const std::int32_t next = round_end(last.model, before, on.edge, triangle_of(last).vertex[end]);
    if (next < 0) break;
    last.move_to(next);
    const EdgePlace further = nearest_edge(last, centre_w);
    if (!(further.edge >= 0 && further.square_m2 < on.square_m2)) {
      last.move_to(before);
      break;
    }
    on = further;
  }
  return on;
}

// Corner of `beside` that is not on the edge.
Vec3 beyond_edge(const CarriedTriangle& last, const Triangle& beside, int edge) PALPATE_RT {
  const Triangle& here = triangle_of(last);
  std::int32_t apex = beside.vertex[0];
  for (const std::int32_t v : beside.vertex)  // bound: 3
    if (v != here.vertex[edge] && v != here.vertex[(edge + 1) % 3]) apex = v;
  last.work->shown += elastic_layout::terms(last.model.params.elastic_soft);
  return carry(last.model, last.y, apex).position_w;
}

void stand_on(const EdgePlace& on, Vec3 centre_w, const CarriedTriangle& last, SmoothFoot& foot) PALPATE_RT {
  const int next = (on.edge + 1) % 3;
  foot = {};
  foot.state = FootState::kEdge;
  foot.triangle = last.triangle;
  foot.weight[on.edge] = 1 - on.share;
  foot.weight[next] = on.share;
  const Real square = squared_norm(on.along_w);
  if (square > 0) {
    foot.gradient_per_m[next] = (1.0 / square) * on.along_w;
    foot.gradient_per_m[on.edge] = -foot.gradient_per_m[next];
  }
  foot.height_m = square_root(on.square_m2);
  foot.normal_w = (1.0 / foot.height_m) * (centre_w - on.place_w);
  foot.foot_w = on.place_w;
}

// Whether another part goes on there, whose place it is then: of its corners about one end of the edge, or about both
// where the place is between them.
bool meets_part(const Model& model, std::int32_t triangle, std::int32_t vertex) PALPATE_RT {
  std::int32_t at = triangle;
  Vec3 own;
  for (std::int32_t i = 0; i < kMostRound && at >= 0; ++i) {  // bound: kMostRound x 3
    const Triangle& t = model.triangle[static_cast<std::size_t>(at)];
    const int corner = corner_at(t, vertex);
    const Vec3 normal = model.corner_normal[static_cast<std::size_t>(at)].normal[corner];
    if (i == 0) own = normal;
    if (!(normal == own) && squared_norm(normal - own) < kSame) return true;
    at = t.adjacent[corner];
    if (at == triangle) break;
  }
  return false;
}
bool goes_on_smooth(const Model& model, std::int32_t triangle, const EdgePlace& on) PALPATE_RT {
  const std::int32_t* v = model.triangle[static_cast<std::size_t>(triangle)].vertex;
  return (on.share == 1 || meets_part(model, triangle, v[on.edge])) &&
         (on.share == 0 || meets_part(model, triangle, v[(on.edge + 1) % 3]));
}

// Of a part the corner normals' last bits are more than one (config/bake/surface_parts.cpp).
bool is_part(const Model& model, std::int32_t triangle) PALPATE_RT {
  return squared_norm(model.corner_normal[static_cast<std::size_t>(triangle)].normal[0]) > 1 + kPartLonger;
}

// A capsule to where its axis is nearest to the edge: foot by foot it would take a dozen ticks where both are about
// parallel, and a tube across a clip's arm was 0.5 mm deep until then (2026-11-26).
EdgePlace come_along(const EdgePlace& on, CarriedTriangle& last, ElasticRow& row) PALPATE_RT {
  RoundTip& tip = row.tip;
  const Real square = squared_norm(on.along_w);
  if (!tip.is_line() || !(square > 0)) return on;
  const Vec3 axis = unit_or(tip.half_axis_w, {}), edge = (1.0 / square) * on.along_w;
  const Real across = max_of(1 - dot(axis, edge) * dot(axis, on.along_w), kLeastAcross);
  const Real crosses = tip.is_of_part() ? 1.0 : clamp_to((across - kAlong) / kAlong, 0.0, 1.0);
  const Real half = norm(tip.half_axis_w), step = crosses * dot(on.place_w - row.placed_w, axis) / across;
  tip.along = clamp_to(tip.along + step / half, -1.0, 1.0);
  row.placed_w = tip.centre_w();
  return follow_edge(row.placed_w, last);
}

}  // namespace

void find_carried_foot(Vec3 centre_w, Vec3 near_w, CarriedTriangle& last, ElasticRow& row) PALPATE_RT {
  std::int32_t steps = 0, passed = 0;
  row.foot = foot::search<true>(
      last.model,
      [&last](std::int32_t t) PALPATE_RT {
        last.move_to(t);
        last.turn_normals();
        return last.corners;
      },
      [&last](int corner, Vec3 off) PALPATE_RT { return last.vertex[corner].at_rest(off); }, centre_w, last.triangle,
      near_w, kStillCarried_m, kMostCrossed, &steps, &passed);
  last.work->foot_steps += steps + passed / foot::kSpokesPerStep;
}

EdgePlace place_on_edge(Vec3 centre_w, CarriedTriangle& last, ElasticRow& row) PALPATE_RT {
  const EdgePlace on = follow_edge(centre_w, last);
  if (on.edge < 0 || !(on.square_m2 > kStillCarried_m * kStillCarried_m)) return {};
  const std::int32_t here = last.triangle, other = triangle_of(last).adjacent[on.edge];
  if (other < 0) return {};
  const Vec3* v = last.corners.v;
  const Vec3 edge = v[(on.edge + 1) % 3] - v[on.edge], out = centre_w - on.place_w;
  const Vec3 over = beyond_edge(last, last.model.triangle[static_cast<std::size_t>(other)], on.edge) - v[on.edge];
  const Vec3 up = cross(v[1] - v[0], v[2] - v[0]);
  if (row.tip.is_of_part()) {
    const bool is_above =
        looks_to(out, up) > max_of(kGrazing, is_part(last.model, other) ? looks_to(out, cross(over, edge)) : 0.0);
    EdgePlace nearest = is_above ? come_along(on, last, row) : on;
    nearest.is_behind = !is_above || goes_on_smooth(last.model, last.triangle, nearest);
    stand_on(nearest, row.placed_w, last, row.foot);
    return nearest;
  }
  const bool is_hollow = !(dot(over, up) < 0), is_inside = !(dot(out, up) > 0 || dot(out, cross(over, edge)) > 0);
  if (is_hollow || is_inside) return {};
  if (dot(out, over - (dot(over, edge) / squared_norm(edge)) * edge) > 0) {
    last.move_to(other);
    find_carried_foot(centre_w, on.place_w, last, row);
    if (row.foot.state == FootState::kFound) return {};
    last.move_to(here);
  }
  const EdgePlace nearest = come_along(on, last, row);
  stand_on(nearest, row.placed_w, last, row.foot);
  return nearest;
}

}  // namespace palpate
