#include "sim_host/view/contact_profile.h"

#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

constexpr Real kLeastBend = 0.25;  // of the ball's: a tight fit has no edge

}  // namespace

Real contact_profile(TipShape shape, Real rho) {
  const bool inside = !(rho > 1);
  // Where rho^2 swallows what is left: the first term of the series in 1/rho, good to 1e-7 of itself from 1e3 on.
  const bool far = rho > 1e3;
  const Real angle = inside ? 0.5 * kPi : std::asin(1 / rho), root = inside ? 0.0 : std::sqrt((rho - 1) * (rho + 1));
  switch (shape) {
    case TipShape::kBall:
      if (far) return 4 / (3 * kPi * rho);
      return inside ? 1 - 0.5 * rho * rho : ((2 - rho * rho) * angle + root) / kPi;
    case TipShape::kCone:
      if (far) return 1 / (kPi * rho);
      return inside ? 1 - 2 * rho / kPi : 2 / kPi * (angle - rho + root);
    case TipShape::kFlat:
      return 2 / kPi * angle;
  }
  return 0;
}

Real contact_pressure(TipShape shape, Real rho) {
  if (!(rho < 1)) return 0;
  const Real root = std::sqrt((1 - rho) * (1 + rho));
  switch (shape) {
    case TipShape::kBall:
      return 1.5 * root;
    case TipShape::kCone:
      return std::acosh(1 / rho);
    case TipShape::kFlat:
      return 0.5 / root;
  }
  return 0;
}

Real contact_drawn_in(Real rho) {
  if (rho > 1) return 1 / rho;
  const Real s = std::sqrt((1 - rho) * (1 + rho));  // 1 - s^3 = (1 - s) (1 + s + s^2), 1 - s = rho^2 / (1 + s)
  return rho * (1 + s + s * s) / (1 + s);
}

Real contact_drawn_in_by_force(Real poisson_ratio) { return (1 - 2 * poisson_ratio) / (2 * kPi * (1 - poisson_ratio)); }

Real contact_spread(Real rho, Real poisson_ratio) {
  const Real back = 0.028 * (1 - 2 * poisson_ratio);
  if (rho > 1) return (0.075 / (rho * rho) - 0.082 + back) / (rho * rho * rho);
  return rho * (0.146 - (0.153 - back) * rho * rho);
}

Real fade_out(Real distance_m, Real from_m, Real to_m) {
  if (!(distance_m < to_m)) return 0;
  if (distance_m <= from_m) return 1;
  const Real s = (distance_m - from_m) / (to_m - from_m);
  return (1 - s) * (1 - s) * (1 + 2 * s);
}

Real ContactEllipse::radii(Vec3 from_middle) const {
  const Real x = dot(from_middle, along);
  return std::hypot(x / along_m, norm(from_middle - x * along) / across_m);
}

// x^2 / (A + t) + y^2 / (B + t) = 1, A and B the squares of the half axes.
Real ContactEllipse::radii_outside(Vec3 from_middle) const {
  const Real x = dot(from_middle, along), long2 = along_m * along_m, across2 = across_m * across_m;
  const Real x2 = x * x, y2 = squared_norm(from_middle - x * along);
  const Real b = x2 + y2 - long2 - across2, c = x2 * across2 + y2 * long2 - long2 * across2;
  const Real t = std::max(0.5 * (b + std::sqrt(std::max(b * b + 4 * c, 0.0))), 0.0);
  return std::sqrt(std::sqrt((1 + t / long2) * (1 + t / across2)));
}

ContactEllipse ball_contact(Real depth_m, Real ball_radius_m, const SurfaceBend& surface) {
  const auto half_axis = [&](Real bend) {
    return std::sqrt(depth_m * ball_radius_m / std::max(1 + bend * ball_radius_m, kLeastBend));
  };
  return {surface.along, half_axis(surface.most_1_per_m), half_axis(surface.least_1_per_m)};
}

}  // namespace palpate
