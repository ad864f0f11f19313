#include "sim_host/view/view_scales.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim_host/view/plot.h"

namespace palpate {

double round_below(double most) {
  if (!(most > 0 && most < 1e300)) return 0;
  const double decade = std::pow(10.0, std::floor(std::log10(most)));
  double best = decade;
  for (const double step : {1.0, 2.0, 5.0, 10.0})
    if (step * decade <= most * (1 + 1e-12)) best = step * decade;
  return best;
}

DisplacementScale displacement_scale(double largest_m, bool fixed) {
  const double top_mm = largest_m > 1e-7 ? largest_m * 1e3 : 1.0;
  DisplacementScale scale;
  scale.tick_mm = axis_ticks(0, top_mm, 4);
  std::vector<double>& tick = scale.tick_mm;
  if (tick.size() > 1 && tick.back() < top_mm * (1 - 1e-9) && !fixed)
    tick.push_back(2 * tick.back() - tick[tick.size() - 2]);
  scale.top_m = std::max(top_mm, tick.back()) * 1e-3;
  return scale;
}

ForceScale force_scale(double largest_N, double body_size_m) {
  constexpr double kLongest = 0.45, kLegend = 0.15;  // shares of the body's extent
  if (!(largest_N > 1e-6)) largest_N = 1;
  ForceScale scale;
  scale.m_per_N = kLongest * body_size_m / largest_N;
  scale.reference_N = round_below(kLegend / kLongest * largest_N);
  return scale;
}

ForceSum force_sum(const State& state) {
  ForceSum sum;
  for (const Region& region : state.region) {
    if (region.id == 0 || region.lost_ticks > 0) continue;
    const Vec3 force_N = state.live.stiffness * region.wrench_w.force_N;
    sum.sum_N += force_N;
    sum.largest_N = std::max(sum.largest_N, norm(force_N));
    sum.depth_m = std::max(sum.depth_m, region.depth_max_m);
    ++sum.regions;
  }
  return sum;
}

std::string force_words(const ForceSum& sum) {
  if (sum.regions == 0) return "no contact";
  const double force_N = norm(sum.sum_N);
  if (sum.regions == 1) return fmt::format("|F| = {:.2f} N", force_N);
  return fmt::format("|sum of {} forces| = {:.2f} N, largest {:.2f} N", sum.regions, force_N, sum.largest_N);
}

const char* colour_meaning(const Model& model) {
  const Method method = method_of(model.params);
  return method == Method::kElastic || method == Method::kNodes ? "as solved" : "drawn shape";
}

std::vector<DrawnForce> drawn_forces(const State& state) {
  std::vector<DrawnForce> forces;
  for (const Region& region : state.region) {
    if (region.id == 0 || region.lost_ticks > 0) continue;
    const double unit_N = state.live.stiffness;
    forces.push_back({region.centre_w, unit_N * region.wrench_w.force_N, unit_N * region.friction_force_w});
  }
  const auto size = [](const DrawnForce& force) { return norm(force.force_N); };
  std::ranges::sort(forces, std::greater{}, size);
  const double least_N = forces.empty() ? 0 : 0.01 * size(forces.front());
  std::erase_if(forces, [&](const DrawnForce& force) { return !(size(force) > least_N); });
  return forces;
}

}  // namespace palpate
