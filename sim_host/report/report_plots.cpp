#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sim_host/report/case_report.h"
#include "sim_host/view/plot.h"

namespace palpate {

namespace {

constexpr Colour kInk = colour(0x1f2933), kFaint = colour(0xe3e7ec), kGrey = colour(0x66717d);
constexpr Colour kBand = colour(0x2e9e6b);
constexpr double kWidth = 760, kHeight = 420, kLeft = 70, kTop = 46, kBottom = 56, kRight = 178;
// What is further from the reference is left to the table: it would flatten the rest.
constexpr double kDrawnError = 0.25;

struct Family {
  const char* name;
  Colour c;
};
constexpr std::array kFamilies{Family{"elastic", colour(0x2f6fb2)}, Family{"nodal", colour(0x2e9e6b)},
                               Family{"tip", colour(0xd1702b)}, Family{"table", colour(0x7d5ba6)},
                               Family{"points", colour(0x8b8f96)}};
Colour colour_of(const std::string& family) {
  for (const Family& f : kFamilies)
    if (family == f.name) return f.c;
  return kInk;
}
// Members of a family are told apart by how light they are.
Colour shade(const CaseReport& report, const ModelRun& run) {
  int before = 0;
  for (const ModelRun& other : report.runs) {
    if (&other == &run) break;
    before += other.family == run.family && other.refused.empty() ? 1 : 0;
  }
  return mix(colour_of(run.family), colour(0xffffff), 0.28f * static_cast<float>(std::min(before, 2)));
}

struct Axis {
  double low = 0, high = 1;
  bool log = false;
  double share(double v) const { return log ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low); }
};
struct Frame {
  Axis x, y;
  double px(double v) const { return kLeft + (kWidth - kLeft - kRight) * x.share(v); }
  double py(double v) const { return kHeight - kBottom - (kHeight - kTop - kBottom) * y.share(v); }
};

// 1, 2, 5 times powers of ten in a logarithmic range.
std::vector<double> ticks_of(const Axis& axis, int wanted) {
  if (!axis.log) return axis_ticks(axis.low, axis.high, wanted);
  std::vector<double> ticks;
  for (double decade = std::pow(10, std::floor(std::log10(axis.low))); decade <= axis.high; decade *= 10)
    for (const double m : {1.0, 2.0, 5.0})
      if (m * decade >= axis.low * 0.999 && m * decade <= axis.high * 1.001) ticks.push_back(m * decade);
  return ticks;
}

std::string short_number(double v) {
  if (std::abs(v) >= 1e6) return fmt::format("{:.3g}M", v / 1e6);
  if (std::abs(v) >= 1e4) return fmt::format("{:.3g}k", v / 1e3);
  return fmt::format("{:.3g}", v);
}

void draw_frame(Drawing& d, const Frame& f, const std::string& title, const std::string& x, const std::string& y) {
  const double left = kLeft, right = kWidth - kRight, bottom = kHeight - kBottom;
  for (const double v : ticks_of(f.x, 8)) {
    d.line({{f.px(v), kTop}, {f.px(v), bottom}}, 0.8, kFaint);
    d.text(f.px(v), bottom + 17, short_number(v), 11, kGrey, Align::kMiddle);
  }
  for (const double v : ticks_of(f.y, 7)) {
    d.line({{left, f.py(v)}, {right, f.py(v)}}, 0.8, kFaint);
    d.text(left - 7, f.py(v) + 4, short_number(v), 11, kGrey, Align::kEnd);
  }
  d.line({{left, kTop}, {left, bottom}, {right, bottom}}, 1.2, kInk);
  d.text(0.5 * (left + right), bottom + 38, x, 12, kInk, Align::kMiddle);
  d.text(20, 0.5 * (kTop + bottom), y, 12, kInk, Align::kMiddle, true);
  d.text(left, 26, title, 15, kInk, Align::kStart, false, true);
}

void draw_legend(Drawing& d, std::size_t row, const std::string& name, Colour c) {
  const double x = kWidth - kRight + 16, y = kTop + 12 + 19 * static_cast<double>(row);
  d.rectangle(x, y - 8, 10, 8, c);
  d.text(x + 16, y, name, 12, kInk);
}

double cost_of(const ModelRun& run) { return run.count.counted ? static_cast<double>(run.count.worst) : run.p50_us; }

bool is_drawn(const ModelRun& run) { return run.refused.empty() && run.error && run.error->force_rms <= kDrawnError; }

}  // namespace

Drawing pareto_plot(const std::vector<CaseReport>& cases, const std::string& title) {
  Drawing d(kWidth, kHeight);
  Frame f{{1e300, 0, true}, {0.1, 100, true}};
  bool counted = true;
  double least = 1e300, most = 0;
  for (const CaseReport& report : cases)
    for (const ModelRun& run : report.runs) {
      if (!run.refused.empty() || !run.error) continue;
      counted = counted && run.count.counted;
      f.x.low = std::min(f.x.low, cost_of(run));
      f.x.high = std::max(f.x.high, cost_of(run));
      least = std::min(least, 100 * run.error->force_rms);
      most = std::max(most, 100 * run.error->force_rms);
    }
  if (!(f.x.high > 0) || !(f.x.low > 0)) f.x = {1, 10, true};
  f.x.low *= 0.8;
  f.x.high *= 1.25;
  f.y.low = std::min(std::max(0.8 * least, 1e-2), 1.0);
  f.y.high = std::max(1.3 * most, 10.0);
  draw_frame(d, f, title, counted ? "instructions of the worst tick" : "microseconds, median tick",
             "RMS error of the force, %");
  const double noticed = 100 * kForceNoticed, below = std::clamp(f.py(noticed), kTop, kHeight - kBottom);
  d.rectangle(kLeft, below, kWidth - kRight - kLeft, kHeight - kBottom - below, kBand, 0.08);
  d.text(kWidth - kRight - 6, below + 14, fmt::format("not felt: below {:.0f} %", noticed), 11, kBand, Align::kEnd);
  const bool many = cases.size() > 1;
  for (const CaseReport& report : cases)
    for (const ModelRun& run : report.runs) {
      if (!run.refused.empty() || !run.error) continue;
      const double x = f.px(cost_of(run)), y = f.py(std::max(100 * run.error->force_rms, f.y.low));
      d.rectangle(x - 4, y - 4, 8, 8, many ? colour_of(run.family) : shade(report, run), many ? 0.75 : 1);
    }
  if (many) {
    for (std::size_t i = 0; i < kFamilies.size(); ++i) draw_legend(d, i, kFamilies[i].name, kFamilies[i].c);
    return d;
  }
  std::size_t row = 0;
  for (const ModelRun& run : cases[0].runs)
    if (run.refused.empty() && run.error) draw_legend(d, row++, run.name, shade(cases[0], run));
  return d;
}

Drawing error_plot(const CaseReport& report) {
  Drawing d(kWidth, kHeight);
  Frame f{{0, 1, false}, {-2, 2, false}};
  for (const ModelRun& run : report.runs) {
    if (!is_drawn(run)) continue;
    f.x.high = 1e3 * run.error->to;
    for (const double e : run.error->relative) {
      f.y.low = std::min(f.y.low, 110 * e);
      f.y.high = std::max(f.y.high, 110 * e);
    }
  }
  draw_frame(d, f, report.name + ": error along the path", "depth, mm", "error of the force, %");
  const double noticed = 100 * kForceNoticed, top = std::max(f.py(noticed), kTop),
               bottom = std::min(f.py(-noticed), kHeight - kBottom);
  d.rectangle(kLeft, top, kWidth - kRight - kLeft, bottom - top, kBand, 0.08);
  d.line({{kLeft, f.py(0)}, {kWidth - kRight, f.py(0)}}, 1, kGrey);
  std::size_t row = 0;
  for (const ModelRun& run : report.runs) {
    if (!is_drawn(run)) continue;
    const Colour c = shade(report, run);
    Stroke line;
    for (std::size_t i = 0; i < run.error->x.size(); ++i)
      line.push_back({f.px(1e3 * run.error->x[i]), f.py(100 * run.error->relative[i])});
    d.line(line, 2, c);
    draw_legend(d, row++, run.name, c);
  }
  return d;
}

Drawing force_plot(const CaseReport& report) {
  Drawing d(kWidth, kHeight);
  Frame f{{0, 1e3 * report.press.depth_m, false}, {0, 0, false}};
  const auto along = [&](Vec3 force) { return dot(force, report.press.normal); };
  if (report.reference) f.y.high = 1.3 * along(report.reference->force_N.back());
  for (const ModelRun& run : report.runs)
    if (!report.reference && run.refused.empty()) f.y.high = std::max(f.y.high, 1.05 * along(run.path.force_N.back()));
  if (!(f.y.high > 0)) f.y.high = 1;
  draw_frame(d, f, report.name + ": force", "depth, mm", "force, N");
  std::size_t row = 0;
  for (const ModelRun& run : report.runs) {
    if (!run.refused.empty()) continue;
    const Colour c = shade(report, run);
    Stroke line;
    for (std::size_t i = 0; i < run.path.x.size(); i += 4) {
      const double force = along(run.path.force_N[i]);
      if (force > f.y.high) break;
      line.push_back({f.px(1e3 * run.path.x[i]), f.py(std::max(force, 0.0))});
    }
    d.line(line, 1.6, c);
    draw_legend(d, row++, run.name, c);
  }
  if (!report.reference) return d;
  for (std::size_t i = 0; i < report.reference->depth_m.size(); ++i) {
    const double x = f.px(1e3 * report.reference->depth_m[i]), y = f.py(along(report.reference->force_N[i]));
    d.line({{x - 4, y}, {x + 4, y}}, 1.6, kInk);
    d.line({{x, y - 4}, {x, y + 4}}, 1.6, kInk);
  }
  draw_legend(d, row, "finite elements (+)", kInk);
  return d;
}

}  // namespace palpate
