#include "rt_core/contact/elastic/placed_law.h"

#include "rt_core/contact/elastic/ball_on_body.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

// Hertz on a body instead of a plane: the tip's radius R becomes R_e, 1/R_e = k + 1/R, k the body's mean curvature.
struct CurvatureFactor {
  Real value, per_curvature;
};
CurvatureFactor curvature_factor(const TipLaw& law, const ElasticRow& row) PALPATE_RT {
  if (law.half_power != 3) return {1, 0};
  const Real radius = row.tip.margin_m, sum = sharper(row.curvature_1_per_m, radius), value = 1.0 / square_root(sum);
  const bool is_within = sum == 1 + row.curvature_1_per_m * radius;
  return {value, is_within ? -0.5 * value * radius / sum : 0.0};
}

// A flat punch holds the width of its contact, and what its place takes off its give is one factor of its stiffness: at
// most four.
constexpr Real kMostOfPunch = 0.75;

// What a place adds to m e^1.5: the series of c where it is negative, and beta on a tip of radius R_e.
void add_terms(const ElasticRow& row, Real base, Real wide, PlacedLaw& out) PALPATE_RT {
  const Real rho = max_of(-row.c_m_per_N, 0.0), c_falls = rho > 0 ? -1.0 : 0.0, square = base * base;
  out.terms = {1.5 * rho * square, 2.625 * rho * rho * square * base, row.beta_1_per_mN * wide, 0};
  out.by_c = {1.5 * c_falls * square, 5.25 * c_falls * rho * square * base, 0, 0};
  out.by_beta = {0, 0, wide, 0};
}

// Of a line's force at the deepest depth, what beta takes of it at most: of a ball's the bake leaves a share of the
// tangent.
constexpr Real kMostByBeta = 0.35;

// What a place adds to a line. beta is what a contact that grows with the dent is worth: along the axis it does so as
// an ellipse, with the radius of the ball that has its force, where the body bends away, and not where the line's ends
// are reached. With that radius there, too, jaws on a block were 7 and 17 % too soft, with the tip's own everywhere a
// rod on an arch 3.5 % at 2 mm instead of 2.5 (2026-11-26).
void add_line_terms(const TipLaw& law, const ElasticRow& row, PlacedLaw& out) PALPATE_RT {
  const Real radius = row.tip.margin_m, square = squared_norm(row.tip.half_axis_w);
  const Real depth = row.told_m();
  const LineLaw::Point& told = row.told;
  const Real base = told.force_N / (depth * square_root(depth));
  const Real equal = base / (law.coefficient * row.modulus), bent = row.line.along_1_per_m * square;
  const Real wide = radius * (2 * depth + bent * equal * equal) / (2 * depth + bent);
  if (!(told.force_N > 0)) return;
  // The series of c, and beta, in powers of the line's force as those of a ball's (travel.h, line_energies).
  const Real rho = max_of(-row.c_m_per_N, 0.0), root = math::cbrt(base);
  const Real second = 0.75 * root * root, third = 0.25 * wide / (root * root), beta = row.beta_1_per_mN;
  // At the deepest depth: 4^p times the force, 4 + 8 (p - 1) for powers p of 1 to 1.5.
  const Real power = row.told_power();
  const Real held = 1.0 / (1 + max_of(-beta, 0.0) * wide * told.force_N * (8 * power - 4) / kMostByBeta);
  out.terms = {rho, second * rho * rho, beta * third * held, 0};
}

void place_line(const TipLaw& law, const ElasticRow& row, PlacedLaw& out) PALPATE_RT {
  LineLaw::Shape shape = row.line;
  shape.is_circle = law.first_factor >= 0;
  out.is_line = true;
  out.line = LineLaw(shape, row.tip.modulus_Pa * row.modulus, law.depth_max_m);
  out.scale = row.modulus;
  add_line_terms(law, row, out);
  if (abs_of(out.terms.between_N_per_m25) > 0 || abs_of(out.terms.third_N_per_m3) > 0) out.line.tell_root();
}

// dF = 2 E* a de (Jaeger 1995), a = sqrt(e / k) on a body of curvature k until the flat tip's. It is narrower towards
// the face's ends.
constexpr Real kFlat = 1e-4;  // of the tip's radius: a crest no higher is flat
void place_plate(const TipLaw& law, const ElasticRow& row, PlacedLaw& out) PALPATE_RT {
  const RoundTip& tip = row.tip;
  const Real narrower = (1 - tip.along * tip.along / 6) * (1 - tip.across * tip.across / 6);
  const Real radius = tip.flat_m * narrower, crest = row.curvature_1_per_m * radius * radius;
  const Real share = max_of(-row.c_m_per_N, 0.0) * 2 * tip.modulus_Pa * radius * row.modulus;
  out.scale = row.modulus / (1.0 - min_of(share, kMostOfPunch));
  out.is_plate = true;
  out.plate = law;
  out.plate.coefficient = 2 * tip.modulus_Pa * radius;
  if (!(crest > kFlat * radius)) return;
  out.plate.half_power = 3;
  out.plate.coefficient = 4.0 / 3 * tip.modulus_Pa / square_root(row.curvature_1_per_m);
  out.plate.depth_max_m = crest;
}

}  // namespace

void place_law(const TipLaw& law, const ElasticRow& row, PlacedLaw& out) PALPATE_RT {
  if (row.tip.is_line() && law.half_power == 3) return place_line(law, row, out);
  if (row.tip.is_plate()) return place_plate(law, row, out);
  const Real rho = max_of(-row.c_m_per_N, 0.0), c_falls = rho > 0 ? -1.0 : 0.0;
  if (law.half_power == 2) {
    const Real share = rho * law.coefficient * row.modulus, gain = 1.0 / (1.0 - min_of(share, kMostOfPunch));
    out.scale = row.modulus * gain;
    out.scale_by_c = share < kMostOfPunch ? c_falls * law.coefficient * out.scale * out.scale : 0.0;
    out.scale_by_modulus = share < kMostOfPunch ? gain * gain : gain;
    return;
  }
  const CurvatureFactor factor = curvature_factor(law, row);
  out.scale = factor.value * row.modulus;
  out.scale_by_curvature = factor.per_curvature * row.modulus;
  out.scale_by_modulus = factor.value;
  const Real base = out.scale * law.coefficient, square = base * base;
  if (law.half_power == 4) {
    out.terms = {0, 0, 2 * rho * square, 5 * rho * rho * square * base};
    out.by_c = {0, 0, 2 * c_falls * square, 10 * c_falls * rho * square * base};
    return;
  }
  // beta goes with the tip's own radius on the body, R scale^2.
  add_terms(row, base, row.tip.margin_m * factor.value * factor.value * square, out);
  const Real inverse = 1.0 / out.scale;
  out.by_scale = {2 * inverse * out.terms.second_N_per_m2, 3 * inverse * out.terms.between_N_per_m25,
                  4 * inverse * out.terms.third_N_per_m3, 0};
}

}  // namespace palpate
