#include "config/elastic/width_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "config/response/layer_loss.h"
#include "rt_core/contact/elastic/ball_on_body.h"

namespace palpate::elastic {

namespace {

constexpr double kHertzShare = 0.2;  // variance of Hertz' pressure, of a^2
// Of the force under large strain: header.
constexpr double kInwards = 0.25, kIncompressible = -0.066, kInwardsSquare = 0.21, kThinner = 3.45, kWidening = 0.1,
                 kMostThinned = 0.25, kAway = 0.82;
constexpr double kMostCurved = 2;
constexpr double kMostElliptic = 4.0 / 9;
constexpr double kTooStiff = 0.27, kTooStiffByShare = 0.2, kDeepestInLayer = 0.6;
constexpr double kThickPlate = 4;  // of the ball's radii: half of what large strain adds is left
constexpr int kFitPoints = 24;
// Of the dent: what a wall's width may change of it. First order ends there, and with 0.6 the travel of a change that
// grows as a^3 would turn back.
constexpr double kMostOfDent = 0.5;
constexpr double kMostBent = 0.3;  // curvature by deviation: nodes at edges
constexpr double kWidest = 0.98;   // of a ball's radius
// Of a half space's give under the narrower patch: from mesh to mesh elements differ by so much (self_terms.cpp).
constexpr double kNoise = 0.007;
// Of a half space's give: where a layer on a base that gives is told half from its fall, half as one on a rigid base.
constexpr double kSeen = 0.12;
constexpr double kThinnest = 1.33;  // layer or plate, in deviations of the narrower patch
// The series' tangent at the deepest depth keeps this share of the half space's.
constexpr double kLeastTangent = 0.3;
constexpr double kMostGive = 0.06;  // of 1 / (E* R): what the fit may add to c
// Of the kernels' integrals: to w = 12, where they are 1e-8.
constexpr int kWaves = 96;
constexpr double kStep = 0.125, kPlateFrom = 0.5;

double compressible_share(double poisson_ratio) { return (1 - 2 * poisson_ratio) / (1 - poisson_ratio); }
double hertz_factor(const BallLaw& ball) { return 4.0 / 3 * ball.modulus_Pa * std::sqrt(ball.radius_m); }  // m

// Simpson's rule for `kernel`, from w = `from`.
template <class Kernel>
double integral(double from, const Kernel& kernel) {
  double sum = 0;
  for (int i = 0; i <= kWaves; ++i) sum += (i == 0 || i == kWaves ? 1 : 2 + 2 * (i % 2)) * kernel(from + kStep * i);
  return sum * kStep / 3;
}
double half_space_mpN(double sigma_m, double modulus_Pa) {
  return 1 / (2 * std::sqrt(std::numbers::pi) * sigma_m * modulus_Pa);
}
double plate_gain(double w) {
  const double x = std::exp(-2 * w), y = 4 * w * w * x;
  return (1 - x * x + 4 * w * x) / ((1 - x) * (1 - x) - y) - 1;
}
// The thickness from which on something is too thick; never less than an element's edge, which tells no thinner one.
template <class Function>
double zero_thickness_m(double sigma_m, const Function& is_too_thick) {
  double low = kThinnest * sigma_m, high = 1e4 * sigma_m;
  for (int i = 0; i < 50; ++i) {
    const double middle = std::sqrt(low * high);
    (is_too_thick(middle) ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace

double WidthLaw::layer_mpN(double sigma_m, double thickness_m) const {
  const ElasticLayer unit{1, poisson_ratio_, LayerBase::kBonded};
  const double square = sigma_m * sigma_m / (thickness_m * thickness_m);
  return -integral(0, [&](double w) { return layer_loss(unit, w) * std::exp(-square * w * w); }) /
         (std::numbers::pi * modulus_Pa_ * thickness_m);
}
double WidthLaw::plate_mpN(double sigma_m, double thickness_m) const {
  const double square = sigma_m * sigma_m / (thickness_m * thickness_m);
  return integral(kPlateFrom, [&](double w) { return plate_gain(w) * std::expm1(-square * w * w); }) /
         (std::numbers::pi * modulus_Pa_ * thickness_m);
}

WidthLaw::WidthLaw(const double (&met_mpN)[2], const double (&sigma_m)[2], double modulus_Pa, double poisson_ratio,
                   double curvature_1pm)
    : modulus_Pa_(modulus_Pa), poisson_ratio_(poisson_ratio), met_m_(sigma_m[0]) {
  const double bent = std::clamp(curvature_1pm * sigma_m[0], -kMostBent, kMostBent) / sigma_m[0];
  curved_mpN_ =
      (1 - 2 * poisson_ratio) * compressible_share(poisson_ratio) * bent / (2 * std::numbers::pi * modulus_Pa);
  const double give_mpN[2] = {met_mpN[0], met_mpN[1] + curved_mpN_ * std::log(sigma_m[1] / sigma_m[0])};
  const double square[2] = {sigma_m[0] * sigma_m[0], sigma_m[1] * sigma_m[1]};
  square_1pmN_ = (give_mpN[1] - give_mpN[0]) / (square[1] - square[0]);
  narrow_mpN_ = give_mpN[0] - square_1pmN_ * square[0];
  if (narrow_mpN_ < 0) {
    const double give[2] = {less_noise_mpN(give_mpN, sigma_m), give_mpN[1]};
    tell_layer(give, sigma_m);
  } else if (square_1pmN_ < 0) {
    tell_plate(give_mpN, sigma_m);
  }
}

void WidthLaw::tell_layer(const double (&give_mpN)[2], const double (&sigma_m)[2]) {
  kind_ = Kind::kLayer;
  const double square[2] = {sigma_m[0] * sigma_m[0], sigma_m[1] * sigma_m[1]};
  const auto rest = [&](int i, double h) { return (give_mpN[i] - layer_mpN(sigma_m[i], h)) / square[i]; };
  thickness_m_ = zero_thickness_m(sigma_m[0], [&](double h) { return rest(0, h) < rest(1, h); });
  square_1pmN_ = rest(1, thickness_m_);
  if (square_1pmN_ > 0 && give_mpN[1] < 0) {
    const auto ratio = [&](double h) { return layer_mpN(sigma_m[0], h) / layer_mpN(sigma_m[1], h); };
    const double near = zero_thickness_m(sigma_m[0], [&](double h) { return ratio(h) < give_mpN[0] / give_mpN[1]; });
    const double seen = std::pow(give_mpN[0] / (kSeen * half_space_mpN(sigma_m[0], modulus_Pa_)), 4);
    thickness_m_ *= std::pow(near / thickness_m_, seen / (1 + seen));
    const double layer[2] = {layer_mpN(sigma_m[0], thickness_m_), layer_mpN(sigma_m[1], thickness_m_)};
    share_ = (give_mpN[0] * square[1] - give_mpN[1] * square[0]) / (layer[0] * square[1] - layer[1] * square[0]);
    square_1pmN_ = (give_mpN[1] - share_ * layer[1]) / square[1];
  }
  narrow_mpN_ = share_ * layer_mpN(0, thickness_m_);
}

void WidthLaw::tell_plate(const double (&give_mpN)[2], const double (&sigma_m)[2]) {
  kind_ = Kind::kPlate;
  const auto fall = [&](double h) { return plate_mpN(sigma_m[0], h) - plate_mpN(sigma_m[1], h); };
  const double whole = give_mpN[0] - give_mpN[1], square[2] = {sigma_m[0] * sigma_m[0], sigma_m[1] * sigma_m[1]};
  thickness_m_ = zero_thickness_m(sigma_m[0], [&](double h) { return fall(h) < whole; });
  // An edge or a corner falls more than any plate: what is left is a parabola.
  square_1pmN_ = (fall(thickness_m_) - whole) / (square[1] - square[0]);
  narrow_mpN_ = give_mpN[0] - plate_mpN(sigma_m[0], thickness_m_) - square_1pmN_ * square[0];
}

// The narrower patch's give, drawn towards the layer that the wider one tells as far as elements do not know better.
double WidthLaw::less_noise_mpN(const double (&give_mpN)[2], const double (&sigma_m)[2]) const {
  if (!(give_mpN[1] < 0)) return give_mpN[0];
  const double h = zero_thickness_m(sigma_m[0], [&](double at) { return layer_mpN(sigma_m[1], at) > give_mpN[1]; });
  const double plain = layer_mpN(sigma_m[0], h), more = give_mpN[0] - plain;
  const double noise = kNoise * half_space_mpN(sigma_m[0], modulus_Pa_);
  return plain + more * more * more / (more * more + noise * noise);
}

double WidthLaw::give_mpN(double sigma_m) const {
  const double curved = sigma_m > 0 ? curved_mpN_ * std::log(met_m_ / sigma_m) : 0;
  const double plain = square_1pmN_ * sigma_m * sigma_m + curved;
  if (kind_ == Kind::kLayer) return share_ * layer_mpN(sigma_m, thickness_m_) + plain;
  return narrow_mpN_ + plain + (kind_ == Kind::kPlate ? plate_mpN(sigma_m, thickness_m_) : 0.0);
}

namespace {

constexpr double kNearlyFlat = 1e-3;  // a / r below which a sphere is a paraboloid, to 1e-6

// g of the header: mean, over the principal directions in which the body bends away from the ball.
double bent_away(const BallLaw& ball) {
  double sum = 0;
  for (const double k_1pm : ball.principal_1pm) {
    const double x = ball.radius_m * std::max(k_1pm, 0.0);
    sum += 0.5 * x / (1 + 2 * x);
  }
  return sum;
}

// The profiles' shares: a sphere's by Segedin (1957), a paraboloid's by Hertz.
BallLaw::Point parabola_at(double curvature_1pm, double a, double modulus_Pa) {
  const double square = a * a * curvature_1pm;
  return {square, 4.0 / 3 * modulus_Pa * a * square, 4 * modulus_Pa * square};
}
BallLaw::Point sphere_at(double r, double a, double modulus_Pa) {
  const double log = std::log((r + a) / (r - a));
  return {0.5 * a * log, modulus_Pa * (0.5 * (a * a + r * r) * log - a * r),
          2 * modulus_Pa * a * (0.5 * log + a * r / (r * r - a * a))};
}

}  // namespace

double BallLaw::widest_m() const {
  return kWidest * (body_curvature_1pm == 0 ? radius_m : std::min(radius_m, 1 / std::abs(body_curvature_1pm)));
}

// What one profile dents and presses at a radius of contact, and another, stand beside one another: small strain.
BallLaw::Point BallLaw::at(double a_m) const {
  const double r = radius_m, a = a_m;
  Point sum = paraboloid ? parabola_at(1 / r, a, modulus_Pa) : sphere_at(r, a, modulus_Pa);
  if (body_curvature_1pm == 0) return sum;
  const Point body = std::abs(body_curvature_1pm) * a < kNearlyFlat ? parabola_at(body_curvature_1pm, a, modulus_Pa)
                                                                    : sphere_at(1 / body_curvature_1pm, a, modulus_Pa);
  return {sum.dent_m + body.dent_m, sum.force_N + body.force_N, sum.force_slope_Npm + body.force_slope_Npm};
}

// With eps = R (k1 - k2) / (2 + R (k1 + k2)), what the axes' curvatures differ by of their sum, force and dent of the
// ellipse (Johnson 1985, 4.2; by elliptic integrals) are those of a circle of (1 - 2/3 eps^2 - 0.15 eps^4) times the
// mean relative curvature: to 2.6e-3 of it as far as eps = 2/3.
double equal_sphere_1pm(const std::array<double, 2>& principal_1pm, double radius_m) {
  const double mean_1pm = 0.5 * (principal_1pm[0] + principal_1pm[1]), sum = 1 + mean_1pm * radius_m;
  if (!(radius_m > 0) || !(sum > 0)) return mean_1pm;
  const double eps = 0.5 * radius_m * (principal_1pm[0] - principal_1pm[1]) / sum;
  const double square = std::min(eps * eps, kMostElliptic);
  return (sum * (1 - square * (2.0 / 3 + 0.15 * square)) - 1) / radius_m;
}

double large_strain_factor(const BallLaw& ball, double narrow_mpN, double depth_m) {
  const double t = compressible_share(ball.poisson_ratio), x = std::sqrt(depth_m / ball.radius_m);
  const double curved = std::clamp(ball.body_curvature_1pm * ball.radius_m, -1.0, kMostCurved);
  const double near = std::max(-narrow_mpN, 0.0), z = near * hertz_factor(ball) * std::sqrt(depth_m);
  const double layer = 1 - 1 / (1 + z * (1.5 + 2.625 * z));
  const double away = kAway * t * std::sqrt(t) * bent_away(ball);
  return 1 + x * (t * (kInwards - away) + kIncompressible * (1 - curved) + kInwardsSquare * t * t * x) +
         std::max(kThinner * t - kWidening, 0.0) * layer * std::min(ball.modulus_Pa * near * depth_m, kMostThinned);
}

namespace {

// What the travel to first order in R has too much of a layer's force: header.
double too_stiff(const BallLaw& ball, const WidthLaw& width, double depth_m) {
  if (!width.is_layer()) return 1;
  const double share = std::min(depth_m / width.thickness_m(), kDeepestInLayer);
  return 1 + (kTooStiff - kTooStiffByShare * compressible_share(ball.poisson_ratio)) * share * share * share;
}

// What large strain adds to the force on a half space, as much of it as a plate with free faces has: header.
double on_plate(const BallLaw& ball, const WidthLaw& width, double added) {
  if (!width.is_plate()) return added;
  const double thin = kThickPlate * ball.radius_m / width.thickness_m(), square = thin * thin;
  return added / (1 + square * square);
}

// `x`, which ends at +-`most`: within 0.2 % as far as half of it.
double limited(double x, double most) {
  const double share = x / most, square = share * share;
  return x / std::pow(1 + square * square * square, 1.0 / 6);
}

// Force over depth as it is to be, c where positive left out.
struct Target {
  double depth_m, force_N;
};
std::vector<Target> targets(const BallLaw& ball, const WidthLaw& width, double c_mpN, double depth_max_m) {
  const double narrow = width.give_mpN(0), modes = narrow - std::min(c_mpN, 0.0);
  const auto more = [&](double a) { return width.give_mpN(std::sqrt(kHertzShare) * a) - modes; };
  std::vector<Target> out;
  for (int i = 1; i <= kFitPoints; ++i) {
    const double a = ball.widest_m() * i / kFitPoints, step = 1e-3 * a;
    const BallLaw::Point p = ball.at(a);
    const double slope = (more(a + step) - more(a - step)) / (2 * step);
    const double change = p.force_N * (more(a) + 0.5 * p.force_N * slope / p.force_slope_Npm);
    const double depth = p.dent_m + (width.is_layer() ? change : limited(change, kMostOfDent * p.dent_m));
    if (!(depth > (out.empty() ? 0.0 : out.back().depth_m))) continue;
    if (depth > depth_max_m && out.size() > 2) break;
    const double large = 1 + on_plate(ball, width, large_strain_factor(ball, narrow, depth) - 1);
    out.push_back({depth, p.force_N * large / too_stiff(ball, width, depth)});
  }
  return out;
}

// The tick's closed form beside the targets.
class ClosedForm {
 public:
  ClosedForm(const BallLaw& ball, double c_mpN, double depth_max_m)
      : ball_(ball), c_mpN_(c_mpN), depth_max_m_(depth_max_m) {
    flat_.body_curvature_1pm = 0;
    flat_.radius_m = ball.radius_m;
    flat_.modulus_Pa = ball.modulus_Pa;
    flat_.paraboloid = ball.paraboloid;
    scale_ = 1 / std::sqrt(sharper(ball.body_curvature_1pm, ball.radius_m));
    m_ = scale_ * hertz_factor(ball);
    by_beta_ = ball.radius_m * scale_ * scale_ * m_ * m_;
  }
  // beta of the least squares for one change of c, and what they leave, of the force.
  struct Left {
    double beta = 0, left = 0;
  };
  Left with(double more_mpN, const std::vector<Target>& targets) const {
    const double tick_c = c_mpN_ + more_mpN, rho = std::max(-tick_c, 0.0);
    const double in_series = std::max(c_mpN_, 0.0) - std::max(tick_c, 0.0);
    double above = 0, below = 0, square = 0;
    for (const Target& t : targets) {
      const double depth = std::max(t.depth_m + in_series * t.force_N, 0.0), root = std::sqrt(depth);
      const double z = rho * m_ * root, series = flat_N(depth) + m_ * depth * root * z * (1.5 + 2.625 * z);
      const double gain = by_beta_ * depth * depth * depth / t.force_N, off = (t.force_N - series) / t.force_N;
      // Deep places count more: there the closed form bends away from the travel, and there the error is the largest.
      above += depth * gain * off;
      below += depth * gain * gain;
      square += depth * off * off;
    }
    if (!(below > 0)) return {};
    const double root = std::sqrt(depth_max_m_), z = rho * m_ * root;
    // d/dD of f (1.5 + 3 z + 6.5625 z^2) / D + 3 beta R m^2 D^2.
    const double tangent = m_ * root * ((1 - kLeastTangent) * 1.5 + 3 * z + 6.5625 * z * z);
    const double beta = std::max(above / below, -tangent / (3 * by_beta_ * depth_max_m_ * depth_max_m_));
    return {beta, square - 2 * beta * above + beta * beta * below};
  }

 private:
  double flat_N(double depth_m) const {  // the tip's own law, scaled
    double low = 0, high = flat_.widest_m();
    for (int i = 0; i < 40; ++i) (flat_.at(0.5 * (low + high)).dent_m < depth_m ? low : high) = 0.5 * (low + high);
    return scale_ * flat_.at(low).force_N;
  }
  BallLaw ball_, flat_;
  double c_mpN_, depth_max_m_, scale_ = 1, m_ = 0, by_beta_ = 0;
};

}  // namespace

PlaceFit fit_place(const BallLaw& ball, const WidthLaw& width, double c_mpN, double depth_max_m) {
  const std::vector<Target> wanted = targets(ball, width, c_mpN, depth_max_m);
  const ClosedForm form(ball, c_mpN, depth_max_m);
  const double most = kMostGive / (ball.modulus_Pa * ball.radius_m), golden = 0.5 * (std::sqrt(5.0) - 1);
  double low = -most, high = most;
  for (int i = 0; i < 24; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (form.with(a, wanted).left < form.with(b, wanted).left)
      high = b;
    else
      low = a;
  }
  const double more = 0.5 * (low + high);
  return {more, form.with(more, wanted).beta};
}

}  // namespace palpate::elastic
