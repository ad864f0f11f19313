#include "sim_host/press/anchor_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "sim_host/view/anchors.h"
#include "sim_host/view/line_plot.h"

namespace palpate {

namespace {

constexpr std::size_t kMostSeries = 8;

// Numbers of the anchors, from 1, that ever carry most.
std::vector<int> strongest_anchors(std::span<const AnchorSample> samples) {
  std::vector<double> largest;
  for (const AnchorSample& s : samples) {
    largest.resize(s.force_N.size());
    for (std::size_t a = 0; a < largest.size(); ++a) largest[a] = std::max(largest[a], s.force_N[a]);
  }
  std::vector<int> order(largest.size());
  for (std::size_t a = 0; a < order.size(); ++a) order[a] = static_cast<int>(a + 1);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return largest[static_cast<std::size_t>(a - 1)] > largest[static_cast<std::size_t>(b - 1)];
  });
  order.resize(std::min(order.size(), kMostSeries));
  return order;
}

}  // namespace

AnchorSample sample_anchors(const Model& model, const State& state, double time_s, double depth_m) {
  AnchorSample sample{time_s, depth_m, {}, {}, 0};
  const AnchorField field = anchors_of(model, state);
  for (std::size_t a = 0; a < model.anchor.size(); ++a) {
    sample.force_N.push_back(norm(field.anchor[a].force_w));
    sample.stress_Pa.push_back(field.anchor[a].stress_Pa);
  }
  sample.degenerate = field.degenerate;
  return sample;
}

void write_anchor_csv(const std::string& path, std::span<const AnchorSample> samples) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) throw std::runtime_error(path + ": cannot be written");
  std::string text = "time_s,depth_mm";
  const std::size_t anchors = samples.empty() ? 0 : samples[0].force_N.size();
  for (std::size_t a = 0; a < anchors; ++a) text += fmt::format(",a{}_F_N,a{}_stress_Pa", a + 1, a + 1);
  text += '\n';
  for (const AnchorSample& s : samples) {
    text += fmt::format("{:.9g},{:.9g}", s.time_s, 1e3 * s.depth_m);
    for (std::size_t a = 0; a < anchors; ++a) text += fmt::format(",{:.9g},{:.9g}", s.force_N[a], s.stress_Pa[a]);
    text += '\n';
  }
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  if (std::fclose(file) != 0 || !written) throw std::runtime_error(path + ": could not be written completely");
}

Drawing anchor_force_plot(const Model& model, std::span<const AnchorSample> samples, std::vector<int> anchors,
                          const std::string& title) {
  if (anchors.empty()) anchors = strongest_anchors(samples);
  // Loading only: up to the deepest sample, each step deeper than all before.
  std::vector<const AnchorSample*> loading;
  for (const AnchorSample& s : samples)
    if (s.depth_m > (loading.empty() ? 0.0 : loading.back()->depth_m)) loading.push_back(&s);
  std::vector<PlotCurve> curves;
  for (const int number : anchors) {
    const auto a = static_cast<std::size_t>(number - 1);
    const Vec3 p = 1e3 * model.anchor[a].position_m;
    PlotCurve curve{fmt::format("{} at ({:.3g}, {:.3g}, {:.3g}) mm", number, p.x, p.y, p.z), {0}, {0}};
    for (const AnchorSample* s : loading) {
      curve.x.push_back(1e3 * s->depth_m);
      curve.y.push_back(s->force_N[a]);
    }
    curves.push_back(std::move(curve));
  }
  return line_plot(curves, {title, "depth (mm)", "force at the anchor (N)"}, false);
}

}  // namespace palpate
