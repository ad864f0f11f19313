// Values as pictures colour them: evened out where they are rough, and never far from what was solved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim_host/view/view_scales.h"

namespace palpate {
namespace {

constexpr int kSide = 40;

// A square of a grid, whose displacement is `value(x, y)` upwards, x and y from 0 to 1.
template <class Value>
DeformedSurface grid_of(Value&& value) {
  DeformedSurface surface;
  for (int y = 0; y <= kSide; ++y) {
    for (int x = 0; x <= kSide; ++x) {
      const double across = x / double{kSide}, along = y / double{kSide};
      surface.rest_m.push_back({across, along, 0});
      surface.displacement_m.push_back({0, 0, value(across, along)});
    }
  }
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const int a = y * (kSide + 1) + x, b = a + 1, c = a + kSide + 1, d = c + 1;
      surface.triangle.push_back({a, b, d});
      surface.triangle.push_back({a, d, c});
    }
  }
  return surface;
}

// The longest way that the line of a level takes aside, from row to row: where values along x first reach it.
double zigzag(const std::vector<double>& value, double level) {
  double longest = 0, before = -1;
  for (int y = kSide / 4; y <= 3 * kSide / 4; ++y) {
    for (int x = 1; x <= kSide; ++x) {
      const auto at = static_cast<std::size_t>(y * (kSide + 1) + x);
      if (!(value[at] >= level)) continue;
      const double crossed = x - (value[at] - level) / (value[at] - value[at - 1]);
      if (before >= 0) longest = std::max(longest, std::abs(crossed - before));
      before = crossed;
      break;
    }
  }
  return longest;
}

ColourScale scale_of(double top) {
  ColourScale scale;
  scale.top = top;
  return scale;
}

TEST(DrawnValues, ALevelOfARoughFieldIsALine) {
  const auto rough = [](double x, double y) { return 2e-3 + 2e-4 * x + 1e-5 * std::sin(997 * x + 1409 * y); };
  const DeformedSurface surface = grid_of(rough);
  std::vector<double> solved;
  for (const Vec3& moved : surface.displacement_m) solved.push_back(moved.z);
  const std::vector<double> drawn = drawn_values(surface, scale_of(5e-3));
  EXPECT_GT(zigzag(solved, 2.1e-3), 1);
  EXPECT_LT(zigzag(drawn, 2.1e-3), 0.1);
}

// A dent of three edges' width keeps its depth to the share, and no value goes farther from what was solved.
TEST(DrawnValues, StayByWhatWasSolved) {
  const auto dent = [](double x, double y) {
    return 5e-3 * std::exp(-200 * ((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5)));
  };
  const DeformedSurface surface = grid_of(dent);
  const std::vector<double> drawn = drawn_values(surface, scale_of(5e-3));
  for (std::size_t v = 0; v < drawn.size(); ++v)
    EXPECT_LE(std::abs(drawn[v] - surface.displacement_m[v].z), kEvenShare * 5e-3 * (1 + 1e-12)) << v;
}

}  // namespace
}  // namespace palpate
