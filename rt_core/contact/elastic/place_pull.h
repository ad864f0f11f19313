// What the numbers of a place ask of the soft modes that slide the material under its tip.
#pragma once

#include "rt_core/contact/elastic/elastic_load.h"

namespace palpate {

// Powers of the force with which what a place stores goes by c, c1, curvature and beta, and the modulus: a ball's.
inline constexpr Real kPlacePowers[elastic_layout::kOwnSlopes] = {2, 3, 5.0 / 3, 8.0 / 3}, kModulusPower = 5.0 / 3;

// Of the modes' own stiffness, 1 each, what the bend of a place's numbers may add to or take from their sum: beyond it
// what the place asks of them fades, and is gone at twice as much. c1 falls towards the rim of a slender column's end,
// and held it up to twice its Euler load (2026-11-25). The bend is that of the vertices: with that of each triangle's
// cubics the rod of a ring that stood by a vertex was asked for all on one side of it and for nothing on the other, and
// turned to and fro by 31 mN of 9.5 N (2026-11-26).
inline constexpr Real kMostOfModes = 0.25;
// And of the pull, what the slope of that in the force may add before it fades, gone at a half more.
inline constexpr Real kMostOfPull = 0.1;

// What a place asks of the modes that slide it: E_a = place . numbers' slope . slide at `force_N`, as a constant beside
// force times the row's pull, and its bend along the surface beside force times the row's turn.
template <class Count>
void pull_by_place(const PlaceForce& place, Real force_N, Count n, ElasticRow& row, Real* constant) PALPATE_RT {
  Real ask[2], per_N[2], bend[3] = {};
  const Real inverse = 1.0 / force_N;
  for (int k = 0; k < 2; ++k) {  // bound: 2 x 4
    ask[k] = place.by_modulus * row.modulus_slope[k];
    per_N[k] = kModulusPower * ask[k];
    for (int i = 0; i < elastic_layout::kOwnSlopes; ++i) {
      const Real by = place.by[i] * row.number_slope[k][i];
      ask[k] += by;
      per_N[k] += kPlacePowers[i] * by;
    }
  }
  for (int k = 0; k < 3; ++k)  // bound: 3 x 4
    for (int i = 0; i < elastic_layout::kOwnSlopes; ++i) bend[k] += inverse * place.by[i] * row.number_bend[k][i];
  const Real *s = row.slide[0], *t = row.slide[1];
  Real of_s[kMaxSoftModes], of_t[kMaxSoftModes], added[kMaxSoftModes], whole = 0, square = 0, before = 0;
  for (std::int32_t a = 0; a < n; ++a) {  // bound: soft
    of_s[a] = bend[0] * s[a] + bend[1] * t[a];
    of_t[a] = bend[1] * s[a] + bend[2] * t[a];
    added[a] = inverse * (per_N[0] * s[a] + per_N[1] * t[a]);
    whole += abs_of(of_s[a] * s[a] + of_t[a] * t[a]);
    square += added[a] * added[a];
    before += row.pull[a] * row.pull[a];
  }
  const Real bent = force_N * whole / kMostOfModes, longer = square / (kMostOfPull * kMostOfPull * before);
  const Real left = clamp_to(2.0 - max_of(bent, longer), 0.0, 1.0), share = left * left * (3 - 2 * left);
  if (!(share > 0)) return;
  std::int32_t pair = 0;
  for (std::int32_t a = 0; a < n; ++a) {  // bound: pairs
    constant[a] += share * (ask[0] * s[a] + ask[1] * t[a] - force_N * added[a]);
    row.pull[a] += share * added[a];
    for (std::int32_t b = a; b < n; ++b, ++pair) row.turn[pair] -= share * (of_s[a] * s[b] + of_t[a] * t[b]);
  }
}

}  // namespace palpate
