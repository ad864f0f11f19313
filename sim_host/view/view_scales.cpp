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

const std::map<std::string, SurfaceColour>& surface_colours() {
  static const std::map<std::string, SurfaceColour> colours{{"displacement", SurfaceColour::kDisplacement},
                                                            {"pressure", SurfaceColour::kPressure},
                                                            {"stress", SurfaceColour::kStress}};
  return colours;
}

bool solves(const Model& model, SurfaceColour shown) {
  switch (shown) {
    case SurfaceColour::kDisplacement:
      return true;
    case SurfaceColour::kPressure:  // springs at tool points have a force, but no body under it that would spread it
      return method_of(model.params) != Method::kPoints;
    case SurfaceColour::kStress:
      return model.params.skeleton_law != SkeletonLaw::kNone && !model.anchor.empty();
  }
  return false;
}

const char* colour_meaning(const Model& model, SurfaceColour shown) {
  const Method method = method_of(model.params);
  if (!solves(model, shown)) return "not solved by this model";
  switch (shown) {
    case SurfaceColour::kDisplacement:
      return method == Method::kElastic || method == Method::kNodes ? "as solved" : "drawn shape";
    case SurfaceColour::kPressure:
      return method == Method::kNodes ? "nodal force by area" : "by the tip's profile";
    case SurfaceColour::kStress:
      return "at the anchors";
  }
  return "";
}

ColourScale colour_scale(SurfaceColour shown, double largest, bool fixed) {
  ColourScale scale;
  scale.shown = shown;
  double least = 1e-7;  // below it nothing is there, and the scale is one of its unit
  if (shown != SurfaceColour::kDisplacement) {
    const bool mega = largest >= 1e6, kilo = largest >= 1e3;
    scale.name = shown == SurfaceColour::kPressure ? "contact pressure" : "fibre stress";
    scale.unit = mega ? 1e6 : kilo ? 1e3 : 1;
    scale.unit_name = mega ? "MPa" : kilo ? "kPa" : "Pa";
    least = 1e-3;
  }
  const double top = largest > least ? largest / scale.unit : 1.0;
  scale.tick = axis_ticks(0, top, 4);
  std::vector<double>& tick = scale.tick;
  if (tick.size() > 1 && tick.back() < top * (1 - 1e-9) && !fixed)
    tick.push_back(2 * tick.back() - tick[tick.size() - 2]);
  scale.top = std::max(top, tick.back()) * scale.unit;
  return scale;
}

double surface_value(const DeformedSurface& surface, std::size_t vertex, SurfaceColour shown) {
  if (shown == SurfaceColour::kDisplacement) return norm(surface.displacement_m[vertex]);
  return shown == SurfaceColour::kPressure && vertex < surface.pressure_Pa.size() ? surface.pressure_Pa[vertex] : 0;
}

std::vector<double> drawn_values(const DeformedSurface& surface, const ColourScale& scale) {
  constexpr int kPasses = 80;  // over some nine edges; with 12 the line on ellipsoid_mallet was wavy
  const std::size_t vertices = surface.rest_m.size();
  std::vector<double> solved(vertices);
  for (std::size_t v = 0; v < vertices; ++v) solved[v] = surface_value(surface, v, scale.shown);
  std::vector<double> value = solved, sum(vertices), count(vertices);
  for (const std::array<std::int32_t, 3>& triangle : surface.triangle)
    for (const std::int32_t v : triangle) count[static_cast<std::size_t>(v)] += 1;
  const double most = kEvenShare * scale.top;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::ranges::fill(sum, 0.0);
    for (const std::array<std::int32_t, 3>& triangle : surface.triangle) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(triangle[k]), next = static_cast<std::size_t>(triangle[(k + 1) % 3]);
        sum[v] += value[next];  // the other way in the triangle beside
      }
    }
    for (std::size_t v = 0; v < vertices; ++v)
      if (count[v] > 0) value[v] = std::clamp(0.5 * (value[v] + sum[v] / count[v]), solved[v] - most, solved[v] + most);
  }
  return value;
}

double largest_value(const DeformedSurface& surface, const AnchorField& anchors, SurfaceColour shown) {
  double largest = 0;
  for (std::int32_t a = 0; shown == SurfaceColour::kStress && a < anchors.count; ++a)
    largest = std::max(largest, anchors.anchor[a].stress_Pa);
  for (std::size_t v = 0; v < surface.rest_m.size(); ++v) largest = std::max(largest, surface_value(surface, v, shown));
  return largest;
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
