#include "sim_host/doctor/device_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate {

namespace {

constexpr double kStep_s = 1e-4;  // of the model: mass over damping of a handle is 10 ms and more
constexpr double kDelayMost_s = 6e-3;
constexpr int kParameters = 5;
using Parameters = std::array<double, kParameters>;

Parameters parameters_of(const DeviceFit& f) {
  return {std::log(f.mass_kg), std::log(f.damping_Ns_per_m), std::log(f.friction_N), 1e3 * f.delay_s, 1e6 * f.offset_m};
}
DeviceFit fit_of(const Parameters& p) {
  DeviceFit f;
  f.mass_kg = std::exp(std::clamp(p[0], -7.0, 4.0));
  f.damping_Ns_per_m = std::exp(std::clamp(p[1], -9.0, 6.0));
  f.friction_N = std::exp(std::clamp(p[2], -9.0, 4.0));
  f.delay_s = std::clamp(1e-3 * p[3], 0.0, kDelayMost_s);
  f.offset_m = 1e-6 * p[4];
  return f;
}

// Sum of squares of what the model leaves.
double left_m2(const DeviceRecord& record, const Parameters& parameters) {
  const std::vector<double> motion = handle_motion(record, fit_of(parameters));
  double sum = 0;
  for (std::size_t i = 0; i < motion.size(); ++i)
    sum += (motion[i] - record.position_m[i]) * (motion[i] - record.position_m[i]);
  return sum;
}

struct Corner {
  Parameters at;
  double left = 0;
};

// The simplex of Nelder & Mead (1965): friction sticks and slips, so the squares have kinks everywhere, and Gauss and
// Newton's steps failed on them (22 um left where 11 were, 2026-11-23).
class Simplex {
 public:
  Simplex(const DeviceRecord& record, const Parameters& begin, double size) : record_(record) {
    corner_[0] = valued(begin);
    for (std::size_t k = 0; k < kParameters; ++k) {
      Parameters p = begin;
      p[k] += k < 3 ? size : k == 3 ? 3 * size : 20 * size;  // logarithms, ms, um
      corner_[k + 1] = valued(p);
    }
  }
  Corner least(int steps) {
    for (int i = 0; i < steps; ++i) step();
    sort();
    return corner_[0];
  }

 private:
  static constexpr std::size_t kCorners = kParameters + 1;
  Corner valued(const Parameters& at) const { return {at, left_m2(record_, at)}; }
  void sort() {
    std::sort(corner_.begin(), corner_.end(), [](const Corner& a, const Corner& b) { return a.left < b.left; });
  }
  // From the worst corner through the middle of the others, `way` times as far.
  Corner through_middle(double way) const {
    Parameters p{};
    for (std::size_t k = 0; k < kParameters; ++k) {
      double middle = 0;
      for (std::size_t c = 0; c + 1 < kCorners; ++c) middle += corner_[c].at[k] / kParameters;
      p[k] = middle + way * (middle - corner_.back().at[k]);
    }
    return valued(p);
  }
  void step() {
    sort();
    const Corner over = through_middle(1);
    if (over.left < corner_[0].left) {
      const Corner far = through_middle(2);
      corner_.back() = far.left < over.left ? far : over;
    } else if (over.left < corner_[kCorners - 2].left) {
      corner_.back() = over;
    } else {
      const Corner near = through_middle(over.left < corner_.back().left ? 0.5 : -0.5);
      if (near.left < std::min(over.left, corner_.back().left))
        corner_.back() = near;
      else
        shrink();
    }
  }
  void shrink() {
    for (std::size_t c = 1; c < kCorners; ++c) {
      Parameters p{};
      for (std::size_t k = 0; k < kParameters; ++k) p[k] = 0.5 * (corner_[0].at[k] + corner_[c].at[k]);
      corner_[c] = valued(p);
    }
  }
  const DeviceRecord& record_;
  std::array<Corner, kCorners> corner_;
};

DeviceFit refined(const DeviceRecord& record, const DeviceFit& begin) {
  Corner best{parameters_of(begin), 0};
  for (const double size : {0.4, 0.1, 0.05, 0.02}) best = Simplex(record, best.at, size).least(200);
  DeviceFit fit = fit_of(best.at);
  fit.residual_m = std::sqrt(best.left / static_cast<double>(record.position_m.size()));
  return fit;
}

// Where the simplex begins: the best places of a coarse grid.
std::vector<DeviceFit> beginnings(const DeviceRecord& record) {
  std::vector<std::pair<double, DeviceFit>> tried;
  for (const double mass : {0.02, 0.06, 0.2, 0.6, 2.0})
    for (const double damping : {0.05, 0.3, 1.5, 6.0})
      for (const double friction : {0.01, 0.05, 0.2})
        for (const double delay_s : {5e-4, 3e-3}) {
          const DeviceFit fit{mass, damping, friction, delay_s};
          tried.emplace_back(left_m2(record, parameters_of(fit)), fit);
        }
  constexpr std::size_t kKept = 3;
  std::partial_sort(tried.begin(), tried.begin() + kKept, tried.end(),
                    [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<DeviceFit> kept;
  for (std::size_t i = 0; i < kKept; ++i) kept.push_back(tried[i].second);
  return kept;
}

}  // namespace

std::vector<double> handle_motion(const DeviceRecord& record, const DeviceFit& handle) {
  const int steps = std::max(1, static_cast<int>(std::lround(record.period_s / kStep_s)));
  const double inverse = 1 / (handle.mass_kg + 0.5 * kStep_s * handle.damping_Ns_per_m);
  const double kept = (handle.mass_kg - 0.5 * kStep_s * handle.damping_Ns_per_m) * inverse;
  const double rubbed = handle.friction_N * kStep_s * inverse;  // most that friction takes of the velocity in a step
  // Command n acts from n T + delay on: within a tick the last one for `rest` steps, then the next.
  const auto whole = static_cast<std::ptrdiff_t>(std::floor(handle.delay_s / record.period_s));
  const double rest = (handle.delay_s - static_cast<double>(whole) * record.period_s) / kStep_s;
  const auto force_N = [&](std::ptrdiff_t n) { return n < 0 ? 0.0 : record.force_N[static_cast<std::size_t>(n)]; };
  std::vector<double> position(record.position_m.size());
  double x = record.position_m.empty() ? 0 : record.position_m.front() + handle.offset_m, v = 0;
  for (std::size_t n = 0; n < position.size(); ++n) {
    position[n] = x;
    const auto acting = static_cast<std::ptrdiff_t>(n) - whole;
    const double last = force_N(acting - 1), now = force_N(acting);
    for (int i = 0; i < steps; ++i) {
      const double share = std::clamp(rest - i, 0.0, 1.0);
      const double free = kept * v + kStep_s * inverse * (share * last + (1 - share) * now);
      const double next = free > rubbed ? free - rubbed : free < -rubbed ? free + rubbed : 0;
      x += 0.5 * kStep_s * (v + next);
      v = next;
    }
  }
  return position;
}

DeviceFit fit_device(const DeviceRecord& record) {
  DeviceFit best;
  best.residual_m = 1e9;
  for (const DeviceFit& begin : beginnings(record)) {
    const DeviceFit fit = refined(record, begin);
    if (fit.residual_m < best.residual_m) best = fit;
  }
  const auto [least, most] = std::minmax_element(record.position_m.begin(), record.position_m.end());
  best.travel_m = *most - *least;
  return best;
}

double encoder_step_m(const std::vector<double>& position_m) {
  constexpr double kSame_m = 1e-9, kSlack = 0.02;
  std::vector<double> level = position_m, gap;
  std::sort(level.begin(), level.end());
  for (std::size_t i = 1; i < level.size(); ++i)
    if (level[i] - level[i - 1] > kSame_m) gap.push_back(level[i] - level[i - 1]);
  if (gap.size() < 3) return 0;
  const double step = *std::min_element(gap.begin(), gap.end());
  const auto whole = std::count_if(gap.begin(), gap.end(),
                                   [&](double g) { return std::abs(g / step - std::floor(g / step + 0.5)) < kSlack; });
  return 20 * whole >= 19 * static_cast<std::ptrdiff_t>(gap.size()) ? step : 0;
}

}  // namespace palpate
