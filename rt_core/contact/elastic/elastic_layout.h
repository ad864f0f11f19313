// How an image holds an elastic body. Amplitudes p of its soft modes are in J^1/2: the linear energy is p.p / 2.
//   u(x) = sum_t shape_t(x) y_t,   y = p_a, then p_a p_b for the pairs a <= b in the order of pair_place()
// (a pair's shape has the 1/2 of its square in it). A vertex of the surface is a block of floats:
//   per term t 12: u, and du_i/dX_j row by row;  c (m/N), c1 (m/N2), mean curvature (1/m), beta (1/(m N)); the
//   gradients of these four along the surface, and how those change along it, xx xy xz yy yz zz of all four at once;
//   per linear mode 3: its shape in m/J^1/2. Rounded up to whole lanes of four.
// After all vertices what is drawn of a body under its tips, of which the tick knows nothing (drawn_shapes.h), and
// last, where a body has several materials, one float each: the contact modulus E / (1 - nu^2) there over that of the
// parameters.
//
// V = p.p/2 + p_a p_b W3_ab + p_a p_b W4_ab,  W3 = cubic . p,  W4 = quartic . y2  (y2 the pairs' products).
#pragma once

#include "rt_core/lanes.h"
#include "rt_core/model.h"

namespace palpate::elastic_layout {

inline constexpr std::int32_t kTermFloats = 12, kOwnSlopes = 4, kOwnValues = 4;
inline constexpr std::int32_t kOwnBends = kOwnValues + 3 * kOwnSlopes, kOwnFloats = kOwnBends + 6 * kOwnSlopes;

inline constexpr Real kLeastModulusRatio = 1e-6, kMostModulusRatio = 1e6;

constexpr std::int32_t pairs(std::int32_t soft) { return soft * (soft + 1) / 2; }
constexpr std::int32_t terms(std::int32_t soft) { return soft + pairs(soft); }
// a <= b
constexpr std::int32_t pair_place(std::int32_t a, std::int32_t b, std::int32_t soft) {
  return a * soft - a * (a - 1) / 2 + b - a;
}
constexpr std::int32_t vertex_floats(std::int32_t soft, std::int32_t linear) {
  return whole_lanes(kTermFloats * terms(soft) + kOwnFloats + 3 * linear, 4);
}

inline constexpr std::int32_t kMaxPairs = pairs(kMaxSoftModes), kMaxTerms = terms(kMaxSoftModes);

inline std::int32_t vertex_floats(const Model& model) PALPATE_RT {
  return vertex_floats(model.params.elastic_soft, model.params.elastic_linear);
}
inline const float* vertex_block(const Model& model, std::int32_t vertex) PALPATE_RT {
  return model.elastic_vertex.data() +
         static_cast<std::size_t>(vertex) * static_cast<std::size_t>(vertex_floats(model));
}
inline const float* own_terms(const Model& model, std::int32_t vertex) PALPATE_RT {
  return vertex_block(model, vertex) + kTermFloats * terms(model.params.elastic_soft);
}
inline const float* linear_shapes(const Model& model, std::int32_t vertex) PALPATE_RT {
  return own_terms(model, vertex) + kOwnFloats;
}

inline std::int64_t all_vertex_floats(const Model& model) PALPATE_RT {
  return model.sizes.n_vertex * vertex_floats(model);
}
// One float says of how many shapes; of each a vertex has its displacement, and what a newton there and a newton
// squared make of it.
inline constexpr std::int32_t kDrawnFloats = 5, kMostDrawnShapes = 128;
inline std::int64_t drawn_count(const Model& model) PALPATE_RT {
  return static_cast<std::int64_t>(model.elastic_vertex[static_cast<std::size_t>(all_vertex_floats(model))]);
}
inline std::int64_t drawn_floats(const Model& model) PALPATE_RT {
  return 1 + kDrawnFloats * drawn_count(model) * model.sizes.n_vertex;
}
inline bool has_moduli(const Model& model) PALPATE_RT {
  return model.sizes.n_elastic_vertex > all_vertex_floats(model) + drawn_floats(model);
}
// Of a body that has them.
inline Real modulus_ratio(const Model& model, std::int32_t vertex) PALPATE_RT {
  const std::int64_t at = model.sizes.n_elastic_vertex - model.sizes.n_vertex + vertex;
  return static_cast<Real>(model.elastic_vertex[static_cast<std::size_t>(at)]);
}

}  // namespace palpate::elastic_layout
