#include "rt_core/contact/elastic/own_field.h"

namespace palpate {

namespace {

// How far c1 may change a place's compliance, of what c and the dent give, before the place goes on by its tangent.
// With c1 < 0 it would turn back. With c1 > 0 it would not; but c is what the soft modes leave of the place, and where
// they leave little the second order of the whole soon is more than it: with half of c, or four times c, a dome under
// 51 N was 7.8 or 4.1 % too stiff, with this 0.6 % (2026-11-23).
constexpr Real kMostStiffening = 0.5, kMostSoftening = 20;
// Of the dent's give at the deepest depth: a layer that takes off so much of it has no second order of its own.
// A whole one there was 7.0 % (RMS) instead of 1.4 too stiff on the layer of docs/accuracy.md (2026-11-26).
constexpr Real kLayer = 0.2;

// What the dent gives at the deepest depth; a line's by its power where it is told, without which c1 might spend twice
// what is there: a rod pressed an hourglass with 70,000 N (2026-11-29).
Real dent_m_per_N(const TipLaw& law, const ElasticRow& row) PALPATE_RT {
  if (row.tip.is_line() && row.told.force_N > 0) {
    const Real power = row.told_power();
    const Real by_beta = max_of(row.beta_1_per_mN, 0.0) * row.tip.margin_m * row.told.force_N * (8 * power - 4);
    return 1.0 / (row.told.tangent_N_per_m * (2 * power - 1) * (1 + 2 * by_beta));
  }
  return 2 * law.depth_max_m / (law.half_power * law.force_max_N * row.modulus);
}

}  // namespace

OwnField own_field(const TipLaw& law, const ElasticRow& row) PALPATE_RT {
  const Real dent = dent_m_per_N(law, row), c = max_of(row.c_m_per_N, 0.0);
  OwnField own;
  if (row.c_m_per_N < 0) {
    const Real layer = kLayer * dent, left = clamp_to(1.0 + row.c_m_per_N / layer, 0.0, 1.0);
    own.second_share = left * left * (3 - 2 * left);
    own.second_slope_N_per_m = 6 * left * (1 - left) / layer;
  }
  const Real c1 = own.second_share * row.c1_m_per_N2, twice = 2 * abs_of(c1);
  own.room_m_per_N = c + dent;
  const Real most = (c1 > 0 ? kMostSoftening : kMostStiffening) * own.room_m_per_N;
  own.far = {c, c1, twice * kHuge > most ? most / twice : kHuge};
  return own;
}

FarChange far_change(const OwnField& own, Real c_m_per_N, Real c1_m_per_N2, Real force_N) PALPATE_RT {
  const Real f = force_N, end = own.far.force_max_N;
  Real per_c0 = 0.5 * f * f, per_c1 = f * f * f / 3;
  if (f > end) {
    // Along the tangent from `end`, which moves with c and 1 / c1.
    const Real beyond = (f - end) * (f - end) * end;
    per_c1 = end * (f * f - end * f + end * end / 3) - beyond;
    per_c0 += own.far.c1_m_per_N2 / own.room_m_per_N * beyond;
  }
  const Real by_share = own.second_slope_N_per_m * c1_m_per_N2 * per_c1;
  return {c_m_per_N > 0 ? per_c0 : by_share, own.second_share * per_c1};
}

}  // namespace palpate
