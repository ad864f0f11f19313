// One triangle of an elastic body's surface as its soft modes carry it.
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"
#include "rt_core/contact/elastic/mode_count.h"
#include "rt_core/surface/foot_search.h"

namespace palpate {

struct CarriedVertex {
  Vec3 position_w;
  Vec3 row[3];  // of the deformation gradient

  // The surface normal carried along, not unit: cofactor times normal.
  Vec3 carried(Vec3 normal) const PALPATE_RT {
    return {dot(cross(row[1], row[2]), normal), dot(cross(row[2], row[0]), normal), dot(cross(row[0], row[1]), normal)};
  }
  // A direction on the body at rest that is carried along to `off`; not to scale.
  Vec3 at_rest(Vec3 off) const PALPATE_RT {
    return off.x * cross(row[1], row[2]) + off.y * cross(row[2], row[0]) + off.z * cross(row[0], row[1]);
  }
};

template <class Count>
CarriedVertex carry(const Model& model, Count soft, const Real* y, std::int32_t vertex) PALPATE_RT {
  const float* block = elastic_layout::vertex_block(model, vertex);
  const std::int32_t count = elastic_layout::terms(soft);
  Double4 a{}, b{}, c{};
  for (std::int32_t t = 0; t < count; ++t) {  // bound: elastic_layout::terms
    const Double4 factor = splat4(y[t]);
    a += factor * widen4(block + elastic_layout::kTermFloats * t);
    b += factor * widen4(block + elastic_layout::kTermFloats * t + 4);
    c += factor * widen4(block + elastic_layout::kTermFloats * t + 8);
  }
  CarriedVertex out;
  out.position_w = model.vertex_m[static_cast<std::size_t>(vertex)] + Vec3{a[0], a[1], a[2]};
  out.row[0] = {1 + a[3], b[0], b[1]};
  out.row[1] = {b[2], 1 + b[3], c[0]};
  out.row[2] = {c[1], c[2], 1 + c[3]};
  return out;
}

inline CarriedVertex carry(const Model& model, const Real* y, std::int32_t vertex) PALPATE_RT {
  CarriedVertex out;
  with_mode_count(model.params.elastic_soft, [&](auto n) PALPATE_RT { out = carry(model, n, y, vertex); });
  return out;
}

// A triangle with its corners carried along; a neighbour takes over the two corners they share.
struct CarriedTriangle {
  const Model& model;
  const Real* y;
  Work* work;
  std::int32_t triangle = -1;
  CarriedVertex vertex[3];
  foot::Corners corners;
  Real normal_inverse[3] = {};  // of the carried normals' lengths, after turn_normals()

  void move_to(std::int32_t next) PALPATE_RT {
    if (next == triangle) return;
    with_mode_count(model.params.elastic_soft, [&](auto soft) PALPATE_RT { carry_on(soft, next); });
    triangle = next;
  }
  template <class Count>
  void carry_on(Count soft, std::int32_t next) PALPATE_RT {
    const Triangle& t = model.triangle[static_cast<std::size_t>(next)];
    const Triangle* from = triangle < 0 ? nullptr : &model.triangle[static_cast<std::size_t>(triangle)];
    CarriedVertex old[3];
    for (int k = 0; from != nullptr && k < 3; ++k) old[k] = vertex[k];  // bound: 3
    for (int k = 0; k < 3; ++k) {                                       // bound: 3 x 3
      const CarriedVertex* known = nullptr;
      for (int i = 0; from != nullptr && i < 3; ++i)
        if (from->vertex[i] == t.vertex[k]) known = old + i;
      vertex[k] = known != nullptr ? *known : carry(model, soft, y, t.vertex[k]);
      work->shown += known != nullptr ? 0 : elastic_layout::terms(soft);
      corners.v[k] = vertex[k].position_w;
    }
  }
  void turn_normals() PALPATE_RT {
    for (int k = 0; k < 3; ++k) {  // bound: 3
      const Vec3 normal = model.corner_normal[static_cast<std::size_t>(triangle)].normal[k];
      const Vec3 carried = vertex[k].carried(normal);
      const Real length = norm(carried);
      normal_inverse[k] = length > 1e-300 && length < kHuge ? 1.0 / length : 0.0;
      corners.u[k] = normal_inverse[k] > 0 ? normal_inverse[k] * carried : normal;
    }
  }
  // Over the facets to the one that the centre is above, as flat ones tell: a triangle so left behind costs a fifth of
  // one left by Newton's steps. Above a convex edge the facets on both sides send it across.
  void walk_below(Vec3 centre_w) PALPATE_RT {
    std::int32_t left = -1;
    for (std::int32_t i = 0; i < kFootWalk; ++i) {  // bound: kFootWalk
      const foot::Place at = foot::place_on(corners, centre_w, 0.0);
      const int edge = foot::is_at_flat_vertex(model.triangle[static_cast<std::size_t>(triangle)], at)
                           ? -1
                           : foot::edge_to_cross(at);
      const std::int32_t next = edge < 0 ? -1 : foot::across(model, triangle, edge);
      if (next < 0 || next == left) return;
      left = triangle;
      work->crossed += 1;
      move_to(next);
    }
  }
};

}  // namespace palpate
