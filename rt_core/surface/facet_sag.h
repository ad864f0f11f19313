// How far the smooth surface stands off a facet: a cubic, smooth across the facet's edges.
#pragma once

#include "rt_core/lanes.h"
#include "rt_core/surface/foot_search.h"

namespace palpate {

// With corners V, unit normals U and area coordinates w the surface is at X + s n. That it has its normals asks for
// slopes of s of -U . dX: at the corners a_ki = U_k . (V_k - V_i) towards corner i, and across an edge, from its
// middle, with the mean of the normals at its ends. In Bezier form
//   s = sum w_k^2 w_i a_ki + 6 w_0 w_1 w_2 m,
//   m = sum q_k m_k / sum q_k,   q_k = w_i w_j,
//   m_k = (a_ik + a_jk) / 6 + (a_ij + a_ji) / 12 + l_k (a_ji - a_ij) / 2
// (Foley and Opitz 1992), where l_k is how far along edge i to j from its middle corner k is, of the edge, on the body
// at rest. Along an edge s and its slope across, over the facets' own tilt, are the same from both sides. The parabola
// through chord and normals, sum w_k (V_k - X) . U_k / 2, has kinks there: 2.7 mrad on a heart, 0.11 rad in its cleft,
// by each of which the force on a tip steps (2026-11-26).
class FacetSag {
 public:
  FacetSag() = default;
  // `rest`: the triangle's corners on the body at rest.
  FacetSag(const foot::Corners& corners, const Vec3 (&rest)[3], const Real (&weight)[3]) PALPATE_RT
      : weight_{max_of(weight[0], 0.0), max_of(weight[1], 0.0), max_of(weight[2], 0.0), max_of(weight[2], 0.0)},
        normal_(lanes_of(corners.u)),
        edge_m_(edges_of(lanes_of(corners.v))) {
    next_m_ = -dot(normal_, edge_m_);
    before_m_ = dot(normal_, before(edge_m_));
    const Vec3x4 side_m = edges_of(lanes_of(rest)), to_m = next(side_m);
    const Double4 square = dot(to_m, to_m);
    const Double4 half = -0.5 * dot(side_m, to_m) / (square + kNoEdge) - 0.25;  // of l_k
    middle_m_ = (1.0 / 6) * (next(before_m_) + before(next_m_)) + (1.0 / 12 - half) * next(next_m_) +
                (1.0 / 12 + half) * before(before_m_);
    ahead_ = next(weight_);
    behind_ = before(weight_);
    product_ = ahead_ * behind_;
    const Real all = product_[0] + product_[1] + product_[2], inverse = all > kCorner ? 1 / all : 0.0;
    mean_m_ = inverse * sum(product_ * middle_m_);
    turn_ = 6 * inverse * weight_[0] * product_[0];
    const Double4 share = turn_ * product_, square_of_weight = weight_ * weight_;
    by_next_ = square_of_weight * ahead_ + before(share * (1.0 / 12 - half)) + (1.0 / 6) * next(share);
    by_before_ = square_of_weight * behind_ + next(share * (1.0 / 12 + half)) + (1.0 / 6) * before(share);
    value_m = sum(by_next_ * next_m_ + by_before_ * before_m_);
  }
  Real value_m = 0;
  // Its derivatives in the area coordinates, and in places and normals of the corners: lanes 0 to 2.
  Double4 slope_m() const PALPATE_RT {
    return 2 * weight_ * (ahead_ * next_m_ + behind_ * before_m_) + behind_ * behind_ * before(next_m_) +
           ahead_ * ahead_ * next(before_m_) + 6 * mean_m_ * product_ +
           turn_ * (behind_ * (next(middle_m_) - mean_m_) + ahead_ * (before(middle_m_) - mean_m_));
  }
  Vec3x4 by_place() const PALPATE_RT {
    return (by_next_ + by_before_) * normal_ - before(by_next_ * normal_) - next(by_before_ * normal_);
  }
  Vec3x4 by_normal() const PALPATE_RT { return by_before_ * before(edge_m_) - by_next_ * edge_m_; }

 private:
  static constexpr Real kCorner = 1e-30;   // of the sum of the products of area coordinates: below it a corner
  static constexpr Real kNoEdge = 1e-100;  // keeps an edge of no length from being divided by

  // Corner k's lane takes what stands at the next corner, or at the one before. Lane 3 is corner 2's, with an edge of
  // no length: valgrind does not know how gcc 12 makes a zero of it.
  static Double4 next(const Double4& v) PALPATE_RT { return __builtin_shufflevector(v, v, 1, 2, 0, 3); }
  static Double4 before(const Double4& v) PALPATE_RT { return __builtin_shufflevector(v, v, 2, 0, 1, 3); }
  static Vec3x4 next(const Vec3x4& v) PALPATE_RT { return {next(v.x), next(v.y), next(v.z)}; }
  static Vec3x4 before(const Vec3x4& v) PALPATE_RT { return {before(v.x), before(v.y), before(v.z)}; }
  static Vec3x4 lanes_of(const Vec3 (&v)[3]) PALPATE_RT {
    return {Double4{v[0].x, v[1].x, v[2].x, v[2].x}, Double4{v[0].y, v[1].y, v[2].y, v[2].y},
            Double4{v[0].z, v[1].z, v[2].z, v[2].z}};
  }
  static Vec3x4 edges_of(const Vec3x4& corner) PALPATE_RT { return next(corner) - corner; }

  Double4 weight_{}, ahead_{}, behind_{}, product_{};
  Vec3x4 normal_{}, edge_m_{};
  Double4 next_m_{}, before_m_{};    // a towards the next corner and the one before
  Double4 middle_m_{};               // m_k
  Double4 by_next_{}, by_before_{};  // s in a
  Real mean_m_ = 0, turn_ = 0;       // m, and 6 w_0 w_1 w_2 over the sum of q
};

}  // namespace palpate
