#include "sim_host/viewer/plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim_host/view/plot.h"

namespace palpate {

namespace {

// Where a plot stands, and its axes.
struct Frame {
  ImDrawList* list;
  ImVec2 low, high;  // of the data's area, left top to right bottom
  float text;        // size of small text
};

void small_text(const Frame& frame, ImVec2 at, Colour c, const std::string& text) {
  frame.list->AddText(ImGui::GetFont(), frame.text, at, packed(c), text.c_str());
}
float width_of(const Frame& frame, const std::string& text) {
  return ImGui::GetFont()->CalcTextSizeA(frame.text, 1e9f, 0, text.c_str()).x;
}

Frame begin(const char* title, float height) {
  Frame frame;
  frame.list = ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeight();
  frame.text = 0.82f * ImGui::GetFontSize();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::Dummy({width, height});
  frame.list->AddText(at, packed(theme::kInk), title);
  frame.low = {at.x + 2.4f * line, at.y + 1.35f * line};
  frame.high = {at.x + width - 0.2f * line, at.y + height - 1.15f * line};
  frame.list->AddRectFilled(frame.low, frame.high, packed(theme::kWell));
  return frame;
}

// What stands at the lower and the upper edge.
struct Values {
  double bottom, top;
};
float height_of(const Frame& frame, const Values& values, double value) {
  const double share = (value - values.bottom) / (values.top - values.bottom);
  return frame.high.y - static_cast<float>(share) * (frame.high.y - frame.low.y);
}

void value_axis(const Frame& frame, const Values& values) {
  float last = 1e9f;  // of the labels, from the foot: where a plot is low, not every line has one
  for (const double value : axis_ticks(values.bottom, values.top, 3)) {
    const float y = height_of(frame, values, value);
    frame.list->AddLine({frame.low.x, y}, {frame.high.x, y}, packed(theme::kLine));
    if (last - y < frame.text) continue;
    last = y;
    const std::string label = tick_label(value);
    small_text(frame, {frame.low.x - width_of(frame, label) - 5, y - 0.55f * frame.text}, theme::kGrey, label);
  }
}

// A label of the axis below, not beyond its end.
void below(const Frame& frame, float x, const std::string& label) {
  const float width = width_of(frame, label);
  small_text(frame, {std::min(x - 0.5f * width, frame.high.x - width), frame.high.y + 3}, theme::kGrey, label);
}

// At the right of the title, the last line rightmost.
void legend(const Frame& frame, std::span<const PlotLine> lines) {
  float x = frame.high.x;
  const float y = frame.low.y - 1.2f * frame.text;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    x -= width_of(frame, line->name);
    small_text(frame, {x, y}, theme::kGrey, line->name);
    x -= 20;
    frame.list->AddLine({x, y + 0.55f * frame.text}, {x + 14, y + 0.55f * frame.text}, packed(line->colour), 2.2f);
    x -= 12;
  }
}

// Broken where a column holds nothing (not-a-number).
void draw_line(const Frame& frame, const PlotLine& line, const Values& values) {
  const auto at = [&](std::size_t column, float value) {
    const float share = (static_cast<float>(column) + 0.5f) / static_cast<float>(line.columns.size());
    return ImVec2{frame.low.x + share * (frame.high.x - frame.low.x),
                  height_of(frame, values, static_cast<double>(value))};
  };
  std::vector<ImVec2> points;
  const auto stroke = [&] {
    frame.list->AddPolyline(points.data(), static_cast<int>(points.size()), packed(line.colour, line.opacity), 0,
                            line.width);
    points.clear();
  };
  for (std::size_t c = 0; c < line.columns.size(); ++c) {
    const auto [low, high] = line.columns[c];
    if (std::isnan(low)) {
      stroke();
      continue;
    }
    const bool falls = !points.empty() && line.columns[c - 1].high > high;
    points.push_back(at(c, falls ? high : low));
    if (high > low) points.push_back(at(c, falls ? low : high));
  }
  stroke();
}

}  // namespace

void history_plot(const char* title, const char* unit, std::span<const PlotLine> lines, double from_s, double until_s,
                  double now_s, float height) {
  const Frame frame = begin(fmt::format("{} ({})", title, unit).c_str(), height);
  legend(frame, lines);
  float largest = 0, least = 0;
  for (const PlotLine& line : lines)
    for (const auto& range : line.columns) largest = std::max(largest, range.high), least = std::min(least, range.low);
  const bool flat = !(largest - least > 1e-9f);
  const Values values{1.08 * static_cast<double>(least), flat ? 1 : 1.08 * static_cast<double>(largest)};
  value_axis(frame, values);
  const auto x_of = [&](double time_s) {
    return frame.low.x + static_cast<float>((time_s - from_s) / (until_s - from_s)) * (frame.high.x - frame.low.x);
  };
  for (const double time_s : axis_ticks(from_s, until_s, 5)) {
    const std::string label = tick_label(time_s) + (time_s == from_s ? "" : " s");
    below(frame, x_of(time_s), label);
  }
  frame.list->PushClipRect(frame.low, frame.high, true);
  for (const PlotLine& line : lines)
    if (line.columns.size() > 1) draw_line(frame, line, values);
  frame.list->PopClipRect();
  if (now_s >= from_s && now_s <= until_s)
    frame.list->AddLine({x_of(now_s), frame.low.y}, {x_of(now_s), frame.high.y}, packed(theme::kInk, 0.7f), 1.2f);
}

void duration_plot(const char* title, const Histogram& histogram, double period_s, float height) {
  const Frame frame = begin(title, height);
  // From a tenth of a microsecond to the period and beyond, in bars of a sixteenth of a decade.
  constexpr double kLow_ns = 100, kPerDecade = 16;
  const double decades = std::max(4.0, std::ceil(std::log10(1e9 * period_s / kLow_ns)));
  std::vector<double> bar(static_cast<std::size_t>(decades * kPerDecade));
  const auto place = [&](double ns) { return std::log10(std::max(ns, kLow_ns) / kLow_ns) / decades; };
  for (std::int32_t b = 0; b < kHistogramBuckets; ++b) {
    const double share = place(static_cast<double>(bucket_start_ns(b)));
    const auto i = std::min(bar.size() - 1, static_cast<std::size_t>(share * static_cast<double>(bar.size())));
    bar[i] += histogram.count[b];
  }
  const double top = std::log10(1 + *std::ranges::max_element(bar));
  const float width = frame.high.x - frame.low.x;
  const auto x_of = [&](double ns) { return frame.low.x + static_cast<float>(std::min(1.0, place(ns))) * width; };
  for (std::size_t i = 0; i < bar.size() && top > 0; ++i) {
    if (bar[i] <= 0) continue;
    const auto share = static_cast<float>(std::log10(1 + bar[i]) / top);
    const float x = frame.low.x + width * static_cast<float>(i) / static_cast<float>(bar.size());
    frame.list->AddRectFilled({x, frame.high.y - 0.95f * share * (frame.high.y - frame.low.y)},
                              {x + width / static_cast<float>(bar.size()) - 1, frame.high.y},
                              packed(theme::kForce, 0.8f));
  }
  for (double ns = kLow_ns; place(ns) <= 1; ns *= 10) {
    const std::string label = ns < 1e6 ? tick_label(1e-3 * ns) : tick_label(1e-6 * ns) + " ms";
    below(frame, x_of(ns), label);
  }
  const auto mark = [&](double ns, Colour c) {
    frame.list->AddLine({x_of(ns), frame.low.y}, {x_of(ns), frame.high.y}, packed(c), 1.6f);
  };
  mark(static_cast<double>(percentile_ns(histogram, 0.999)), theme::kWarning);
  mark(static_cast<double>(histogram.max_ns), theme::kFault);
  mark(1e9 * period_s, theme::kInk);
}

}  // namespace palpate
