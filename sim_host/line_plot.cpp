#include "sim_host/line_plot.h"

#include <algorithm>
#include <array>

#include "sim_host/plot.h"

namespace palpate {

namespace {

constexpr Colour kInk = colour(0x1f2933), kFaint = colour(0xdde2e8), kGrey = colour(0x66717d);
constexpr std::array kSeries{colour(0xd1495b), colour(0x2e9e6b), colour(0x2f6fb2), colour(0x22262b),
                             colour(0xe08e2b), colour(0x7d5ba6), colour(0x3aa6a6), colour(0x8a6d3b)};
constexpr double kWidth = 900, kHeight = 560, kLeft = 84, kRight = 26, kTop = 84, kBottom = 70;

struct Axes {
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;
  double x(double v) const { return kLeft + (kWidth - kLeft - kRight) * (v - x_low) / (x_high - x_low); }
  double y(double v) const { return kHeight - kBottom - (kHeight - kTop - kBottom) * (v - y_low) / (y_high - y_low); }
};

Axes axes_of(const std::vector<PlotCurve>& curves) {
  Axes axes{1e300, -1e300, 0, 0};
  for (const PlotCurve& curve : curves) {
    for (const double x : curve.x) axes.x_low = std::min(axes.x_low, x), axes.x_high = std::max(axes.x_high, x);
    for (const double y : curve.y) axes.y_low = std::min(axes.y_low, y), axes.y_high = std::max(axes.y_high, y);
  }
  if (!(axes.x_high > axes.x_low)) axes.x_low -= 0.5, axes.x_high = axes.x_low + 1;
  if (!(axes.y_high > axes.y_low)) axes.y_high = axes.y_low + 1;
  axes.y_high += 0.06 * (axes.y_high - axes.y_low);
  return axes;
}

void draw_axes(Drawing& drawing, const Axes& axes, const PlotText& text) {
  const double bottom = axes.y(axes.y_low), right = kWidth - kRight;
  for (const double v : axis_ticks(axes.x_low, axes.x_high, 8)) {
    drawing.line({{axes.x(v), kTop}, {axes.x(v), bottom}}, 0.8, kFaint);
    drawing.text(axes.x(v), bottom + 18, tick_label(v), 12, kGrey, Align::kMiddle);
  }
  for (const double v : axis_ticks(axes.y_low, axes.y_high, 6)) {
    drawing.line({{kLeft, axes.y(v)}, {right, axes.y(v)}}, 0.8, kFaint);
    drawing.text(kLeft - 8, axes.y(v) + 4, tick_label(v), 12, kGrey, Align::kEnd);
  }
  drawing.line({{kLeft, kTop}, {kLeft, bottom}, {right, bottom}}, 1.2, kInk);
  drawing.text(kLeft + 0.5 * (right - kLeft), bottom + 42, text.x_title, 13, kInk, Align::kMiddle);
  drawing.text(24, 0.5 * (kTop + bottom), text.y_title, 13, kInk, Align::kMiddle, true);
  drawing.text(kLeft, 32, text.title, 18, kInk, Align::kStart, false, true);
}

}  // namespace

Drawing line_plot(const std::vector<PlotCurve>& curves, const PlotText& text, bool marks) {
  Drawing drawing(kWidth, kHeight);
  const Axes axes = axes_of(curves);
  draw_axes(drawing, axes, text);
  double legend_x = kLeft;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const Colour c = kSeries[k % kSeries.size()];
    Stroke line;
    for (std::size_t i = 0; i < curves[k].x.size(); ++i) {
      const Point2 at{axes.x(curves[k].x[i]), axes.y(curves[k].y[i])};
      line.push_back(at);
      if (marks) drawing.rectangle(at.x - 4, at.y - 4, 8, 8, c);
    }
    drawing.line(std::move(line), 2, c);
    drawing.line({{legend_x, 58}, {legend_x + 20, 58}}, 3, c);
    drawing.text(legend_x + 26, 62, curves[k].name, 13, kInk);
    legend_x += 46 + text_width(curves[k].name, 13);
  }
  return drawing;
}

}  // namespace palpate
