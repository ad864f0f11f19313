#include "sim_host/view/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace palpate {

namespace {

// Of the run's own time.
double first_touch_s(const RunTrack& track, const std::string& name) {
  for (const TrackEvent& event : track.events())
    if (event.kind == TrackEvent::Kind::kTouch) return track.time_s(event.index);
  throw std::runtime_error(name +
                           ": never touches the body, so it has no first touch to be aligned by; use --align "
                           "time");
}

void cut(TrackColumns& columns, std::size_t first, std::size_t end) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  columns.each([&](std::vector<TrackColumns::Range>& line) {
    for (std::size_t c = 0; c < line.size(); ++c)
      if (c < first || c >= end) line[c] = {kNone, kNone};
  });
}

}  // namespace

Comparison::Comparison(const RunTrack& a, const RunTrack& b, Alignment alignment,
                       const std::array<std::string, kRuns>& names)
    : track_{&a, &b}, alignment_(alignment) {
  for (std::size_t run = 0; run < kRuns; ++run) {
    const RunTrack& track = *track_[run];
    if (alignment == Alignment::kTouch) zero_s_[run] = first_touch_s(track, names[run]);
    begin_s_[run] = track.time_s(0) - zero_s_[run];
    end_s_[run] = track.time_s(track.size() - 1) - zero_s_[run];
  }
  first_s_ = std::min(begin_s_[0], begin_s_[1]);
  last_s_ = std::max(end_s_[0], end_s_[1]);
  const double from_s = std::max(begin_s_[0], begin_s_[1]), until_s = std::min(end_s_[0], end_s_[1]);
  // Runs with a touch always share that moment.
  if (until_s < from_s)
    throw std::runtime_error(
        fmt::format("{} is over at {:.3f} s, {} begins at {:.3f} s: they share no time; use --align touch",
                    names[end_s_[0] < end_s_[1] ? 0 : 1], until_s, names[end_s_[0] < end_s_[1] ? 1 : 0], from_s));
  measure(from_s, until_s);
}

bool Comparison::is_there(std::size_t run, double common_s) const {
  const double half = 0.5 * track_[run]->period_s();
  return common_s > begin_s_[run] - half && common_s < end_s_[run] + 2 * half;
}

std::size_t Comparison::index_at(std::size_t run, double common_s) const {
  return track_[run]->index_at(common_s + zero_s_[run]);
}

TrackColumns Comparison::columns(std::size_t run, double from_s, double until_s, std::size_t number) const {
  TrackColumns columns = track_[run]->columns(from_s + zero_s_[run], until_s + zero_s_[run], number);
  const double column_s = (until_s - from_s) / static_cast<double>(number);
  const auto column = [&](double time_s) {
    return static_cast<std::size_t>(std::clamp((time_s - from_s) / column_s, 0.0, static_cast<double>(number)));
  };
  cut(columns, column(begin_s_[run]), column(end_s_[run] + column_s));
  return columns;
}

void Comparison::measure(double from_s, double until_s) {
  const double step_s = std::max(track_[0]->period_s(), track_[1]->period_s());
  const auto steps = static_cast<std::size_t>(std::floor((until_s - from_s) / step_s + 1e-6));
  double force2 = 0, depth2 = 0, strongest_N = -1;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double at_s = from_s + step_s * static_cast<double>(i);
    const TrackTick a = track_[0]->at(index_at(0, at_s)), b = track_[1]->at(index_at(1, at_s));
    // What happens before and after, when a hand falls into a body that does not push back, is no difference of force.
    if (a.mode != Mode::kForce || b.mode != Mode::kForce) continue;
    ++difference_.ticks;
    const double force_N = norm(a.contact_N - b.contact_N);
    const double depth_mm = 1e3 * std::abs(std::max(0.0, a.depth_m) - std::max(0.0, b.depth_m));
    // Both are to be seen pressing: the weaker one counts, and the first where they never touch together.
    const double seen_N = std::min(norm(a.contact_N), norm(b.contact_N)) + 1e-6 * norm(a.contact_N);
    if (seen_N > strongest_N) {
      strongest_N = seen_N;
      difference_.strongest_at_s = at_s;
    }
    force2 += force_N * force_N;
    depth2 += depth_mm * depth_mm;
    difference_.largest_mm = std::max(difference_.largest_mm, depth_mm);
    if (force_N <= difference_.largest_N) continue;
    difference_.largest_N = force_N;
    difference_.largest_at_s = at_s;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, difference_.ticks));
  difference_.rms_N = std::sqrt(force2 / count);
  difference_.rms_mm = std::sqrt(depth2 / count);
}

void check_sizes(const Model& a, const Model& b, const std::array<std::string, 2>& names) {
  constexpr double kMostRatio = 10;
  const double ratio = a.params.surface_size_m / b.params.surface_size_m;
  if (ratio <= kMostRatio && ratio >= 1 / kMostRatio) return;
  throw std::runtime_error(fmt::format(
      "{} and {}: bodies of {:.3g} and {:.3g} mm; one camera and one scale show both only up to a ratio of {:g}",
      names[0], names[1], 1e3 * a.params.surface_size_m, 1e3 * b.params.surface_size_m, kMostRatio));
}

}  // namespace palpate
