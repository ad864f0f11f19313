#include "rt_core/contact/elastic/soft_energy.h"

#include "rt_core/contact/elastic/mode_count.h"

namespace palpate {

namespace {

using namespace elastic_layout;

// One homogeneous part P of degree n: W = d2P / (n (n - 1)), so dP = n W p / ... as below.
struct Part {
  Real energy = 0;
  Real w[kMaxPairs];       // P = p.W p
  Real wp[kMaxSoftModes];  // W p
};

// Columns of pairs(soft) numbers, four rows at a time.
template <class Count>
void multiply(const double* columns, const Real* x, std::int32_t count, Count soft, Real* out) PALPATE_RT {
  const std::int32_t rows = pairs(soft);
  std::int32_t i = 0;
  for (; i + 4 <= rows; i += 4) {  // bound: pairs^2
    Double4 sum{};
    for (std::int32_t c = 0; c < count; ++c) sum += splat4(x[c]) * load4(columns + c * rows + i);
    store(out + i, sum);
  }
  for (; i < rows; ++i) {  // bound: 3 pairs
    Real sum = 0;
    for (std::int32_t c = 0; c < count; ++c) sum += x[c] * columns[c * rows + i];
    out[i] = sum;
  }
}

template <class Count>
void finish(Count soft, const Real* p, Part& part) PALPATE_RT {
  for (std::int32_t a = 0; a < soft; ++a) part.wp[a] = 0;
  std::int32_t k = 0;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: pairs
    for (std::int32_t b = a; b < soft; ++b, ++k) {
      part.wp[a] += part.w[k] * p[b];
      if (b != a) part.wp[b] += part.w[k] * p[a];
    }
  }
  for (std::int32_t a = 0; a < soft; ++a) part.energy += p[a] * part.wp[a];
}

// Adds f P, with f = f(rho), f1 and f2 its derivatives; inside the ball f = 1. With g = dP = n W p, H = n (n - 1) W,
// and rho's gradient e = p / rho, curvature (1 - e e') / rho.
struct Continuation {
  Real f = 1, f1 = 0, f2 = 0, rho = 0;
};
// Returns f1 P / rho.
template <class Count>
Real add_slope(Count soft, const Real* p, const Part& part, Real degree, const Continuation& c, Real& energy_J,
               Real* slope) PALPATE_RT {
  energy_J += c.f * part.energy;
  const Real along = c.rho > 0 ? part.energy * c.f1 / c.rho : 0.0;
  for (std::int32_t a = 0; a < soft; ++a) slope[a] += c.f * degree * part.wp[a] + along * p[a];
  return along;
}
template <class Count>
void add_part(Count soft, const Real* p, const Part& part, Real degree, const Continuation& c,
              SoftEnergy& out) PALPATE_RT {
  const Real along = add_slope(soft, p, part, degree, c, out.energy_J, out.slope);
  const Real inverse = c.rho > 0 ? 1.0 / c.rho : 0.0;
  const Real bend = c.f * degree * (degree - 1), cross = c.f1 * degree * inverse,
             twice = (part.energy * c.f2 - along) * inverse * inverse;
  std::int32_t k = 0;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: pairs
    for (std::int32_t b = a; b < soft; ++b, ++k) {
      Real h = bend * part.w[k];
      if (c.rho > 0) h += cross * (part.wp[a] * p[b] + part.wp[b] * p[a]) + twice * p[a] * p[b];
      if (a == b) h += along;
      out.curvature[a * soft + b] += h;
      if (a != b) out.curvature[b * soft + a] += h;
    }
  }
}

// Of t^n along its tangent at the radius: f = (r^n + n r^(n-1) (rho - r)) / rho^n.
Continuation continued(Real degree, Real radius, Real rho) PALPATE_RT {
  const Real square = rho * rho, power = degree == 3 ? square * rho : square * square;
  const Real radius_power = degree == 3 ? radius * radius : radius * radius * radius;  // r^(n-1)
  const Real p1 = degree * radius_power, value = radius_power * radius + p1 * (rho - radius);
  const Real s = 1.0 / power, s1 = -degree * s / rho, s2 = degree * (degree + 1) * s / square;
  return {value * s, p1 * s + value * s1, 2 * p1 * s1 + value * s2, rho};
}

// The cubic and the quartic part at amplitudes p.
struct Parts {
  Part third, fourth;
  Real radius, rho;
  bool is_outside;

  template <class Count>
  Parts(const Model& model, Count soft, const Real* p, const Real* y) PALPATE_RT
      : radius(model.params.elastic_radius_rootJ) {
    Real square = 0;
    for (std::int32_t a = 0; a < soft; ++a) square += p[a] * p[a];
    rho = square_root(square);
    is_outside = !(rho <= radius);
    multiply(model.elastic_cubic.data(), p, soft, soft, third.w);
    multiply(model.elastic_quartic.data(), y + soft, pairs(soft), soft, fourth.w);
    finish(soft, p, third);
    finish(soft, p, fourth);
  }
  Continuation continuation(Real degree) const PALPATE_RT {
    return is_outside ? continued(degree, radius, rho) : Continuation{};
  }
};

template <class Count>
void sum_energy(const Model& model, Count soft, const Real* p, const Real* y, SoftEnergy& out) PALPATE_RT {
  const Parts parts(model, soft, p, y);
  out.energy_J = 0.5 * parts.rho * parts.rho;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: soft^2
    out.slope[a] = p[a];
    for (std::int32_t b = 0; b < soft; ++b) out.curvature[a * soft + b] = a == b ? 1.0 : 0.0;
  }
  out.is_outside = parts.is_outside;
  add_part(soft, p, parts.third, 3, parts.continuation(3), out);
  add_part(soft, p, parts.fourth, 4, parts.continuation(4), out);
}

template <class Count>
Real sum_slope(const Model& model, Count soft, const Real* p, const Real* y, Real* slope) PALPATE_RT {
  const Parts parts(model, soft, p, y);
  Real energy_J = 0.5 * parts.rho * parts.rho;
  for (std::int32_t a = 0; a < soft; ++a) slope[a] = p[a];
  add_slope(soft, p, parts.third, 3, parts.continuation(3), energy_J, slope);
  add_slope(soft, p, parts.fourth, 4, parts.continuation(4), energy_J, slope);
  return energy_J;
}

template <class Count>
void multiply_out(Count soft, const Real* p, Real* y) PALPATE_RT {
  for (std::int32_t a = 0; a < soft; ++a) y[a] = p[a];
  std::int32_t k = soft;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: pairs
    for (std::int32_t b = a; b < soft; ++b) y[k++] = p[a] * p[b];
  }
}

}  // namespace

void soft_products(std::int32_t soft, const Real* p, Real* y) PALPATE_RT {
  with_mode_count(soft, [&](auto n) PALPATE_RT { multiply_out(n, p, y); });
}

void soft_energy(const Model& model, const Real* p, const Real* y, SoftEnergy& out) PALPATE_RT {
  with_mode_count(model.params.elastic_soft, [&](auto n) PALPATE_RT { sum_energy(model, n, p, y, out); });
}

Real soft_slope(const Model& model, const Real* p, const Real* y, Real* slope) PALPATE_RT {
  Real energy_J = 0;
  with_mode_count(model.params.elastic_soft, [&](auto n) PALPATE_RT { energy_J = sum_slope(model, n, p, y, slope); });
  return energy_J;
}

}  // namespace palpate
