#include "sim_host/run/tick_fit.h"

#include <algorithm>
#include <cstdio>

#include "hal/loop/clock.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

// Instructions of a cold search per box or triangle looked at, the least of any shipped scene: then the time of one is
// overestimated rather than under (callgrind, gcc 12 -O3, 2026-11-22).
constexpr double kLookInstructions = 130;

// Points a hand's width around the surface.
std::int64_t search_around(const Model& model) {
  constexpr std::size_t kSearches = 1000;
  std::int64_t looked = 0;
  for (std::size_t i = 0; i < kSearches; ++i) {
    const std::size_t v = i * 7919 % model.vertex_m.size();
    const double height_m = 1e-3 * static_cast<double>(i % 11) - 3e-3;
    looked += closest_surface_point(model, model.vertex_m[v] + height_m * model.vertex_normal[v], kHuge, -1).looked;
  }
  return looked;
}

}  // namespace

double measure_instruction_ns(const Model& model) {
  const MonotonicClock clock;
  double fastest_ns = kHuge;
  for (int round = 0; round < 5; ++round) {
    const std::int64_t before_ns = clock.now_ns();
    const std::int64_t looked = search_around(model);
    const auto taken_ns = static_cast<double>(clock.now_ns() - before_ns);
    fastest_ns = std::min(fastest_ns, taken_ns / (kLookInstructions * static_cast<double>(looked)));
  }
  return fastest_ns;
}

std::string tick_fit_text(const TickFit& fit) {
  char text[200];
  std::snprintf(text, sizeof text,
                "worst tick: at most %.0f instructions, %.0f us on this machine, of %.0f us in a period%s",
                fit.instructions, 1e-3 * fit.worst_ns(), 1e6 * fit.period_s, fit.fits() ? "" : "; it may take 80 %");
  return text;
}

}  // namespace palpate
