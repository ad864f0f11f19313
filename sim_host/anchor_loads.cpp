#include "sim_host/anchor_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "rt_core/deform/beam_table.h"
#include "rt_core/deform/skeleton.h"
#include "rt_core/deform/temporal_order.h"
#include "sim_host/plot.h"

namespace palpate {

namespace {

constexpr Colour kInk = colour(0x1f2933), kFaint = colour(0xdde2e8), kGrey = colour(0x66717d);
constexpr Colour kSeries[] = {colour(0xd1495b), colour(0x2e9e6b), colour(0x2f6fb2), colour(0x22262b),
                              colour(0xe08e2b), colour(0x7d5ba6), colour(0x3aa6a6), colour(0x8a6d3b)};
constexpr std::size_t kMostSeries = 8;
constexpr double kWidth = 900, kHeight = 560, kLeft = 80, kTop = 60, kPlotWidth = 560, kPlotHeight = 430;

// Adds the force of one region's beams on their tips.
void add_region(const Model& model, const State& state, std::int32_t slot, std::vector<Vec3>& sum) {
  const Region& region = state.region[slot];
  const Vec3 force = -(region.normal_force_N * region.normal_w + region.friction_force_w);
  if (uses_beam_table(model)) {
    const auto skeleton = std::make_unique<BeamTableSkeleton>();
    if (!solve_beam_table(model, locate_contact(model, state, slot), force, *skeleton)) return;
    for (std::size_t a = 0; a < sum.size(); ++a) sum[a] += skeleton->force_w[a];
    return;
  }
  const auto skeleton = std::make_unique<Skeleton>();
  if (!solve_skeleton(model, {}, region.centre_w, force, *skeleton)) return;
  for (std::size_t a = 0; a < sum.size(); ++a) sum[a] += skeleton->force_w[a];
}

std::vector<int> strongest_anchors(std::span<const AnchorSample> samples) {
  std::vector<double> largest;
  for (const AnchorSample& s : samples) {
    largest.resize(s.force_N.size());
    for (std::size_t a = 0; a < largest.size(); ++a) largest[a] = std::max(largest[a], s.force_N[a]);
  }
  std::vector<int> order(largest.size());
  for (std::size_t a = 0; a < order.size(); ++a) order[a] = static_cast<int>(a);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return largest[static_cast<std::size_t>(a)] > largest[static_cast<std::size_t>(b)];
  });
  order.resize(std::min(order.size(), kMostSeries));
  return order;
}

}  // namespace

AnchorSample sample_anchors(const Model& model, const State& state, double time_s, double depth_m) {
  AnchorSample sample{time_s, depth_m, {}, {}};
  std::vector<Vec3> force(model.anchor.size());
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot)
    if (is_in_contact(state.region[slot])) add_region(model, state, slot, force);
  for (std::size_t a = 0; a < force.size(); ++a) {
    sample.force_N.push_back(norm(force[a]));
    sample.stress_Pa.push_back(state.anchor[a].stress_Pa);
  }
  return sample;
}

void write_anchor_csv(const std::string& path, std::span<const AnchorSample> samples) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) throw std::runtime_error(path + ": cannot be written");
  std::string text = "time_s,depth_mm";
  const std::size_t anchors = samples.empty() ? 0 : samples[0].force_N.size();
  for (std::size_t a = 0; a < anchors; ++a) text += fmt::format(",a{}_F_N,a{}_stress_Pa", a, a);
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
  for (const int a : anchors)
    if (a < 0 || static_cast<std::size_t>(a) >= model.anchor.size())
      throw std::runtime_error(fmt::format("anchor {}: the body has anchors 0 to {}", a, model.anchor.size() - 1));
  if (anchors.empty()) anchors = strongest_anchors(samples);
  // Loading only: up to the deepest sample, each step deeper than all before.
  std::vector<const AnchorSample*> loading;
  for (const AnchorSample& s : samples)
    if (s.depth_m > (loading.empty() ? 0.0 : loading.back()->depth_m)) loading.push_back(&s);
  double depth = 1e-3, force = 1e-3;
  for (const AnchorSample* s : loading) {
    depth = std::max(depth, s->depth_m);
    for (const int a : anchors) force = std::max(force, 1.05 * s->force_N[static_cast<std::size_t>(a)]);
  }
  Drawing drawing(kWidth, kHeight);
  drawing.text(kLeft, 32, title, 18, kInk, Align::kStart, false, true);
  const auto x = [&](double d) { return kLeft + kPlotWidth * d / depth; };
  const auto y = [&](double f) { return kTop + kPlotHeight * (1 - f / force); };
  for (const double d : axis_ticks(0, 1e3 * depth, 6)) {
    drawing.line({{x(1e-3 * d), kTop}, {x(1e-3 * d), kTop + kPlotHeight}}, 0.8, kFaint);
    drawing.text(x(1e-3 * d), kTop + kPlotHeight + 18, tick_label(d), 12, kGrey, Align::kMiddle);
  }
  for (const double f : axis_ticks(0, force, 6)) {
    drawing.line({{kLeft, y(f)}, {kLeft + kPlotWidth, y(f)}}, 0.8, kFaint);
    drawing.text(kLeft - 8, y(f) + 4, tick_label(f), 12, kGrey, Align::kEnd);
  }
  drawing.text(kLeft + kPlotWidth / 2, kTop + kPlotHeight + 42, "depth (mm)", 13, kInk, Align::kMiddle);
  drawing.text(24, kTop + kPlotHeight / 2, "force at the anchor (N)", 13, kInk, Align::kMiddle, true);
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const auto a = static_cast<std::size_t>(anchors[i]);
    const Colour c = kSeries[i % kMostSeries];
    Stroke line{{x(0), y(0)}};
    for (const AnchorSample* s : loading) line.push_back({x(s->depth_m), y(s->force_N[a])});
    drawing.line(std::move(line), 2.2, c);
    const double row = kTop + 14 + 24 * static_cast<double>(i);
    const Vec3 p = 1e3 * model.anchor[a].position_m;
    drawing.line({{kLeft + kPlotWidth + 24, row - 4}, {kLeft + kPlotWidth + 46, row - 4}}, 3, c);
    drawing.text(kLeft + kPlotWidth + 54, row, fmt::format("{} at ({:.3g}, {:.3g}, {:.3g}) mm", a, p.x, p.y, p.z), 12,
                 kInk);
  }
  return drawing;
}

}  // namespace palpate
