#include "rt_core/surface/four_queries.h"

#include "rt_core/lanes.h"
#include "rt_core/surface/candidate.h"
#include "rt_core/surface/plane_proof.h"
#include "rt_core/surface/ring_proof.h"

namespace palpate {

namespace {

using std::int32_t;
using std::uint32_t;

Double4 smaller(const Double4& a, const Double4& b) PALPATE_RT { return a < b ? a : b; }

struct FourTriangles {
  const Triangle* of[4];
  Vec3x4 a, b, c;
};

void find_triangles(const Model& model, const int32_t (&index)[4], FourTriangles& t) PALPATE_RT {
  Vec3x4* const corner[3] = {&t.a, &t.b, &t.c};
  for (int k = 0; k < 4; ++k) t.of[k] = &model.triangle[static_cast<std::size_t>(index[k])];  // bound: 4
  for (int i = 0; i < 3; ++i) {                                                               // bound: 3
    const auto v = [&](int k) PALPATE_RT { return model.vertex_m[static_cast<std::size_t>(t.of[k]->vertex[i])]; };
    *corner[i] = side_by_side(v(0), v(1), v(2), v(3));
  }
}

// closest_on_triangle() of four, where it is in a face or on an edge.
struct FourPlaces {
  Vec3x4 point;
  Double4 distance2, inset;
  uint32_t face, edge[3];  // bits
};

// Which of the features in the order of closest_on_triangle(), and what its point is made of.
void find_places(const FourTriangles& t, const Vec3x4& p, FourPlaces& places) PALPATE_RT {
  const Double4 zero{};
  const Vec3x4 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a, bp = p - t.b, cp = p - t.c;
  const Double4 d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp);
  const Double4 d6 = dot(ac, cp), vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  const Double4 along = d4 - d3, back = d5 - d6, area = va + vb + vc;
  const Mask4 at_a = (d1 <= zero) & (d2 <= zero), at_b = (d3 >= zero) & (d4 <= d3), at_c = (d6 >= zero) & (d5 <= d6);
  const Mask4 on_ab = (vc <= zero) & (d1 >= zero) & (d3 <= zero) & (d1 - d3 > zero) & ~(at_a | at_b);
  const Mask4 on_ac = (vb <= zero) & (d2 >= zero) & (d6 <= zero) & (d2 - d6 > zero) & ~(at_a | at_b | on_ab | at_c);
  const Mask4 before_bc = at_a | at_b | at_c | on_ab | on_ac;
  const Mask4 on_bc = (va <= zero) & (along >= zero) & (back >= zero) & (along + back > zero) & ~before_bc;
  const Mask4 in_face = (area > zero) & ~(before_bc | on_bc);

  const Double4 over = where(on_ab, d1, where(on_ac, d2, where(on_bc, along, splat4(1.0))));
  const Double4 under = where(on_ab, d1 - d3, where(on_ac, d2 - d6, where(on_bc, along + back, area)));
  const Double4 share = over / under;  // along the edge; of the face the scale of its weights
  const Vec3x4 base = where(on_bc, t.b, t.a), aim = where(on_ac, ac, where(on_bc, t.c - t.b, ab));
  const Vec3x4 first = base + where(in_face, vb * share, share) * aim;
  places.point = where(in_face, first + (vc * share) * ac, first);
  places.inset = where(in_face, share * smaller(smaller(va, vb), vc), smaller(share, splat4(1.0) - share));
  const Vec3x4 off = p - places.point;
  places.distance2 = dot(off, off);
  places.face = bits_of(in_face);
  places.edge[0] = bits_of(on_ab);
  places.edge[1] = bits_of(on_bc);
  places.edge[2] = bits_of(on_ac);
}

// Which are nearest by certificate() if they are within their feature by kSafeInset: outside a convex part, nothing
// else near. What an edge's other triangle tells is left.
uint32_t are_certified(const FourTriangles& t, const Vec3x4& p, const FourPlaces& places) PALPATE_RT {
  const auto clear = [&](int k) PALPATE_RT { return static_cast<double>(t.of[k]->clear_radius_m); };
  const auto scale = [&](int k) PALPATE_RT { return static_cast<double>(t.of[k]->clear_scale_per_m); };
  const Double4 distance = square_root(places.distance2);
  const Double4 spare = Double4{clear(0), clear(1), clear(2), clear(3)} - distance;
  const Vec3x4 normal = cross(t.b - t.a, t.c - t.a);
  const Vec3x4 middle =
      splat4(1.0 / 3.0) * (t.a + t.b + t.c) + Double4{scale(0), scale(1), scale(2), scale(3)} * normal;
  const Vec3x4 off = p - middle;
  const Mask4 near = (spare > Double4{}) & (dot(off, off) < splat4(1 - 1e-9) * (spare * spare));
  const Mask4 outside = (distance > splat4(kDirectionFloor_m)) & (dot(p - places.point, normal) > Double4{});
  uint32_t convex = 0;
  for (uint32_t k = 0; k < 4; ++k) convex |= t.of[k]->ring_convex >= 1 ? 1u << k : 0u;  // bound: 4
  return convex & bits_of(near & outside);
}
uint32_t are_inset(const FourPlaces& places) PALPATE_RT { return bits_of(places.inset > splat4(kSafeInset)); }

// What rounding can do to their squared distances: distance2_rounding().
Double4 roundings(const FourPlaces& places) PALPATE_RT {
  const Double4 distance = square_root(places.distance2);
  return splat4(1e-14) * distance * (square_root(dot(places.point, places.point)) + distance);
}

Mask4 mask_of(uint32_t bits) PALPATE_RT {
  const auto lane = [bits](uint32_t k) PALPATE_RT { return -static_cast<std::int64_t>(bits >> k & 1); };
  return Mask4{lane(0), lane(1), lane(2), lane(3)};
}

// Triangles of four queries and where the nearest places are on them.
struct FourSides {
  int32_t triangle[4];
  FourTriangles of;
  FourPlaces at;
};

int edge_of(const FourPlaces& places, uint32_t k) PALPATE_RT {
  return (places.edge[0] >> k & 1) != 0 ? 0 : (places.edge[1] >> k & 1) != 0 ? 1 : 2;
}

// The triangle across its edge from each of `on_edge`. Returns those that have one.
uint32_t across_edges(const FourSides& here, uint32_t on_edge, int32_t (&triangle)[4]) PALPATE_RT {
  uint32_t closed = 0;
  for (; on_edge != 0; on_edge &= on_edge - 1) {  // bound: 4
    const auto k = static_cast<uint32_t>(__builtin_ctz(on_edge));
    const int32_t across = here.of.of[k]->adjacent[edge_of(here.at, k)];
    if (across < 0) continue;
    triangle[k] = across;
    closed |= 1u << k;
  }
  return closed;
}

bool is_of_fan(const Triangle& t, int edge) PALPATE_RT {
  return ring_proof::is_by_planes(t) &&
         (ring_proof::is_flat_about(t, edge) || ring_proof::is_flat_about(t, edge == 2 ? 0 : edge + 1));
}

// Of `nearer`, over the face of the triangle across their edge and nearer there, those that walk() leaves there:
// certified, and within rounding of no border, or of none but where they came over, which it then measures `again`. It
// goes on over the spokes of a fan.
uint32_t settle_beyond(const Model& model, const Vec3x4& p, uint32_t nearer, const FourSides& here,
                       const FourSides& beyond, uint32_t& again) PALPATE_RT {
  nearer &= are_certified(beyond.of, p, beyond.at);
  const uint32_t inset = are_inset(beyond.at);
  uint32_t settled = 0;
  for (; nearer != 0; nearer &= nearer - 1) {  // bound: 4
    const auto k = static_cast<uint32_t>(__builtin_ctz(nearer));
    if (is_of_fan(*here.of.of[k], edge_of(here.at, k))) continue;
    if ((inset >> k & 1) == 0) {
      const Triangle& t = *beyond.of.of[k];
      if (!ring_proof::is_by_planes(t)) continue;
      const Border border = border_in_face({model.triangle.data(), model.vertex_m.data()}, t, beyond.at.point[k]);
      if (border.edge < 0 || t.adjacent[border.edge] != here.triangle[k]) continue;
      again |= 1u << k;
    }
    settled |= 1u << k;
  }
  return settled;
}

// Of `on_edge`, whose nearest place is on an edge, the nearest of both triangles there, as measure_sharers() and
// settle_by_planes() choose it. Returns those for which it is the same place but for rounding, or over the other's
// face.
uint32_t settle_edges(const Model& model, const Vec3x4& p, uint32_t on_edge, FourSides& here,
                      uint32_t& again) PALPATE_RT {
  FourSides beyond;
  for (int k = 0; k < 4; ++k) beyond.triangle[k] = here.triangle[k];  // bound: 4
  on_edge &= across_edges(here, on_edge, beyond.triangle);
  find_triangles(model, beyond.triangle, beyond.of);
  find_places(beyond.of, p, beyond.at);
  uint32_t lower = 0;
  for (uint32_t k = 0; k < 4; ++k) lower |= beyond.triangle[k] < here.triangle[k] ? 1u << k : 0u;  // bound: 4
  const uint32_t known = beyond.at.face | beyond.at.edge[0] | beyond.at.edge[1] | beyond.at.edge[2];
  const uint32_t nearer = on_edge & bits_of(beyond.at.distance2 < here.at.distance2 - roundings(here.at));
  uint32_t settled = on_edge & known & ~nearer;
  if ((nearer & beyond.at.face) != 0) settled |= settle_beyond(model, p, nearer & beyond.at.face, here, beyond, again);
  const uint32_t as_near = bits_of(beyond.at.distance2 == here.at.distance2);
  const uint32_t other = settled & (bits_of(beyond.at.distance2 < here.at.distance2) | (as_near & lower));
  for (uint32_t k = 0; k < 4; ++k)  // bound: 4
    here.triangle[k] = (other >> k & 1) != 0 ? beyond.triangle[k] : here.triangle[k];
  const Mask4 mask = mask_of(other);
  here.at.point = where(mask, beyond.at.point, here.at.point);
  here.at.distance2 = where(mask, beyond.at.distance2, here.at.distance2);
  for (int i = 0; i < 3; ++i)  // bound: 3
    here.at.edge[i] = (here.at.edge[i] & ~other) | (beyond.at.edge[i] & other);
  return settled;
}

}  // namespace

FourSettled settle_four(const Model& model, const FourQueries& query, int32_t count) PALPATE_RT {
  const auto triangles = static_cast<int32_t>(model.triangle.size());
  FourSettled four;
  FourSides here;
  four.settled = (1u << count) - 1;
  for (uint32_t k = 0; k < 4; ++k) {  // bound: 4
    const int32_t warm = query.warm_triangle[k];
    const bool usable = warm >= 0 && warm < triangles;
    here.triangle[k] = usable ? warm : 0;
    if (!usable) four.settled &= ~(1u << k);
  }
  if (four.settled == 0) return four;
  const Vec3x4 p = load4(query.p);  // a NaN is over no feature
  find_triangles(model, here.triangle, here.of);
  find_places(here.of, p, here.at);
  four.on_edge = here.at.edge[0] | here.at.edge[1] | here.at.edge[2];
  four.settled &= are_certified(here.of, p, here.at) & are_inset(here.at) & (here.at.face | four.on_edge);
  const uint32_t on_edge = four.settled & four.on_edge;
  if (on_edge != 0) four.settled &= ~on_edge | settle_edges(model, p, on_edge, here, four.again);
  for (int i = 0; i < 3; ++i) four.edge[i] = here.at.edge[i];       // bound: 3
  for (int k = 0; k < 4; ++k) four.triangle[k] = here.triangle[k];  // bound: 4
  // Outside the body, as report() tells it.
  four.distance_m = square_root(here.at.distance2);
  four.closest_w = here.at.point;
  four.normal_w = (splat4(1.0) / four.distance_m) * (p - here.at.point);
  return four;
}

}  // namespace palpate
