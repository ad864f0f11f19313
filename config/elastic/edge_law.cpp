#include "config/elastic/edge_law.h"

#include <algorithm>
#include <cmath>

#include "rt_core/contact/elastic/ball_on_body.h"

namespace palpate::elastic {

namespace {

constexpr double kLeastShare = 0.05;
constexpr int kDepths = 12, kScales = 64;
constexpr double kLeastScale = 0.25;
static_assert(kLeastScale * kLeastScale * kMostSharper == 1, "the least scale that the tick's law has");

// Of the ball on the curved body.
double effective_radius_m(const BallLaw& ball) {
  return ball.radius_m / sharper(ball.body_curvature_1pm, ball.radius_m);
}

}  // namespace

double edge_share(const SharpEdge& edge, const BallLaw& ball, double depth_m) {
  const double nu = ball.poisson_ratio, compressible = (1 - 2 * nu) / (1 - nu);
  const double w = 1 - edge.opening_rad / std::numbers::pi;
  if (!(w > 0)) return 1;
  const double radius = effective_radius_m(ball), t = edge.distance_m / std::sqrt(radius * depth_m);
  const double along = t * std::exp(6.8 * (0.5 - w));
  const double flat = 0.2924 + 0.1491 * compressible +
                      (0.2912 - 0.1686 * compressible) * std::min(std::sqrt(depth_m / ball.radius_m), 0.7);
  const double loss = (1 - flat) * (0.9 * w + 0.55 * w * w) / 0.5875;
  const double fades = 1 + (0.4585 + 0.1874 * compressible) * along + (0.3074 + 0.2126 * compressible) * along * along;
  return std::max(1 - loss / fades, kLeastShare);
}

EdgeFit fit_edge(const SharpEdge& edge, double told_m, const BallLaw& ball, double depth_max_m, EdgeForm form) {
  if (edge.distance_m >= told_m) return {};
  const SharpEdge told{told_m, edge.opening_rad};
  const double factor = 4.0 / 3 * ball.modulus_Pa * std::sqrt(effective_radius_m(ball));
  double depth[kDepths], force[kDepths];
  for (int i = 0; i < kDepths; ++i) {
    depth[i] = depth_max_m * (i + 1) / kDepths;
    force[i] =
        factor * depth[i] * std::sqrt(depth[i]) * edge_share(edge, ball, depth[i]) / edge_share(told, ball, depth[i]);
  }
  EdgeFit best;
  double least = 1e300;
  for (int k = form == EdgeForm::kScaled ? 0 : kScales; k <= kScales; ++k) {
    EdgeFit fit;
    fit.scale = kLeastScale + (1 - kLeastScale) * k / kScales;
    double above = 0, below = 0, left = 0;
    const auto missing = [&](int i) { return depth[i] - std::pow(force[i] / (fit.scale * factor), 2.0 / 3); };
    for (int i = 0; i < kDepths; ++i) {
      const double f = force[i] / depth[i];
      above += missing(i) / depth[i] * f;
      below += f * f;
    }
    fit.give_mpN = std::max(above / below, 0.0);
    for (int i = 0; i < kDepths; ++i) {
      const double off = (missing(i) - fit.give_mpN * force[i]) / depth[i];
      left += off * off;
    }
    if (!(left < least)) continue;
    least = left;
    best = fit;
  }
  return best;
}

}  // namespace palpate::elastic
