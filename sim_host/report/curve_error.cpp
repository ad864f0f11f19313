#include "sim_host/report/curve_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace palpate {

namespace {

Vec3 force_at(const ForcePath& path, double x) {
  const auto above = std::ranges::lower_bound(path.x, x);
  if (above == path.x.begin()) return path.force_N.front();
  if (above == path.x.end()) return path.force_N.back();
  const auto i = static_cast<std::size_t>(above - path.x.begin());
  const double share = (x - path.x[i - 1]) / (path.x[i] - path.x[i - 1]);
  return path.force_N[i - 1] + share * (path.force_N[i] - path.force_N[i - 1]);
}

// Share of [x[0], x[n-1]] where the straight lines through `value` are within `limit` of 0.
double share_within(const std::vector<double>& x, const std::vector<double>& value, double limit) {
  constexpr int kSteps = 16;  // of each interval
  int inside = 0, all = 0;
  double within = 0, total = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    inside = all = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double share = (k + 0.5) / kSteps;
      all += 1;
      inside += std::abs(value[i - 1] + share * (value[i] - value[i - 1])) <= limit ? 1 : 0;
    }
    within += (x[i] - x[i - 1]) * inside / all;
    total += x[i] - x[i - 1];
  }
  return total > 0 ? within / total : 0;
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

// Both curves at the common points.
struct Pairs {
  std::vector<double> x;
  std::vector<Vec3> reference, other;
};

Pairs common_points(const ForcePath& reference, const ForcePath& other) {
  Pairs pairs;
  if (other.x.empty() || reference.x.empty()) throw std::runtime_error("a curve has no points");
  // A path that ends a rounding short of the reference's last depth covers it.
  const double slack = 1e-6 * (other.x.back() - other.x.front());
  for (std::size_t i = 0; i < reference.x.size(); ++i) {
    if (reference.x[i] < other.x.front() - slack || reference.x[i] > other.x.back() + slack) continue;
    pairs.x.push_back(reference.x[i]);
    pairs.reference.push_back(reference.force_N[i]);
    pairs.other.push_back(force_at(other, reference.x[i]));
  }
  if (pairs.x.size() < 3)
    throw std::runtime_error("the curves have fewer than three points in common: they must cover the same range");
  return pairs;
}

void add_stiffness(const Pairs& pairs, CurveError& error) {
  std::vector<double> slope, other;
  double largest = 0;
  for (std::size_t i = 1; i < pairs.x.size(); ++i) {
    const double step = pairs.x[i] - pairs.x[i - 1];
    slope.push_back((norm(pairs.reference[i]) - norm(pairs.reference[i - 1])) / step);
    other.push_back((norm(pairs.other[i]) - norm(pairs.other[i - 1])) / step);
    largest = std::max(largest, std::abs(slope.back()));
  }
  if (!(largest > 0)) return;
  std::vector<double> relative;
  double within = 0;
  for (std::size_t i = 0; i < slope.size(); ++i) {
    relative.push_back((other[i] - slope[i]) / std::max(std::abs(slope[i]), kErrorFloor * largest));
    if (std::abs(relative.back()) <= kStiffnessNoticed) within += pairs.x[i + 1] - pairs.x[i];
    if (std::abs(relative.back()) > std::abs(error.stiffness_largest)) error.stiffness_largest = relative.back();
  }
  error.stiffness_rms = rms(relative);
  error.stiffness_unnoticed = within / (pairs.x.back() - pairs.x.front());
}

}  // namespace

CurveError curve_error(const ForcePath& reference, const ForcePath& other) {
  const Pairs pairs = common_points(reference, other);
  CurveError error;
  error.x = pairs.x;
  error.from = pairs.x.front();
  error.to = pairs.x.back();
  double largest = 0;
  for (const Vec3& force : pairs.reference) largest = std::max(largest, norm(force));
  const double floor = std::max(kErrorFloor * largest, 1e-12);
  std::vector<double> distance;
  double area = 0, other_area = 0;
  for (std::size_t i = 0; i < pairs.x.size(); ++i) {
    const Vec3 a = pairs.reference[i], b = pairs.other[i];
    const double scale = std::max(norm(a), floor);
    error.relative.push_back((norm(b) - norm(a)) / scale);
    distance.push_back(norm(b - a) / scale);
    if (distance.back() > std::abs(error.force_largest)) {
      error.force_largest = norm(b) < norm(a) ? -distance.back() : distance.back();
      error.at_largest = pairs.x[i];
    }
    if (norm(a) >= floor && norm(b) >= floor)
      error.direction_rad = std::max(error.direction_rad, std::atan2(norm(cross(a, b)), dot(a, b)));
    if (i == 0) continue;
    const double half = 0.5 * (pairs.x[i] - pairs.x[i - 1]);
    area += half * (norm(pairs.reference[i - 1]) + norm(a));
    other_area += half * (norm(pairs.other[i - 1]) + norm(b));
  }
  error.force_rms = rms(distance);
  error.energy = area > 0 ? other_area / area - 1 : 0;
  error.force_unnoticed = share_within(pairs.x, distance, kForceNoticed);
  add_stiffness(pairs, error);
  return error;
}

double largest_step_N(const std::vector<Vec3>& force_N) {
  const auto count = static_cast<int>(force_N.size());
  const auto size = [&](int i) { return norm(force_N[static_cast<std::size_t>(i)]); };
  double most = 0;
  for (int i = kTrendTicks; i + kTrendTicks + 1 < count; ++i) {
    const double trend = (size(i + 1 + kTrendTicks) - size(i - kTrendTicks)) / (2 * kTrendTicks + 1);
    most = std::max(most, std::abs(size(i + 1) - size(i) - trend));
  }
  return most;
}

}  // namespace palpate
