// The two plots of a run: force history and latency histogram.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "rt_core/vec.h"
#include "sim_host/latency/histogram.h"
#include "sim_host/view/drawing.h"

namespace palpate {

struct ForceSample {
  double time_s = 0;
  Vec3 force_N;  // on the tool, world frame
  double penetration_m = 0;
  int regions = 0;
};

// Force components and magnitude, penetration, and number of contact regions over time. Long histories are reduced to
// the extremes of each pixel column, so no peak is lost.
Drawing force_history_plot(std::span<const ForceSample> samples, const std::string& title);

struct LatencySeries {
  std::string name;  // for the legend, which adds median, 99.9 % and maximum
  const Histogram* histogram = nullptr;
};

// Counts over duration, both axes logarithmic, a vertical tick at each series' maximum.
Drawing latency_plot(std::span<const LatencySeries> series, const std::string& title);

// Round steps for an axis from `low` to `high` with about `wanted` ticks: 1, 2 or 5 times a power of ten.
std::vector<double> axis_ticks(double low, double high, int wanted);
// A tick's label without superfluous digits.
std::string tick_label(double value);

}  // namespace palpate
