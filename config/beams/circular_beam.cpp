#include "config/beams/circular_beam.h"

#include "rt_core/math.h"

namespace palpate {
namespace {

// Terms of the power series: at s = kArcSeriesBelow the last is below 1e-18 of the sum.
constexpr int kSeriesTerms = 24;

struct Hyperbolic {
  Real sinh, cosh;
};
Hyperbolic hyperbolic(Real x) PALPATE_RT {
  const Real up = math::exp(x), down = 1.0 / up;
  return {0.5 * (up - down), 0.5 * (up + down)};
}

// sinh x - x and cosh x - 1, to full relative accuracy for |x| <= 1 (series) and beyond.
Real sinh_less_argument(Real x) PALPATE_RT {
  if (abs_of(x) > 1) return hyperbolic(x).sinh - x;
  const Real x2 = x * x;
  Real term = x, sum = 0;
  for (int k = 1; k <= 9; ++k) {  // bound: 9
    term *= x2 / ((2.0 * k) * (2.0 * k + 1.0));
    sum += term;
  }
  return sum;
}
Real cosh_less_one(Real x) PALPATE_RT {
  const Real half = 0.5 * x;
  const Real sinh = half + sinh_less_argument(half);
  return 2.0 * sinh * sinh;
}
// exp x - 1 = sinh x + (cosh x - 1).
Real exp_less_one(Real x) PALPATE_RT { return x + sinh_less_argument(x) + cosh_less_one(x); }

// s cosh s - sinh s = sum_{k>=1} 2k s^(2k+1) / (2k+1)!
Real bending_sum(Real s) PALPATE_RT {
  Real power = s, sum = 0;
  for (int k = 1; k <= kSeriesTerms; ++k) {  // bound: kSeriesTerms
    power *= s * s / ((2.0 * k) * (2.0 * k + 1.0));
    sum += 2.0 * k * power;
  }
  return sum;
}
// sinh^2 s - s^2 = sum_{k>=2} (2s)^(2k) / (2 (2k)!)
Real couple_sum(Real s) PALPATE_RT {
  const Real y2 = 4.0 * s * s;
  Real power = 0.5 * y2, sum = 0;
  for (int k = 2; k <= kSeriesTerms; ++k) {  // bound: kSeriesTerms
    power *= y2 / ((2.0 * k - 1.0) * (2.0 * k));
    sum += 0.5 * power;
  }
  return sum;
}
// s cosh^2 s + s/2 - 3/4 sinh 2s = sum_{k>=2} (k-1) (2s)^(2k+1) / (2 (2k+1)!)
Real shear_sum(Real s) PALPATE_RT {
  const Real y2 = 4.0 * s * s;
  Real power = 2.0 * s * y2 / 6.0, sum = 0;
  for (int k = 2; k <= kSeriesTerms; ++k) {  // bound: kSeriesTerms
    power *= y2 / ((2.0 * k) * (2.0 * k + 1.0));
    sum += 0.5 * (k - 1.0) * power;
  }
  return sum;
}
// Numerator of J3: with h = s/2, sum_{k>=2} e_k h^(2k) / (2k)!, whose terms of order 0 and 2 cancel identically.
Real mixed_sum(Real s, Real nu) PALPATE_RT {
  const Real h2 = 0.25 * s * s;
  Real power = 0.5 * h2, nine = 9.0, twenty_five = 25.0, sum = 0;
  for (int k = 2; k <= kSeriesTerms; ++k) {  // bound: kSeriesTerms
    power *= h2 / ((2.0 * k - 1.0) * (2.0 * k));
    nine *= 9.0;
    twenty_five *= 25.0;
    const Real e = 2.0 * (4.0 * nu - 7.0) * twenty_five + (18.0 + 16.0 * k * (1.0 - 2.0 * nu)) * nine -
                   (8.0 * nu + 4.0) + 48.0 * k * (1.0 + 2.0 * nu);
    sum += e * power;
  }
  return sum;
}

struct ArcSums {
  Real bending = 0, couple = 0, shear = 0, mixed = 0, sinh = 0, cosh = 0;
};
ArcSums series_sums(Real s, Real nu) PALPATE_RT {
  return {bending_sum(s),        couple_sum(s), shear_sum(s), mixed_sum(s, nu), s + sinh_less_argument(s),
          1.0 + cosh_less_one(s)};
}
ArcSums closed_sums(Real s, Real nu) PALPATE_RT {
  const Hyperbolic h = hyperbolic(s), half = hyperbolic(0.5 * s), three = hyperbolic(1.5 * s),
                   five = hyperbolic(2.5 * s);
  ArcSums sums;
  sums.bending = s * h.cosh - h.sinh;
  sums.couple = h.sinh * h.sinh - s * s;
  sums.shear = s * h.cosh * h.cosh + 0.5 * s - 1.5 * h.sinh * h.cosh;
  sums.mixed = 2.0 * (4.0 * nu - 7.0) * five.cosh + 18.0 * three.cosh - (8.0 * nu + 4.0) * half.cosh +
               12.0 * s * (1.0 - 2.0 * nu) * three.sinh + 12.0 * s * (1.0 + 2.0 * nu) * half.sinh;
  sums.sinh = h.sinh;
  sums.cosh = h.cosh;
  return sums;
}

bool is_usable(const ArcSection& section) PALPATE_RT {
  return section.inner_m > 0 && section.outer_m > section.inner_m && section.outer_m < kHuge && section.thickness_m > 0;
}

// N, with the factor that makes the stresses of a force.
Real force_constant_m2(const ArcSection& section) PALPATE_RT {
  const Real s = arc_log_ratio(section);
  const Real sum = s < kArcSeriesBelow ? bending_sum(s) : closed_sums(s, 0).bending;
  return 2.0 * section.inner_m * section.outer_m * sum;
}

// S_r and S_theta per unit F, without t: factored, so that they vanish exactly where they must.
struct RadialFunctions {
  Real radial_per_m = 0, hoop_per_m = 0;
};
RadialFunctions radial_functions(const ArcSection& section, Real n_m2, Real r) PALPATE_RT {
  const Real a = section.inner_m, b = section.outer_m, ab = a * b;
  const Real per = 1.0 / (n_m2 * r * r * r);
  const Real radial = per * ((r - a) * (r + a)) * ((r - b) * (r + b));
  return {radial, radial + 2.0 * per * (r * r - ab) * (r * r + ab)};
}

// Stresses of a unit couple, without t, in x = ln(r / sqrt(ab)).
PolarStress couple_stress(const ArcSection& section, Real r) PALPATE_RT {
  const Real s = arc_log_ratio(section);
  const Real q = section.inner_m * section.outer_m;
  const Real x = 0.5 * (math::log(r / section.inner_m) + math::log(r / section.outer_m));
  const Real sum = s < kArcSeriesBelow ? couple_sum(s) : closed_sums(s, 0).couple;
  const Real scale = -1.0 / (q * sum);  // -4 / (q N'/q^2)
  const Real excess = sinh_less_argument(s);
  const Real sinh = s + excess;
  const Real common = 2.0 * x * sinh - s * cosh_less_one(s);
  const Real exponential = s * exp_less_one(-2.0 * x);
  return {scale * (common + exponential), scale * (common - exponential + 2.0 * excess), 0};
}

// Displacement (times E t) of unit load cases before the rigid motion, and the rigid motion that clamps them.
struct Golovin {
  Real a1 = 0, b1 = 0, d1 = 0;  // A, B, D of the stress function for unit F
  Real nu = 0, r0 = 0;
  // (1-3nu) A r^2 + (1+nu) B / r^2 + (1-nu) D ln(r/r0)
  Real g(Real r) const PALPATE_RT {
    return (1.0 - 3.0 * nu) * a1 * r * r + (1.0 + nu) * b1 / (r * r) + (1.0 - nu) * d1 * math::log(r / r0);
  }
  // (5+nu) A r^2 + (1+nu) B / r^2 - (1-nu) D ln(r/r0) - (1+nu) D
  Real p(Real r) const PALPATE_RT {
    return (5.0 + nu) * a1 * r * r + (1.0 + nu) * b1 / (r * r) - (1.0 - nu) * d1 * math::log(r / r0) - (1.0 + nu) * d1;
  }
  Real p_slope(Real r) const PALPATE_RT {
    return 2.0 * (5.0 + nu) * a1 * r - 2.0 * (1.0 + nu) * b1 / (r * r * r) - (1.0 - nu) * d1 / r;
  }
};
Golovin golovin(const ArcSection& section, Real nu) PALPATE_RT {
  const Real a2 = section.inner_m * section.inner_m, b2 = section.outer_m * section.outer_m;
  const Real n = force_constant_m2(section);
  return {0.5 / n, -0.5 * a2 * b2 / n, -(a2 + b2) / n, nu, middle_radius_m(section)};
}

// Times E t: case 1 (sin theta), external force -F1 r^.
PolarVector unit_radial(const Golovin& w, Real angle, Real r, Real theta) PALPATE_RT {
  const Real c = math::cos(angle), s = math::sin(angle), r0 = w.r0;
  const Real h = c * w.p_slope(r0);
  const Real l = 2.0 * w.d1 * angle - s * c * (w.g(r0) + w.p(r0)) + h * r0 * s;
  const Real k = c * c * w.p(r0) - s * s * w.g(r0) - h * r0 * c;
  const Real ct = math::cos(theta), st = math::sin(theta);
  return {-2.0 * w.d1 * theta * ct + st * w.g(r) + k * st + l * ct,
          2.0 * w.d1 * theta * st - ct * w.p(r) + k * ct - l * st + h * r};
}
// Times E t: case 2 (cos theta), external force +F2 theta^ through the centre.
PolarVector unit_tangential(const Golovin& w, Real angle, Real r, Real theta) PALPATE_RT {
  const Real c = math::cos(angle), s = math::sin(angle), r0 = w.r0;
  const Real h = -s * w.p_slope(r0);
  const Real k = -(2.0 * w.d1 * angle + s * c * (w.g(r0) + w.p(r0))) - h * r0 * c;
  const Real l = -(c * c * w.g(r0) - s * s * w.p(r0)) + h * r0 * s;
  const Real ct = math::cos(theta), st = math::sin(theta);
  return {2.0 * w.d1 * theta * st + ct * w.g(r) + k * st + l * ct,
          2.0 * w.d1 * theta * ct + st * w.p(r) + k * ct - l * st + h * r};
}
// Times E t: unit couple (Timoshenko & Goodier section 28), with ln taken of r / r0.
PolarVector unit_couple(const ArcSection& section, Real nu, Real angle, Real r, Real theta) PALPATE_RT {
  const Real s = arc_log_ratio(section), q = section.inner_m * section.outer_m, r0 = middle_radius_m(section);
  const Real sum = s < kArcSeriesBelow ? couple_sum(s) : closed_sums(s, 0).couple;
  const Real a2 = section.inner_m * section.inner_m, b2 = section.outer_m * section.outer_m;
  const Real m = 1.0 / (q * q * sum);  // 4 / N'
  const Real a = -m * q * q * s;
  const Real b = -0.5 * m * (b2 - a2);
  // sigma_r = A/r^2 + B (1 + 2 ln(r/r0)) + 2C
  const Real two_c = -m * (b2 * math::log(r0 / section.outer_m) + a2 * math::log(section.inner_m / r0)) - b;
  const auto g = [&](Real x) PALPATE_RT {
    return -(1.0 + nu) * a / x + 2.0 * (1.0 - nu) * b * x * math::log(x / r0) - (1.0 + nu) * b * x +
           (1.0 - nu) * two_c * x;
  };
  const Real g0 = g(r0);
  return {g(r) - g0 * math::cos(angle - theta), 4.0 * b * r * (theta - angle) - g0 * math::sin(angle - theta)};
}

}  // namespace

Real arc_log_ratio(const ArcSection& section) PALPATE_RT {
  const Real x = (section.outer_m - section.inner_m) / section.inner_m;
  if (x > 0.5) return math::log(1.0 + x);
  // 2 artanh z, z = x / (2 + x) <= 0.2: 12 terms leave z^24 / 25 < 1e-18.
  const Real z = x / (2.0 + x), z2 = z * z;
  Real power = 1, sum = 0;
  for (int k = 0; k < 12; ++k) {  // bound: 12
    sum += power / (2.0 * k + 1.0);
    power *= z2;
  }
  return 2.0 * z * sum;
}

ArcFunctions arc_functions(const ArcSection& section, Real poisson_ratio) PALPATE_RT {
  ArcFunctions f;
  if (!is_usable(section)) return f;
  f.s = arc_log_ratio(section);
  f.q_m2 = section.inner_m * section.outer_m;
  const ArcSums sums = f.s < kArcSeriesBelow ? series_sums(f.s, poisson_ratio) : closed_sums(f.s, poisson_ratio);
  f.n_hat = 2.0 * sums.bending;
  f.n_bar = 4.0 * sums.couple;
  f.t = 4.0 * sums.cosh / sums.bending;
  f.j2 = sums.shear / (sums.bending * sums.bending);
  f.j3_sqrt = sums.mixed / (9.0 * sums.bending * sums.couple);  // (8/9) / (2 * 4)
  f.j4_area = 4.0 * sums.sinh / sums.couple;
  return f;
}

PolarStress arc_stress(const ArcSection& section, const ArcLoad& load, Real r_m, Real theta) PALPATE_RT {
  PolarStress stress;
  if (!(is_usable(section) && r_m > 0)) return stress;
  const RadialFunctions f = radial_functions(section, force_constant_m2(section), r_m);
  const Real c = math::cos(theta), s = math::sin(theta), per_t = 1.0 / section.thickness_m;
  // Case 1 carries an external -F1 r^, case 2 an external +F2 theta^.
  const Real along_sin = -load.radial_N, along_cos = load.tangential_N;
  stress.radial_Pa = per_t * f.radial_per_m * (along_sin * s + along_cos * c);
  stress.hoop_Pa = per_t * f.hoop_per_m * (along_sin * s + along_cos * c);
  stress.shear_Pa = per_t * f.radial_per_m * (-along_sin * c + along_cos * s);
  if (load.couple_Nm != 0) {
    const PolarStress unit = couple_stress(section, r_m);
    stress.radial_Pa += per_t * load.couple_Nm * unit.radial_Pa;
    stress.hoop_Pa += per_t * load.couple_Nm * unit.hoop_Pa;
  }
  return stress;
}

PolarStress arc_stress_paper(const ArcSection& section, Real f1_N, Real f2_N, Real r_m, Real theta) PALPATE_RT {
  if (!(is_usable(section) && r_m > 0)) return {};
  const RadialFunctions f = radial_functions(section, force_constant_m2(section), r_m);
  const Real amplitude = (f1_N * math::sin(theta) - f2_N * math::cos(theta)) / section.thickness_m;
  return {f.radial_per_m * amplitude, f.hoop_per_m * amplitude, 0};
}

PolarVector arc_displacement(const ArcSection& section, const BeamMaterial& material, Real angle, const ArcLoad& load,
                             Real r_m, Real theta) PALPATE_RT {
  if (!(is_usable(section) && r_m > 0 && material.youngs_modulus_Pa > 0)) return {};
  const Golovin w = golovin(section, material.poisson_ratio);
  const Real scale = 1.0 / (material.youngs_modulus_Pa * section.thickness_m);
  const PolarVector one = unit_radial(w, angle, r_m, theta), two = unit_tangential(w, angle, r_m, theta);
  PolarVector sum{-load.radial_N * one.radial_m + load.tangential_N * two.radial_m,
                  -load.radial_N * one.tangential_m + load.tangential_N * two.tangential_m};
  if (load.couple_Nm != 0) {
    const PolarVector couple = unit_couple(section, material.poisson_ratio, angle, r_m, theta);
    sum.radial_m += load.couple_Nm * couple.radial_m;
    sum.tangential_m += load.couple_Nm * couple.tangential_m;
  }
  return {scale * sum.radial_m, scale * sum.tangential_m};
}

Real rectangle_torsion_m4(Real side_m, Real other_side_m) PALPATE_RT {
  const Real high = max_of(side_m, other_side_m), low = min_of(side_m, other_side_m);
  const Real ratio = low / high, ratio2 = ratio * ratio;
  return high * low * low * low * (1.0 / 3.0 - 0.21 * ratio * (1.0 - ratio2 * ratio2 / 12.0));
}

ArcCompliance arc_tip_compliance(const ArcSection& section, const BeamMaterial& material, Real angle,
                                 Real force_radius_m) PALPATE_RT {
  ArcCompliance c;
  const Real e = material.youngs_modulus_Pa, nu = material.poisson_ratio;
  if (!(is_usable(section) && e > 0 && nu > -1 && angle > 0 && force_radius_m > 0)) return c;
  const ArcFunctions f = arc_functions(section, nu);
  const Real cosine = math::cos(angle), sine = math::sin(angle);
  const Real half = math::sin(0.5 * angle);
  const Real less_cosine = 2.0 * half * half;  // 1 - cos, without its cancellation
  const Real v = 2.0 * (1.0 + nu) * f.j2;
  const Real j3 = f.j3_sqrt / square_root(f.q_m2), j4 = f.j4_area / f.q_m2;
  const Real per_et = 1.0 / (e * section.thickness_m);
  const Real r = force_radius_m;
  c.rr_m_per_N = per_et * (0.5 * f.t * (angle - sine * cosine) + v * sine * cosine);
  c.rt_m_per_N = per_et * (0.5 * (2.0 * v - f.t) * sine * sine - r * j3 * less_cosine);
  c.tt_m_per_N =
      per_et * (0.5 * f.t * (angle + sine * cosine) - v * sine * cosine + 2.0 * r * j3 * sine + r * r * j4 * angle);

  const Real h = section.outer_m - section.inner_m, t = section.thickness_m, g = e / (2.0 * (1.0 + nu));
  const Real radius = middle_radius_m(section), cube = radius * radius * radius;
  const Real sine2 = math::sin(2.0 * angle);
  const Real bending = 0.5 * angle - 0.25 * sine2;
  const Real torsion = 1.5 * angle - 2.0 * sine + 0.25 * sine2;
  c.zz_m_per_N = cube * bending / (e * h * t * t * t / 12.0) + cube * torsion / (g * rectangle_torsion_m4(h, t)) +
                 1.2 * radius * angle / (g * h * t);
  return c;
}

ArcPaperCompliance arc_paper_compliance(const ArcSection& section, const BeamMaterial& material, Real angle,
                                        Real force_radius_m) PALPATE_RT {
  const PolarVector one = arc_displacement(section, material, angle, {-1, 0, 0}, force_radius_m, 0);
  const PolarVector two = arc_displacement(section, material, angle, {0, 1, 0}, force_radius_m, 0);
  return {one.radial_m, two.radial_m, one.tangential_m, two.tangential_m};
}

}  // namespace palpate
