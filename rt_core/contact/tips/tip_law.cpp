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

}  // namespace

LocalLaw local_law(const Model& model, std::int32_t piece) PALPATE_RT {
  const TipLaw& tip = model.tip_law[static_cast<std::size_t>(piece)];
  return {&tip, tip.first_factor < 0 ? nullptr : &model.factor[static_cast<std::size_t>(tip.first_factor)]};
}

LawPoint local_at(const LocalLaw& law, Real e_m) PALPATE_RT {
  if (!(e_m > 0)) return {};
  if (e_m <= law.tip->depth_max_m) return inside_at(law, e_m);
  const LawPoint edge = inside_at(law, law.tip->depth_max_m);
  return {edge.force_N + edge.tangent_N_per_m * (min_of(e_m, kHuge) - law.tip->depth_max_m), edge.tangent_N_per_m};
}

Real local_energy_J(const LocalLaw& law, Real e_m) PALPATE_RT {
  if (!(e_m > 0)) return 0.0;
  if (e_m <= law.tip->depth_max_m) return inside_energy_J(law, e_m);
  const LawPoint edge = inside_at(law, law.tip->depth_max_m);
  const Real beyond = min_of(e_m, kHuge) - law.tip->depth_max_m;
  return inside_energy_J(law, law.tip->depth_max_m) + (edge.force_N + 0.5 * edge.tangent_N_per_m * beyond) * beyond;
}

Real interval_energy_J(const LocalLaw& law, std::int32_t interval) PALPATE_RT {
  return energy_from_knot(law, interval, (interval + 1) / kIntervals);
}

}  // namespace palpate
