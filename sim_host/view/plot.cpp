#include "sim_host/view/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace palpate {

namespace {

constexpr Colour kInk = colour(0x1f2933), kFaint = colour(0xdde2e8), kGrey = colour(0x66717d);
constexpr Colour kSeries[] = {colour(0xd1495b), colour(0x2e9e6b), colour(0x2f6fb2), colour(0x22262b),
                              colour(0xe08e2b), colour(0x7d5ba6), colour(0x3aa6a6), colour(0x8a6d3b)};
constexpr double kWidth = 1000, kLeft = 78, kRight = 24;

// A rectangle of the page with data ranges: maps data to page coordinates.
struct Panel {
  double left, top, width, height;
  double x_low, x_high, y_low, y_high;
  double x(double v) const { return left + width * (v - x_low) / (x_high - x_low); }
  double y(double v) const { return top + height * (1 - (v - y_low) / (y_high - y_low)); }
};

void draw_grid(Drawing& drawing, const Panel& panel, const std::vector<double>& x_ticks,
               const std::vector<double>& y_ticks, const std::string& y_title) {
  for (const double v : x_ticks) {
    drawing.line({{panel.x(v), panel.top}, {panel.x(v), panel.top + panel.height}}, 0.8, kFaint);
  }
  for (const double v : y_ticks) {
    drawing.line({{panel.left, panel.y(v)}, {panel.left + panel.width, panel.y(v)}}, 0.8, kFaint);
    drawing.text(panel.left - 8, panel.y(v) + 4, tick_label(v), 12, kGrey, Align::kEnd);
  }
  drawing.text(22, panel.top + panel.height / 2, y_title, 13, kInk, Align::kMiddle, true);
  drawing.line({{panel.left, panel.top}, {panel.left, panel.top + panel.height}}, 1.2, kInk);
  drawing.line({{panel.left, panel.top + panel.height}, {panel.left + panel.width, panel.top + panel.height}}, 1.2,
               kInk);
}

void draw_x_labels(Drawing& drawing, const Panel& panel, const std::vector<double>& ticks, const std::string& title) {
  const double bottom = panel.top + panel.height;
  for (const double v : ticks) drawing.text(panel.x(v), bottom + 18, tick_label(v), 12, kGrey, Align::kMiddle);
  drawing.text(panel.left + panel.width / 2, bottom + 40, title, 13, kInk, Align::kMiddle);
}

struct LegendEntry {
  std::string name;
  Colour c;
};

void draw_legend(Drawing& drawing, double right, double baseline, std::span<const LegendEntry> entries) {
  double x = right;
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
    x -= text_width(entry->name, 13);
    drawing.text(x, baseline, entry->name, 13, kInk);
    drawing.line({{x - 26, baseline - 4.5}, {x - 8, baseline - 4.5}}, 3, entry->c);
    x -= 46;
  }
}

using Value = std::function<double(const ForceSample&)>;

// A line through the samples; where several fall on one pixel column, through their first, extremes and last.
Stroke trace(std::span<const ForceSample> samples, const Panel& panel, const Value& value) {
  Stroke line;
  for (std::size_t i = 0; i < samples.size();) {
    const double column = std::floor(panel.x(samples[i].time_s));
    std::size_t low = i, high = i, last = i;
    for (; last < samples.size() && std::floor(panel.x(samples[last].time_s)) == column; ++last) {
      if (value(samples[last]) < value(samples[low])) low = last;
      if (value(samples[last]) > value(samples[high])) high = last;
    }
    std::size_t keep[] = {i, std::min(low, high), std::max(low, high), last - 1};
    std::size_t previous = samples.size();
    for (const std::size_t k : keep) {
      if (k != previous) line.push_back({panel.x(samples[k].time_s), panel.y(value(samples[k]))});
      previous = k;
    }
    i = std::max(last, i + 1);
  }
  return line;
}

struct Range {
  double low, high;
};
Range range_of(std::span<const ForceSample> samples, std::span<const Value> values) {
  Range range{0, 0};
  for (const ForceSample& sample : samples) {
    for (const Value& value : values) {
      range.low = std::min(range.low, value(sample)), range.high = std::max(range.high, value(sample));
    }
  }
  if (!(range.high - range.low > 1e-9)) range.high = range.low + 1;
  const double room = 0.06 * (range.high - range.low);
  return {range.low < 0 ? range.low - room : 0, range.high + room};
}

void draw_regions(Drawing& drawing, const Panel& panel, std::span<const ForceSample> samples) {
  Stroke steps;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0 && i + 1 < samples.size() && samples[i].regions == samples[i - 1].regions) continue;
    const double x = panel.x(samples[i].time_s);
    if (i > 0) steps.push_back({x, panel.y(samples[i - 1].regions)});
    steps.push_back({x, panel.y(samples[i].regions)});
  }
  drawing.line(std::move(steps), 2, kSeries[4]);
}

}  // namespace

std::vector<double> axis_ticks(double low, double high, int wanted) {
  if (!(high > low) || wanted < 1) return {low};
  const double raw = (high - low) / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double step = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : raw / power < 7.5 ? 5 : 10);
  std::vector<double> ticks;
  const double first = std::ceil(low / step - 1e-9);
  for (int k = 0; k <= 10 * wanted && (first + k) * step <= high + 1e-9 * step; ++k)
    ticks.push_back((first + k) * step);
  return ticks;
}

std::string tick_label(double value) {
  const std::string text = fmt::format("{:.6g}", value);
  return text == "-0" ? "0" : text;
}

Drawing force_history_plot(std::span<const ForceSample> samples, const std::string& title) {
  Drawing drawing(kWidth, 660);
  drawing.text(kLeft, 32, title, 18, kInk, Align::kStart, false, true);
  const double t0 = samples.empty() ? 0 : samples.front().time_s;
  const double t1 = samples.size() < 2 ? t0 + 1 : std::max(samples.back().time_s, t0 + 1e-9);
  const Value values[] = {
      [](const ForceSample& s) { return s.force_N.x; }, [](const ForceSample& s) { return s.force_N.y; },
      [](const ForceSample& s) { return s.force_N.z; }, [](const ForceSample& s) { return norm(s.force_N); }};
  const Value depth = [](const ForceSample& s) { return s.penetration_m * 1e3; };
  const Range force = range_of(samples, values), mm = range_of(samples, std::span<const Value>(&depth, 1));
  int most_regions = 1;
  for (const ForceSample& s : samples) most_regions = std::max(most_regions, s.regions);

  const double width = kWidth - kLeft - kRight;
  const Panel top{kLeft, 56, width, 270, t0, t1, force.low, force.high};
  const Panel middle{kLeft, 356, width, 130, t0, t1, 0, mm.high};
  const Panel bottom{kLeft, 516, width, 80, t0, t1, 0, most_regions + 0.5};
  const std::vector<double> times = axis_ticks(t0, t1, 10);
  draw_grid(drawing, top, times, axis_ticks(force.low, force.high, 6), "force on tool (N)");
  draw_grid(drawing, middle, times, axis_ticks(0, mm.high, 4), "depth (mm)");
  draw_grid(drawing, bottom, times, axis_ticks(0, most_regions, std::min(most_regions, 4)), "regions");
  draw_x_labels(drawing, bottom, times, "time (s)");
  const LegendEntry legend[] = {
      {"Fx", kSeries[0]}, {"Fy", kSeries[1]}, {"Fz", kSeries[2]}, {"|F|", kSeries[3]}, {"depth", kSeries[5]}};
  draw_legend(drawing, kWidth - kRight, 32, legend);
  if (samples.empty()) return drawing;
  drawing.line({{top.x(t0), top.y(0)}, {top.x(t1), top.y(0)}}, 1, kGrey);
  for (int k : {3, 0, 1, 2})
    drawing.line(trace(samples, top, values[k]), k == 3 ? 2.6 : 1.6, kSeries[k], k == 3 ? 0.85 : 1);
  drawing.line(trace(samples, middle, depth), 1.8, kSeries[5]);
  draw_regions(drawing, bottom, samples);
  return drawing;
}

namespace {

std::string duration_text(std::int64_t ns) {
  return ns < 10'000 ? fmt::format("{:.2f} µs", static_cast<double>(ns) * 1e-3)
                     : fmt::format("{:.0f} µs", static_cast<double>(ns) * 1e-3);
}

// Counts per visible column (20 per decade), as a stepped outline that returns to zero.
Stroke outline(const Histogram& histogram, const Panel& panel) {
  constexpr int kColumnsPerDecade = 20;
  std::vector<double> columns;
  for (std::int32_t bucket = 0; bucket < kHistogramBuckets; ++bucket) {
    if (histogram.count[bucket] == 0) continue;
    const double us = static_cast<double>(std::max<std::int64_t>(bucket_start_ns(bucket), 1)) * 1e-3;
    const double place = (std::log10(us) - panel.x_low) * kColumnsPerDecade;
    const auto column = static_cast<std::size_t>(std::max(0.0, place));
    if (columns.size() <= column) columns.resize(column + 1, 0.0);
    columns[column] += histogram.count[bucket];
  }
  columns.push_back(0);
  Stroke line;
  double previous = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const double value = columns[c] > 0 ? std::log10(columns[c]) + 0.12 : 0.0;  // one count stands above the axis
    const double x = panel.x(panel.x_low + static_cast<double>(c) / kColumnsPerDecade);
    if (value == previous) continue;
    line.push_back({x, panel.y(previous)});
    line.push_back({x, panel.y(value)});
    previous = value;
  }
  return line;
}

}  // namespace

Drawing latency_plot(std::span<const LatencySeries> series, const std::string& title) {
  static constexpr std::size_t kOrder[] = {2, 4, 6, 0, 3, 5, 1, 7};  // neighbours differ most
  Drawing drawing(kWidth, 460 + 22 * static_cast<double>(series.size()));
  drawing.text(kLeft, 32, title, 18, kInk, Align::kStart, false, true);
  double largest_us = 10, smallest_us = 10, most = 10;
  for (const LatencySeries& s : series) {
    if (s.histogram->total == 0) continue;
    largest_us = std::max(largest_us, static_cast<double>(s.histogram->max_ns) * 1e-3);
    smallest_us = std::min(smallest_us, std::max(0.01, static_cast<double>(s.histogram->min_ns) * 1e-3));
    most = std::max(most, static_cast<double>(s.histogram->total));
  }
  const double x_low = std::floor(std::log10(smallest_us)), x_high = std::ceil(std::log10(largest_us * 1.05));
  const double legend_height = 22 * static_cast<double>(series.size());
  const Panel panel{
      kLeft, 56 + legend_height, kWidth - kLeft - kRight, 330, x_low, x_high, 0, std::ceil(std::log10(most)) + 0.2};
  const auto decades = [&drawing, &panel](bool horizontal, double low, double high) {
    for (double d = low; d <= high; d += 1) {
      const std::string label =
          d < 0 ? fmt::format("{:g}", std::pow(10.0, d)) : fmt::format("{:.0f}", std::pow(10.0, d));
      const double x = panel.x(d), y = panel.y(d);
      if (horizontal) {
        drawing.line({{x, panel.top}, {x, panel.top + panel.height}}, 0.8, kFaint);
        drawing.text(x, panel.top + panel.height + 18, label, 12, kGrey, Align::kMiddle);
      } else {
        drawing.line({{panel.left, y}, {panel.left + panel.width, y}}, 0.8, kFaint);
        drawing.text(panel.left - 8, y + 4, label, 12, kGrey, Align::kEnd);
      }
    }
  };
  decades(true, x_low, x_high);
  decades(false, 0, std::floor(panel.y_high));
  draw_grid(drawing, panel, {}, {}, "number of ticks");
  draw_x_labels(drawing, panel, {}, "duration (µs)");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const Histogram& h = *series[i].histogram;
    const Colour c = kSeries[kOrder[i % std::size(kOrder)]];
    const double row = 60 + 22 * static_cast<double>(i);
    drawing.line({{kLeft, row - 4.5}, {kLeft + 20, row - 4.5}}, 3.5, c);
    drawing.text(kLeft + 30, row, series[i].name, 13, kInk);
    const std::string numbers[] = {"median " + duration_text(percentile_ns(h, 0.5)),
                                   "99.9 % " + duration_text(percentile_ns(h, 0.999)),
                                   "max " + duration_text(h.max_ns)};
    for (int k = 0; k < 3; ++k) drawing.text(kLeft + 300 + 170 * k, row, numbers[k], 13, kGrey);
    if (h.total == 0) continue;
    drawing.line(outline(h, panel), 2, c);
    const double x = panel.x(std::log10(std::max(1e-3, static_cast<double>(h.max_ns) * 1e-3)));
    drawing.line({{x, panel.top + panel.height - 16}, {x, panel.top + panel.height}}, 3.5, c);
  }
  return drawing;
}

}  // namespace palpate
