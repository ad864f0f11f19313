#include "sim_host/view/line_plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim_host/view/plot.h"

namespace palpate {

namespace {

constexpr Colour kInk = colour(0x1f2933), kFaint = colour(0xdde2e8), kGrey = colour(0x66717d);
constexpr std::array kSeries{colour(0xd1495b), colour(0x2e9e6b), colour(0x2f6fb2), colour(0x22262b),
                             colour(0xe08e2b), colour(0x7d5ba6), colour(0x3aa6a6), colour(0x8a6d3b)};
constexpr double kWidth = 900, kHeight = 560, kLeft = 84, kTop = 60, kBottom = 70;
constexpr double kLegendGap = 24, kLegendKey = 30, kLegendRow = 24, kLegendSize = 13;

// Data ranges and the right end of the plot, beyond which the legend stands.
struct Axes {
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1, right = kWidth;
  double x(double v) const { return kLeft + (right - kLeft) * (v - x_low) / (x_high - x_low); }
  double y(double v) const { return kHeight - kBottom - (kHeight - kTop - kBottom) * (v - y_low) / (y_high - y_low); }
};

Axes axes_of(const std::vector<PlotCurve>& curves) {
  Axes axes{1e300, -1e300, 0, 0, 0};
  double legend = 0;
  for (const PlotCurve& curve : curves) {
    legend = std::max(legend, text_width(curve.name, kLegendSize));
    for (const double x : curve.x) axes.x_low = std::min(axes.x_low, x), axes.x_high = std::max(axes.x_high, x);
    for (const double y : curve.y) axes.y_low = std::min(axes.y_low, y), axes.y_high = std::max(axes.y_high, y);
  }
  if (!(axes.x_high > axes.x_low)) axes.x_low -= 0.5, axes.x_high = axes.x_low + 1;
  if (!(axes.y_high > axes.y_low)) axes.y_high = axes.y_low + 1;
  axes.right = kWidth - kLegendGap - kLegendKey - legend - 20;
  axes.y_high += 0.06 * (axes.y_high - axes.y_low);
  return axes;
}

void draw_axes(Drawing& drawing, const Axes& axes, const PlotText& text) {
  const double bottom = axes.y(axes.y_low);
  for (const double v : axis_ticks(axes.x_low, axes.x_high, 8)) {
    drawing.line({{axes.x(v), kTop}, {axes.x(v), bottom}}, 0.8, kFaint);
    drawing.text(axes.x(v), bottom + 18, tick_label(v), 12, kGrey, Align::kMiddle);
  }
  for (const double v : axis_ticks(axes.y_low, axes.y_high, 6)) {
    drawing.line({{kLeft, axes.y(v)}, {axes.right, axes.y(v)}}, 0.8, kFaint);
    drawing.text(kLeft - 8, axes.y(v) + 4, tick_label(v), 12, kGrey, Align::kEnd);
  }
  drawing.line({{kLeft, kTop}, {kLeft, bottom}, {axes.right, bottom}}, 1.2, kInk);
  drawing.text(kLeft + 0.5 * (axes.right - kLeft), bottom + 42, text.x_title, 13, kInk, Align::kMiddle);
  drawing.text(24, 0.5 * (kTop + bottom), text.y_title, 13, kInk, Align::kMiddle, true);
  drawing.text(kLeft, 32, text.title, 18, kInk, Align::kStart, false, true);
}

// Whether `b` lies on `a`, to a line's width: as for two anchors that are mirror images of one another.
bool hides(const Stroke& a, const Stroke& b) {
  const auto near = [](const Point2& p, const Point2& q) { return std::hypot(p.x - q.x, p.y - q.y) < 1.5; };
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), near);
}

// The dashes of a line, so that what lies below it shows in the gaps.
std::vector<Stroke> dashes(const Stroke& line) {
  constexpr double kDash = 9;
  std::vector<Stroke> all;
  double left = kDash;
  bool drawn = true;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    Point2 from = line[i];
    const Point2 to = line[i + 1];
    for (double length = std::hypot(to.x - from.x, to.y - from.y); length > 0;) {  // to the end of this segment
      const double step = std::min(left, length);
      const Point2 end{from.x + (to.x - from.x) * step / length, from.y + (to.y - from.y) * step / length};
      if (drawn) all.push_back({from, end});
      from = end, length -= step, left -= step;
      if (left <= 0) left = kDash, drawn = !drawn;
    }
  }
  return all;
}

void draw_legend(Drawing& drawing, double right, std::size_t row, const std::string& name, Colour c) {
  const double x = right + kLegendGap, y = kTop + 14 + kLegendRow * static_cast<double>(row);
  drawing.line({{x, y - 4}, {x + 20, y - 4}}, 3, c);
  drawing.text(x + kLegendKey, y, name, kLegendSize, kInk);
}

}  // namespace

Drawing line_plot(const std::vector<PlotCurve>& curves, const PlotText& text, bool marks) {
  Drawing drawing(kWidth, kHeight);
  const Axes axes = axes_of(curves);
  draw_axes(drawing, axes, text);
  std::vector<Stroke> drawn;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const Colour c = kSeries[k % kSeries.size()];
    Stroke line;
    for (std::size_t i = 0; i < curves[k].x.size(); ++i) {
      const Point2 at{axes.x(curves[k].x[i]), axes.y(curves[k].y[i])};
      line.push_back(at);
      if (marks) drawing.rectangle(at.x - 4, at.y - 4, 8, 8, c);
    }
    if (std::ranges::any_of(drawn, [&](const Stroke& other) { return hides(other, line); })) {
      for (Stroke& dash : dashes(line)) drawing.line(std::move(dash), 2, c);
    } else {
      drawing.line(line, 2, c);
    }
    drawn.push_back(std::move(line));
    draw_legend(drawing, axes.right, k, curves[k].name, c);
  }
  return drawing;
}

Drawing bar_plot(const std::vector<PlotCurve>& series, const PlotText& text) {
  constexpr double kFilled = 0.76;  // of the way from one group to the next
  Drawing drawing(kWidth, kHeight);
  Axes axes = axes_of(series);
  axes.x_low -= 0.5, axes.x_high += 0.5;
  draw_axes(drawing, axes, text);
  const double width = kFilled / static_cast<double>(std::max<std::size_t>(1, series.size()));
  for (std::size_t k = 0; k < series.size(); ++k) {
    const Colour c = kSeries[k % kSeries.size()];
    for (std::size_t i = 0; i < series[k].x.size(); ++i) {
      const double left = axes.x(series[k].x[i] - 0.5 * kFilled + width * static_cast<double>(k));
      const double right = axes.x(series[k].x[i] - 0.5 * kFilled + width * static_cast<double>(k + 1));
      const double end = axes.y(series[k].y[i]), zero = axes.y(0);
      drawing.rectangle(left, std::min(end, zero), right - left, std::abs(zero - end), c);
    }
    draw_legend(drawing, axes.right, k, series[k].name, c);
  }
  return drawing;
}

}  // namespace palpate
