// Small plots drawn into a panel: a history over time, a histogram of durations.
#pragma once

#include <imgui.h>

#include <span>
#include <string>

#include "sim_host/view/run_track.h"
#include "sim_host/viewer/theme.h"

namespace palpate {

inline ImU32 packed(Colour c, float opacity = 1) { return ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, opacity}); }

struct PlotLine {
  const char* name;
  Colour colour;
  std::span<const TrackColumns::Range> columns;
  float width = 1.7f, opacity = 1;
};

// Takes `height` of the current window's width. Times in seconds; `now_s` is marked.
void history_plot(const char* title, const char* unit, std::span<const PlotLine> lines, double from_s, double until_s,
                  double now_s, float height);
// Counts over duration, both axes logarithmic, with the 99.9 % and the maximum marked.
void duration_plot(const char* title, const Histogram& histogram, double period_s, float height);

}  // namespace palpate
