#include "tests/published/sheets/plot_panel.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <stdexcept>

#include "sim_host/csv_cells.h"
#include "sim_host/view/plot.h"

namespace palpate::papers {

namespace {

constexpr double kLeft = 46, kRight = 16, kBottom = 40, kSize = 11;

struct Axes {
  double top = 10;
  double x_low = 1e300, x_high = -1e300, y_low = 0, y_high = 0;
  double x(double v) const { return kLeft + (kPanelWidth - kLeft - kRight) * (v - x_low) / (x_high - x_low); }
  double y(double v) const {
    return kPanelHeight - kBottom - (kPanelHeight - top - kBottom) * (v - y_low) / (y_high - y_low);
  }
};

Axes axes_of(const std::vector<PlotCurve>& curves, bool bars) {
  Axes axes;
  for (const PlotCurve& curve : curves) {
    for (const double x : curve.x) axes.x_low = std::min(axes.x_low, x), axes.x_high = std::max(axes.x_high, x);
    for (const double y : curve.y) axes.y_low = std::min(axes.y_low, y), axes.y_high = std::max(axes.y_high, y);
  }
  if (bars) axes.x_low -= 0.5, axes.x_high += 0.5;
  if (!(axes.x_high > axes.x_low)) axes.x_high = axes.x_low + 1;
  if (!(axes.y_high > axes.y_low)) axes.y_high = axes.y_low + 1;
  axes.y_high += 0.06 * (axes.y_high - axes.y_low);
  return axes;
}

void draw_axes(Canvas& canvas, const Axes& axes, const std::string& x_title, const std::string& y_title) {
  const double bottom = kPanelHeight - kBottom, right = kPanelWidth - kRight;
  for (const double v : axis_ticks(axes.x_low, axes.x_high, 6)) {
    canvas.polyline(Stroke{{axes.x(v), axes.top}, {axes.x(v), bottom}}, 1, kFaint);
    canvas.text(axes.x(v), bottom + 14, tick_label(v), kSize, kGrey, Align::kMiddle);
  }
  for (const double v : axis_ticks(axes.y_low, axes.y_high, 5)) {
    canvas.polyline(Stroke{{kLeft, axes.y(v)}, {right, axes.y(v)}}, 1, kFaint);
    canvas.text(kLeft - 5, axes.y(v) + 4, tick_label(v), kSize, kGrey, Align::kEnd);
  }
  canvas.polyline(Stroke{{kLeft, axes.top}, {kLeft, bottom}, {right, bottom}}, 1.2, kInk);
  canvas.text(0.5 * (kLeft + right), bottom + 31, x_title, 12, kInk, Align::kMiddle);
  canvas.text(13, 0.5 * (axes.top + bottom), y_title, 12, kInk, Align::kMiddle, true);
}

void draw_curve(Canvas& canvas, const Axes& axes, const PlotCurve& curve, Colour c, PlotKind kind) {
  Stroke line;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const Point2 at{axes.x(curve.x[i]), axes.y(curve.y[i])};
    if (kind == PlotKind::kMarks) canvas.rectangle(at.x - 2.5, at.y - 2.5, 5, 5, c);
    // Of a long history what a pixel can show.
    if (line.empty() || std::abs(at.x - line.back().x) + std::abs(at.y - line.back().y) > 0.7) line.push_back(at);
  }
  if (kind == PlotKind::kLines) canvas.polyline(line, 1.8, c);
}

void draw_bars(Canvas& canvas, const Axes& axes, const PlotCurve& curve, std::size_t k, std::size_t series, Colour c) {
  constexpr double kFilled = 0.76;
  const double width = kFilled / static_cast<double>(series);
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double left = axes.x(curve.x[i] - 0.5 * kFilled + width * static_cast<double>(k));
    const double right = axes.x(curve.x[i] - 0.5 * kFilled + width * static_cast<double>(k + 1));
    canvas.rectangle(left, axes.y(curve.y[i]), right - left, axes.y(0) - axes.y(curve.y[i]), c);
  }
}

// The curves' names above the plot, as many in a row as fit; how far they reach down.
double draw_names(Canvas& canvas, const std::vector<PlotCurve>& curves) {
  double x = kLeft, y = 12;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const double width = 18 + text_width(curves[k].name, kSize) + 12;
    if (curves[k].name.empty()) continue;
    if (x > kLeft && x + width > kPanelWidth) x = kLeft, y += 15;
    canvas.rectangle(x, y - 6, 12, 4, kSeries[k % kSeries.size()]);
    canvas.text(x + 17, y, curves[k].name, kSize, kInk);
    x += width;
  }
  return y + 8;
}

double number_in(std::string_view cell) {
  double value = 0;
  const auto result = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return result.ec == std::errc() ? value : 0.0;
}

}  // namespace

Table::Table(const std::string& path) : path_(path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw std::runtime_error(path + ": cannot be read, or is empty");
  for (const std::string_view cell : cells_of(line)) name_.emplace_back(cell);
  column_.resize(name_.size());
  while (std::getline(file, line)) {
    const std::vector<std::string_view> cells = cells_of(line);
    for (std::size_t i = 0; i < name_.size(); ++i) column_[i].push_back(i < cells.size() ? number_in(cells[i]) : 0.0);
  }
}

const std::vector<double>& Table::operator[](const std::string& column) const {
  const auto found = std::ranges::find(name_, column);
  if (found == name_.end()) throw std::runtime_error(path_ + ": has no column " + column);
  return column_[static_cast<std::size_t>(found - name_.begin())];
}

std::vector<double> scaled(const std::vector<double>& values, double factor, double plus) {
  std::vector<double> result;
  for (const double v : values) result.push_back(factor * v + plus);
  return result;
}

Canvas plot_panel(const std::vector<PlotCurve>& curves, const std::string& x_title, const std::string& y_title,
                  PlotKind kind) {
  Canvas canvas(kPanelWidth, kPanelHeight, kPaper);
  Axes axes = axes_of(curves, kind == PlotKind::kBars);
  axes.top = draw_names(canvas, curves);
  draw_axes(canvas, axes, x_title, y_title);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const Colour c = kSeries[k % kSeries.size()];
    if (kind == PlotKind::kBars)
      draw_bars(canvas, axes, curves[k], k, curves.size(), c);
    else
      draw_curve(canvas, axes, curves[k], c, kind);
  }
  return canvas;
}

}  // namespace palpate::papers
