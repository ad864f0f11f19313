#include "rt_core/contact/elastic/place_numbers.h"

namespace palpate {

namespace {

using namespace elastic_layout;

// Of the sum of the products of area coordinates: below it the foot is a corner.
constexpr Real kCorner = 1e-30;

// Four numbers between the vertices that hold them and their gradients g: cubics that have both there, in Bezier form.
// Along an edge they are the same from both sides. So is the slope across it: the middle coefficient is
//   sum_k q_k middle_k / sum_k q_k,   q_k = w_i w_j
// (Foley and Opitz 1992), on the edge opposite to corner k that which makes the slope across at the edge's middle the
// mean of the corners'. It keeps parabolas. Straight between the vertices, c1's kink on the crest of a ring threw the
// tip aside by 0.5 N of 10 N and to the other side beyond the edge (2026-11-22).
struct VertexCubics {
  Double4 corner[3], next[3], before[3], middle[3];

  // `edge_m`: X_(k+1) - X_k.
  VertexCubics(const Vec3* edge_m, const CornerNormals& rest, const float* const* own) PALPATE_RT {
    Vec3x4 gradient[3];
    for (int k = 0; k < 3; ++k) {  // bound: 3
      Vec3 of_number[kOwnSlopes];
      for (int i = 0; i < 3; ++i) store(&of_number[0].x + 4 * i, widen4(own[k] + kOwnValues + 4 * i));
      gradient[k] = load4(of_number);
      corner[k] = widen4(own[k]);
      next[k] = corner[k] + (1.0 / 3) * dot(gradient[k], splat4(edge_m[k]));
      before[k] = corner[k] - (1.0 / 3) * dot(gradient[k], splat4(edge_m[(k + 2) % 3]));
    }
    for (int k = 0; k < 3; ++k) {  // bound: 3
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      // To corner k from the edge's middle: `across` times its direction across, `along` times the edge, and a rest
      // along the normal, on which nothing depends.
      const Vec3 normal = rest.normal[i] + rest.normal[j], side = cross(edge_m[i], normal);
      const Vec3 to_corner = 0.5 * (edge_m[j] - edge_m[k]);
      const Real inverse = 1.0 / max_of(squared_norm(side), kCorner);
      const Real across = 0.5 * inverse * dot(to_corner, side), along = inverse * dot(to_corner, cross(normal, side));
      const Double4 slope = dot(gradient[i] + gradient[j], splat4((2.0 / 3 * across) * side)) +
                            (0.5 * along) * (corner[j] - corner[i] + before[j] - next[i]);
      middle[k] = slope + 0.25 * (corner[i] + corner[j]) + 0.75 * (next[i] + before[j]) - 0.5 * (before[i] + next[j]);
    }
  }
  // And their derivatives in the area coordinates.
  Double4 at(const Real* w, Double4 (&slope)[3]) const PALPATE_RT {
    const Real in[3] = {max_of(w[0], 0.0), max_of(w[1], 0.0), max_of(w[2], 0.0)};
    const Real q[3] = {in[1] * in[2], in[2] * in[0], in[0] * in[1]}, sum = q[0] + q[1] + q[2];
    const Real inverse = sum > kCorner ? 1.0 / sum : 0.0, turn = in[0] * q[0] * inverse;
    const Double4 mean = inverse * (q[0] * middle[0] + q[1] * middle[1] + q[2] * middle[2]);
    Double4 value{};
    for (int k = 0; k < 3; ++k) {  // bound: 3
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      slope[k] = 3 * (w[k] * w[k] * corner[k] + w[i] * w[i] * before[i] + w[j] * w[j] * next[j]) +
                 6 * (w[k] * (w[i] * next[k] + w[j] * before[k]) + q[k] * mean +
                      turn * (in[j] * (middle[i] - mean) + in[i] * (middle[j] - mean)));
      value += (1.0 / 3) * w[k] * slope[k];  // Euler: homogeneous of degree three
    }
    return value;
  }
};

// How the slopes of the four numbers change along the edges from corner 0: straight between what the vertices have of
// it. Those of the cubics jump at every edge, and with them what a place asks of the modes (place_pull.h).
void show_bends(const Vec3* edge_m, const float* const* own, ElasticRow& row) PALPATE_RT {
  Double4 of[6];
  for (int i = 0; i < 6; ++i) {  // bound: 6 x 3
    of[i] = Double4{};
    for (int k = 0; k < 3; ++k) of[i] += splat4(row.foot.weight[k]) * widen4(own[k] + kOwnBends + kOwnSlopes * i);
  }
  const Vec3x4 x{of[0], of[1], of[2]}, y{of[1], of[3], of[4]}, z{of[2], of[4], of[5]};
  const Vec3x4 e = splat4(edge_m[0]), f = splat4(-edge_m[2]), turned{dot(x, e), dot(y, e), dot(z, e)};
  store(row.number_bend[0], dot(turned, e));
  store(row.number_bend[1], dot(turned, f));
  store(row.number_bend[2], dot({dot(x, f), dot(y, f), dot(z, f)}, f));
}

void show_values(const Double4& value, ElasticRow& row) PALPATE_RT {
  row.c_m_per_N = value[0];
  row.c1_m_per_N2 = value[1];
  row.curvature_1_per_m = value[2];
  row.beta_1_per_mN = value[3];
}

void show_modulus(const Model& model, ElasticRow& row) PALPATE_RT {
  row.modulus = 1;
  row.modulus_gradient = {};
  row.modulus_slope[0] = row.modulus_slope[1] = 0;
  if (!has_moduli(model)) return;
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(row.foot.triangle)];
  row.modulus = 0;
  for (int k = 0; k < 3; ++k) {  // bound: 3
    const Real ratio = modulus_ratio(model, triangle.vertex[k]);
    row.modulus += row.foot.weight[k] * ratio;
    row.modulus_gradient += ratio * row.foot.gradient_per_m[k];
    for (int i = 1; i < 3; ++i) row.modulus_slope[i - 1] += k == i ? ratio : k == 0 ? -ratio : 0.0;
  }
}

}  // namespace

void show_place_numbers(const Model& model, ElasticRow& row) PALPATE_RT {
  // Of a part of the surface there is one set of numbers, where it begins: vertices that two parts share have one.
  if (row.tip.is_of_part()) {
    const auto begins = static_cast<std::size_t>(row.tip.begins_at);
    show_values(widen4(own_terms(model, model.triangle[begins].vertex[0])), row);
    row.c_gradient = row.c1_gradient = row.curvature_gradient = row.beta_gradient = {};
    return show_modulus(model, row);
  }
  const auto index = static_cast<std::size_t>(row.foot.triangle);
  const Triangle& triangle = model.triangle[index];
  const float* own[3];
  Vec3 edge_m[3];
  for (int k = 0; k < 3; ++k) {  // bound: 3
    own[k] = own_terms(model, triangle.vertex[k]);
    edge_m[k] = model.vertex_m[static_cast<std::size_t>(triangle.vertex[(k + 1) % 3])] -
                model.vertex_m[static_cast<std::size_t>(triangle.vertex[k])];
  }
  const VertexCubics cubics(edge_m, model.corner_normal[index], own);
  Double4 slope[3];
  show_values(cubics.at(row.foot.weight, slope), row);
  if (row.has_slide) {
    for (int k = 0; k < 2; ++k) store(row.number_slope[k], slope[k + 1] - slope[0]);
    show_bends(edge_m, own, row);
  }
  Vec3x4 gradient = slope[0] * splat4(row.foot.gradient_per_m[0]);
  for (int k = 1; k < 3; ++k) gradient = gradient + slope[k] * splat4(row.foot.gradient_per_m[k]);  // bound: 2
  row.c_gradient = gradient[0];
  row.c1_gradient = gradient[1];
  row.curvature_gradient = gradient[2];
  row.beta_gradient = gradient[3];
  show_modulus(model, row);
}

}  // namespace palpate
