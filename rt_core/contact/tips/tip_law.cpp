#include "rt_core/contact/tips/tip_law.h"

#include "rt_core/limits.h"

namespace palpate {

namespace {

constexpr Real kIntervals = kFactorKnots - 1;

// Cubic Hermite on one interval of the factor table, x in [0, 1].
struct FactorPoint {
  Real value, slope;
};
FactorPoint factor_between(const FactorKnot& a, const FactorKnot& b, Real u) PALPATE_RT {
  constexpr Real h = 1.0 / kIntervals;
  const Real rise = b.value - a.value;
  const Real p = h * a.slope, q = h * b.slope;
  const Real c2 = 3.0 * rise - 2.0 * p - q, c3 = p + q - 2.0 * rise;
  return {a.value + u * (p + u * (c2 + u * c3)), (p + u * (2.0 * c2 + 3.0 * u * c3)) * kIntervals};
}

std::int32_t interval_of(Real x) PALPATE_RT {
  const auto i = static_cast<std::int32_t>(x * kIntervals);
  return i < kFactorKnots - 2 ? i : kFactorKnots - 2;
}

// e^(n/2 - 1) for n = 2, 3, 4.
Real power_below(std::int32_t half_power, Real e) PALPATE_RT {
  return half_power == 2 ? 1.0 : half_power == 3 ? square_root(e) : e;
}

// Inside the range, e in [0, depth_max].
LawPoint inside_at(const LocalLaw& law, Real e) PALPATE_RT {
  const TipLaw& tip = *law.tip;
  const Real below = tip.coefficient * power_below(tip.half_power, e), n_half = 0.5 * tip.half_power;
  if (law.factor == nullptr) return {below * e, n_half * below};
  const Real x = square_root(e / tip.depth_max_m);
  const std::int32_t i = interval_of(x);
  const FactorPoint s = factor_between(law.factor[i], law.factor[i + 1], x * kIntervals - i);
  // dS/de = S' x/(2 e): the e cancels against that of the power.
  return {below * e * s.value, below * (n_half * s.value + 0.5 * x * s.slope)};
}

// Integral of F from knot i to x: F de = 2 c depth_max^(n/2 + 1) x^(n + 1) S dx is a polynomial of degree n + 4 <= 8,
// which five Gauss points integrate exactly.
Real energy_from_knot(const LocalLaw& law, std::int32_t i, Real x) PALPATE_RT {
  constexpr Real kPoint[5] = {-0.90617984593866399, -0.53846931010568309, 0.0, 0.53846931010568309,
                              0.90617984593866399};
  constexpr Real kWeight[5] = {0.23692688505618909, 0.47862867049936647, 0.56888888888888889, 0.47862867049936647,
                               0.23692688505618909};
  const TipLaw& tip = *law.tip;
  const Real from = i / kIntervals, half = 0.5 * (x - from), middle = 0.5 * (x + from);
  Real sum = 0;
  for (int k = 0; k < 5; ++k) {  // bound: 5
    const Real at = middle + half * kPoint[k];
    const Real value = factor_between(law.factor[i], law.factor[i + 1], at * kIntervals - i).value;
    Real power = at * at * at;                                      // at^(n + 1)
    for (std::int32_t m = 2; m < tip.half_power; ++m) power *= at;  // bound: 2
    sum += kWeight[k] * power * value;
  }
  const Real scale = tip.coefficient * power_below(tip.half_power, tip.depth_max_m) * tip.depth_max_m;
  return 2.0 * scale * tip.depth_max_m * half * sum;
}

Real inside_energy_J(const LocalLaw& law, Real e) PALPATE_RT {
  const TipLaw& tip = *law.tip;
  if (law.factor == nullptr) {
    return tip.coefficient * power_below(tip.half_power, e) * e * e / (0.5 * tip.half_power + 1.0);
  }
  const Real x = square_root(e / tip.depth_max_m);
  const std::int32_t i = interval_of(x);
  return law.factor[i].energy_J + energy_from_knot(law, i, x);
}

// Beyond depth_max, in units of the tangent there: force, tangent and energy of d = e - depth_max. Without a limit the
// tangent goes on. Towards a limit, u = d / (limit - depth_max): energy d^2 / (2 (1 - u)), which begins as the tangent
// and has no end before the plate. In the last twentieth its own tangent goes on: a tool put there by force (presses
// without a hand) meets a wall, not a pole.
struct Beyond {
  Real depth_m, force_m, tangent, energy_m2;
};
Beyond beyond_at(const LocalLaw& law, Real e_m) PALPATE_RT {
  constexpr Real kLast = 0.95;
  const Real d = min_of(e_m, kHuge) - law.tip->depth_max_m, room = law.tip->limit_m - law.tip->depth_max_m;
  if (!(room > 0)) return {d, d, 1, 0.5 * d * d};
  const Real at = min_of(d, kLast * room), u = at / room, v = 1 - u, over = d - at;
  const Real force = at * (1 - 0.5 * u) / (v * v);
  const Real tangent = (1 - 0.5 * u) / (v * v) + u * (1.5 - 0.5 * u) / (v * v * v);
  return {d, force + tangent * over, tangent, 0.5 * at * at / v + (force + 0.5 * tangent * over) * over};
}

}  // namespace

LocalLaw local_law(const Model& model, std::int32_t piece) PALPATE_RT {
  const TipLaw& tip = model.tip_law[static_cast<std::size_t>(piece)];
  return {&tip, tip.first_factor < 0 ? nullptr : &model.factor[static_cast<std::size_t>(tip.first_factor)]};
}

LawPoint local_at(const LocalLaw& law, Real e_m) PALPATE_RT {
  if (!(e_m > 0)) return {};
  if (e_m <= law.tip->depth_max_m) return inside_at(law, e_m);
  const LawPoint edge = inside_at(law, law.tip->depth_max_m);
  const Beyond beyond = beyond_at(law, e_m);
  const Real tangent = edge.tangent_N_per_m;
  return {edge.force_N + tangent * beyond.force_m, tangent * beyond.tangent};
}

Real local_energy_J(const LocalLaw& law, Real e_m) PALPATE_RT {
  if (!(e_m > 0)) return 0.0;
  if (e_m <= law.tip->depth_max_m) return inside_energy_J(law, e_m);
  const LawPoint edge = inside_at(law, law.tip->depth_max_m);
  const Beyond beyond = beyond_at(law, e_m);
  return inside_energy_J(law, law.tip->depth_max_m) + edge.force_N * beyond.depth_m +
         edge.tangent_N_per_m * beyond.energy_m2;
}

LawPoint place_at(const PlaceTerms& place, Real range_m, Real e_m) PALPATE_RT {
  if (!(e_m > 0)) return {};
  const Real e = min_of(e_m, range_m), beyond = min_of(e_m, kHuge) - e, root = square_root(e);
  const Real force =
      e * e *
      (place.second_N_per_m2 + place.between_N_per_m25 * root + e * (place.third_N_per_m3 + e * place.fourth_N_per_m4));
  const Real tangent = e * (2 * place.second_N_per_m2 + 2.5 * place.between_N_per_m25 * root +
                            e * (3 * place.third_N_per_m3 + 4 * e * place.fourth_N_per_m4));
  return {force + tangent * beyond, tangent};
}

PlaceEnergies place_energies(Real range_m, Real e_m) PALPATE_RT {
  if (!(e_m > 0)) return {};
  const Real e = min_of(e_m, range_m), beyond = min_of(e_m, kHuge) - e, root = square_root(e);
  const Real square = e * e, cube = square * e, fourth = square * square;
  PlaceEnergies energy{{cube / 3, cube * root / 3.5, fourth / 4, fourth * e / 5}};
  if (!(beyond > 0)) return energy;
  // (F + F' d / 2) d
  const Real half = 0.5 * beyond, slope = e * root;
  energy.of[0] += (square + 2 * e * half) * beyond;
  energy.of[1] += (square * root + 2.5 * slope * half) * beyond;
  energy.of[2] += (cube + 3 * square * half) * beyond;
  energy.of[3] += (fourth + 4 * cube * half) * beyond;
  return energy;
}

Real interval_energy_J(const LocalLaw& law, std::int32_t interval) PALPATE_RT {
  return energy_from_knot(law, interval, (interval + 1) / kIntervals);
}

namespace {

// Where a depth lies in the table: interval, local coordinate, and how far beyond the last knot.
struct Place {
  std::int32_t interval = 0;
  Real u = 0, h = 0;
  Real x = 0;         // variable of the table
  Real beyond_m = 0;  // depth beyond the last knot
};

Place place_of(const TableLaw& law, Real e) PALPATE_RT {
  const Real last = law.knot[law.knots - 1], depth_last = law.root ? last * last : last;
  Place place;
  place.beyond_m = e > depth_last ? min_of(e, kHuge) - depth_last : 0.0;
  place.x = place.beyond_m > 0 ? last : law.root ? square_root(e) : e;
  std::int32_t low = 0, high = law.knots - 1;
  for (int k = 0; k < 6 && high - low > 1; ++k) {  // bound: log2(kMaxResponseKnots)
    const std::int32_t middle = (low + high) / 2;
    (place.x < law.knot[middle] ? high : low) = middle;
  }
  place.interval = low;
  place.h = law.knot[low + 1] - law.knot[low];
  place.u = (place.x - law.knot[low]) / place.h;
  return place;
}

// Cubic Hermite f = c0 + c1 u + c2 u^2 + c3 u^3 of one interval.
struct Cubic {
  Real c0, c1, c2, c3;
};
Cubic cubic_of(const ResponseKnot& a, const ResponseKnot& b, Real h) PALPATE_RT {
  const Real rise = b.force_N - a.force_N, p = h * a.slope, q = h * b.slope;
  return {a.force_N, p, 3.0 * rise - 2.0 * p - q, p + q - 2.0 * rise};
}

LawPoint curve_at(const TableLaw& law, const ResponseKnot* curve, const Place& place) PALPATE_RT {
  const Cubic c = cubic_of(curve[place.interval], curve[place.interval + 1], place.h);
  const Real u = place.u;
  LawPoint point{c.c0 + u * (c.c1 + u * (c.c2 + u * c.c3)), (c.c1 + u * (2.0 * c.c2 + 3.0 * u * c.c3)) / place.h};
  if (u >= 1.0) point.force_N = curve[place.interval + 1].force_N;  // the last sample to the bit, as all others
  // dF/de = (dF/dx) / (2 x); at x = 0 the bakers give curves of zero slope, whose limit is c2 / h^2.
  if (law.root) {
    point.tangent_N_per_m = place.x > 1e-9 ? 0.5 * point.tangent_N_per_m / place.x : c.c2 / (place.h * place.h);
  }
  point.force_N += point.tangent_N_per_m * place.beyond_m;
  return point;
}

// Integral of the curve over depth within its interval: of f dx, or of f 2 x dx.
Real curve_energy_J(const TableLaw& law, const ResponseKnot* curve, const Place& place) PALPATE_RT {
  const Cubic c = cubic_of(curve[place.interval], curve[place.interval + 1], place.h);
  const Real u = place.u;
  const Real plain = u * (c.c0 + u * (c.c1 / 2.0 + u * (c.c2 / 3.0 + u * c.c3 / 4.0)));
  Real energy = place.h * plain;
  if (law.root) {
    const Real moment = u * u * (c.c0 / 2.0 + u * (c.c1 / 3.0 + u * (c.c2 / 4.0 + u * c.c3 / 5.0)));
    energy = 2.0 * place.h * (law.knot[place.interval] * plain + place.h * moment);
  }
  energy += curve[place.interval].energy_J;
  if (!(place.beyond_m > 0)) return energy;
  Place edge = place;
  edge.beyond_m = 0;
  const LawPoint point = curve_at(law, curve, edge);
  return energy + (point.force_N + 0.5 * point.tangent_N_per_m * place.beyond_m) * place.beyond_m;
}

}  // namespace

TableLaw table_law(const Model& model, std::int32_t piece, std::int32_t triangle, const Real (&weight)[3]) PALPATE_RT {
  TableLaw law;
  const std::size_t set = static_cast<std::size_t>(model.piece[static_cast<std::size_t>(piece)].curve_set);
  law.knot = model.knot.data();
  law.knots = static_cast<std::int32_t>(model.knot.size());
  law.root = model.params.response_root == 1;
  for (int k = 0; k < 3; ++k) {  // bound: 3
    const std::int32_t vertex = model.triangle[static_cast<std::size_t>(triangle)].vertex[k];
    const std::int32_t row = model.vertex_response[set * model.vertex_m.size() + static_cast<std::size_t>(vertex)];
    law.curve[k] = &model.response[static_cast<std::size_t>(row) * model.knot.size()];
    law.weight[k] = weight[k];
  }
  return law;
}

LawPoint table_at(const TableLaw& law, Real e_m) PALPATE_RT {
  if (!(e_m > 0)) return {};
  const Place place = place_of(law, e_m);
  LawPoint sum;
  for (int k = 0; k < 3; ++k) {  // bound: 3
    const LawPoint point = curve_at(law, law.curve[k], place);
    sum.force_N += law.weight[k] * point.force_N;
    sum.tangent_N_per_m += law.weight[k] * point.tangent_N_per_m;
  }
  return sum;
}

CornerEnergies table_energies(const TableLaw& law, Real e_m) PALPATE_RT {
  CornerEnergies result;
  if (!(e_m > 0)) return result;
  const Place place = place_of(law, e_m);
  for (int k = 0; k < 3; ++k) result.energy_J[k] = curve_energy_J(law, law.curve[k], place);  // bound: 3
  return result;
}

CornerForces table_forces(const TableLaw& law, Real e_m) PALPATE_RT {
  CornerForces result;
  if (!(e_m > 0)) return result;
  const Place place = place_of(law, e_m);
  for (int k = 0; k < 3; ++k) result.force_N[k] = curve_at(law, law.curve[k], place).force_N;  // bound: 3
  return result;
}

}  // namespace palpate
