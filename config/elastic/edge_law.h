// What a place gives beside a sharp edge of the body, under a ball that presses along the face's normal: less of the
// body is there to carry it, and part of the contact is over nothing.
//
// At a distance s from the edge, with t = s / a of Hertz' contact, the force at a depth D is g of a half space's,
//   g = 1 - loss / (1 + (0.46 + 0.19 T) t' + (0.31 + 0.21 T) t'^2),   t' = t exp(6.8 (0.5 - w)),
//   loss = (1 - 0.29 - 0.15 T - (0.29 - 0.17 T) min(sqrt(D / R), 0.7)) (1.53 w + 0.94 w^2),
// T = (1 - 2 nu) / (1 - nu), w = 1 - opening / pi, the opening that of the solid between its faces. Read off
// large-strain elements in space (2026-11-28): a ball of 12 mm to 4 mm on a block of 100 x 60 x 100 mm, 0 to 16 mm from
// its edge, nu 0.45 and 0.2 (1.1 % RMS and 2.9 at most of these forces are left), and at and 4 mm beside edges of 135
// and 60 degrees, nu 0.45, from which the powers of w and t' come.
#pragma once

#include <numbers>

#include "config/elastic/width_law.h"

namespace palpate::elastic {

struct SharpEdge {
  double distance_m = 0;                      // along the face
  double opening_rad = std::numbers::pi / 2;  // of the solid: less than pi
  double length_m = 0;                        // of the mesh's edge
  bool is_corner = false;                     // the place is where it meets others
};

// g. Positive depths.
double edge_share(const SharpEdge& edge, const BallLaw& ball, double depth_m);

// What the tick has of it: the half space's law times `scale`, in series with a give.
struct EdgeFit {
  double scale = 1, give_mpN = 0;
};
// To a depth, beside what an edge does to places `told_m` from it, which elements tell. With the give alone: what of it
// elements have told in what a place gives.
enum class EdgeForm { kScaled, kGiveAlone };
EdgeFit fit_edge(const SharpEdge& edge, double told_m, const BallLaw& ball, double depth_max_m, EdgeForm form);

}  // namespace palpate::elastic
