#include "rt_core/contact/elastic/placed_law.h"

namespace palpate {

namespace {

// Hertz on a body instead of a plane: the tip's radius R becomes R_e. A ball: 1/R_e = k + 1/R, k the body's mean
// curvature. The side of a capsule: 1/R_e^2 = g^4 k_a (k_c + 1/R), the relative curvatures along its axis and across,
// g what the ellipse between them lacks to a circle, fitted to Hertz' integrals (1882) within 0.1 % from 1 to 12;
// beyond it is cut off, and a line contact comes out too soft.
struct CurvatureFactor {
  Real value, per_curvature;
};
struct Relative {
  Real sum, per_curvature;  // R / R_e
};
constexpr Real kNarrowest = 12;
Relative side_curvature(const ElasticRow& row, Real radius) PALPATE_RT {
  const Real across = max_of(1 + (2 * row.curvature_1_per_m - row.along_1_per_m) * radius, 0.25);
  const Real along = max_of(row.along_1_per_m * radius, across / kNarrowest), root = square_root(along * across);
  const Real x = (along + across) / root - 2, g = 1 - 0.079 * x + 0.008 * x * x;
  const Real by_x = 2 * g * root * (0.016 * x - 0.079), x_by_across = (across - along) / (2 * across * root);
  return {g * g * root, 2 * radius * (g * g * along / (2 * root) + by_x * x_by_across)};
}
CurvatureFactor curvature_factor(const TipLaw& law, const ElasticRow& row) PALPATE_RT {
  if (law.half_power != 3) return {1, 0};
  const Real radius = row.tip.margin_m;
  Relative relative{1 + row.curvature_1_per_m * radius, radius};
  if (!row.tip.is_ball()) {
    const Relative side = side_curvature(row, radius);
    const Real share = row.tip.sideness();
    relative = {(1 - share) * relative.sum + share * side.sum,
                (1 - share) * relative.per_curvature + share * side.per_curvature};
  }
  const Real sum = clamp_to(relative.sum, 0.25, 4.0), value = 1.0 / square_root(sum);
  return {value, sum == relative.sum ? -0.5 * value * relative.per_curvature / sum : 0.0};
}

// A flat punch holds the width of its contact, and what its place takes off its give is one factor of its stiffness: at
// most four.
constexpr Real kMostOfPunch = 0.75;

}  // namespace

PlacedLaw placed_law(const TipLaw& law, const ElasticRow& row) PALPATE_RT {
  PlacedLaw out;
  const Real rho = max_of(-row.c_m_per_N, 0.0), c_falls = rho > 0 ? -1.0 : 0.0;
  if (law.half_power == 2) {
    const Real share = rho * law.coefficient * row.modulus, gain = 1.0 / (1.0 - min_of(share, kMostOfPunch));
    out.scale = row.modulus * gain;
    out.scale_by_c = share < kMostOfPunch ? c_falls * law.coefficient * out.scale * out.scale : 0.0;
    out.scale_by_modulus = share < kMostOfPunch ? gain * gain : gain;
    return out;
  }
  const CurvatureFactor factor = curvature_factor(law, row);
  out.scale = factor.value * row.modulus;
  out.scale_by_curvature = factor.per_curvature * row.modulus;
  out.scale_by_modulus = factor.value;
  const Real base = out.scale * law.coefficient, square = base * base;
  if (law.half_power == 4) {
    out.terms = {0, 0, 2 * rho * square, 5 * rho * rho * square * base};
    out.by_c = {0, 0, 2 * c_falls * square, 10 * c_falls * rho * square * base};
    return out;
  }
  // beta goes with the tip's own radius on the body, R scale^2.
  const Real wide = row.tip.margin_m * factor.value * factor.value * square;
  out.terms = {1.5 * rho * square, 2.625 * rho * rho * square * base, row.beta_1_per_mN * wide, 0};
  out.by_c = {1.5 * c_falls * square, 5.25 * c_falls * rho * square * base, 0, 0};
  out.by_beta = {0, 0, wide, 0};
  const Real inverse = 1.0 / out.scale;
  out.by_scale = {2 * inverse * out.terms.second_N_per_m2, 3 * inverse * out.terms.between_N_per_m25,
                  4 * inverse * out.terms.third_N_per_m3, 0};
  return out;
}

}  // namespace palpate
