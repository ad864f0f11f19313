// The law of a capsule's side beside boundary elements of a half space, and its forces as slopes of its energy.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "rt_core/contact/tips/line_law.h"
#include "rt_core/contact/tips/travel.h"
#include "tests/elastic/half_space.h"

namespace palpate::test {
namespace {

// Radius 1, E* = 1; the line's depth in its middle, and its slope.
struct LineCase {
  double half, along, across, slope, depth;
};
HalfSpace::Load elements_say(const LineCase& c) {
  const double deepest = c.depth + c.slope * c.half + 0.5 * c.slope * c.slope;
  const double wide = std::min(std::sqrt(2 * deepest / (1 + c.across)), 0.99);
  double low = -c.half - 1.15 * std::sqrt(2 * c.depth), high = c.half + c.slope + 1.15 * std::sqrt(2 * deepest);
  if (c.along > 0) {
    const double most = 1.25 * std::sqrt(2 * c.depth / c.along);
    low = std::max(low, -most), high = std::min(high, most);
  }
  const HalfSpace body(18, 60, wide, low, high);
  return body.press([&](double x, double y) {
    const double beyond = std::max(std::abs(y) - c.half, 0.0), square = x * x + beyond * beyond;
    const double tool = square < 1 ? 1 - std::sqrt(1 - square) : 1 + 10 * (square - 1);
    return c.depth + c.slope * y - tool - 0.5 * (c.across * x * x + c.along * y * y);
  });
}
LineLaw law_of(const LineCase& c) {
  return {{1, c.half, c.half, 1, 1, c.slope / (1 + c.along), c.along, c.across, true}, 1, 1};
}
// e of the middle: lowered by the lean.
double e_of(const LineCase& c) { return c.depth + 0.5 * c.slope * c.slope / (1 + c.along); }

// 1.9 % at most; with 48 elements across and up to 512 along 2.1 % (2026-11-26, 180 cases of straight halves of 0 to 4,
// depths of 0.02 to 0.3, circle and parabola).
TEST(LineLaw, PressesAsBoundaryElementsDo) {
  double worst = 0;
  for (const double half : {0.25, 1.0, 4.0})
    for (const double along : {0.0, 0.05, 0.25})
      for (const double depth : {0.02, 0.1, 0.3}) {
        const LineCase c{half, along, 0, 0, depth};
        const double error = law_of(c).at(e_of(c)).force_N / elements_say(c).force - 1;
        worst = std::max(worst, std::abs(error));
        EXPECT_LT(std::abs(error), 0.03) << half << " " << along << " " << depth;
      }
  for (const double across : {0.3, 1.0}) {
    const LineCase c{2, 0, across, 0, 0.1};
    EXPECT_LT(std::abs(law_of(c).at(e_of(c)).force_N / elements_say(c).force - 1), 0.03) << across;
  }
  RecordProperty("worst", std::to_string(100 * worst) + " %");
}

// 5.6 % of the force, 4 % of the half; with the finer elements and slopes of 0.02 to 0.2 6.6 and 7 % (2026-11-26).
TEST(LineLaw, LeansAsBoundaryElementsDo) {
  double worst = 0, away = 0;
  for (const double half : {0.5, 2.0})
    for (const double slope : {0.02, 0.1})
      for (const double depth : {0.05, 0.2}) {
        const LineCase c{half, 0, 0, slope, depth};
        const HalfSpace::Load load = elements_say(c);
        LineLaw law = law_of(c);
        worst = std::max(worst, std::abs(law.at(e_of(c)).force_N / load.force - 1));
        // From the axis's middle; the force acts lean radii beside the axis's place.
        away = std::max(away, std::abs(law.lean_at(e_of(c)).to_pressure_m + slope - load.moment / load.force) / half);
      }
  RecordProperty("force", std::to_string(100 * worst) + " %");
  RecordProperty("place_of_half", std::to_string(away));
  EXPECT_LT(worst, 0.08);
  EXPECT_LT(away, 0.08);
}

// A ball whichever way it leans, where the axis has no length; and at the end of one that leans far.
TEST(LineLaw, ItsEndIsABall) {
  for (const double depth : {0.01, 0.1, 0.3}) {
    const double a = [&] {  // Segedin 1957: depth = a / 2 ln((1 + a) / (1 - a))
      double low = 0, high = 0.99;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (0.5 * middle * std::log((1 + middle) / (1 - middle)) < depth ? low : high) = middle;
      }
      return low;
    }();
    const double ball = 0.5 * (a * a + 1) * std::log((1 + a) / (1 - a)) - a;
    for (const double lean : {0.0, 0.3, -0.6}) {
      const LineLaw law({1, 0, 0, 1, 1, lean, 0, 0, true}, 1, 1);
      EXPECT_NEAR(law.at(depth).force_N / ball, 1, 1e-3) << depth << " " << lean;
      EXPECT_NEAR(law.lean_at(depth).to_pressure_m, 0, 1e-12);
    }
    const LineLaw steep({1, 4, 0, 1, 1, 0.9, 0, 0, true}, 1, 1);  // stands at its right end
    EXPECT_NEAR(steep.at(depth).force_N / ball, 1, 1e-3) << depth;
  }
}

// The force is the energy's slope in the depth, its moment that in the lean, the tangent that of the force: central
// differences of 1e-6 radii tell them to 1e-8.
TEST(LineLaw, ForceMomentAndTangentAreSlopes) {
  constexpr double kStep = 1e-6;
  for (const double lean : {0.0, 0.03, 0.6, -0.3})
    for (const double along : {0.0, 0.1})
      for (const double e : {0.01, 0.2, 1.5})
        for (const double end : {1.0, 4.0}) {
          const auto law = [&](double at) { return LineLaw({1, 0.7, 1.3, 1, end, at, along, 0.2, true}, 1, 1); };
          const LineLaw here = law(lean);
          const LineLaw::Point p = here.at(e), more = here.at(e + kStep), less = here.at(e - kStep);
          if (!(p.force_N > 0)) continue;
          EXPECT_NEAR((more.energy_J - less.energy_J) / (2 * kStep), p.force_N, 1e-7 * p.force_N);
          EXPECT_NEAR((more.force_N - less.force_N) / (2 * kStep), p.tangent_N_per_m, 1e-7 * p.tangent_N_per_m);
          if (e > 1) continue;  // beyond the range the moment is that of its end
          const double turned = (law(lean + kStep).at(e).energy_J - law(lean - kStep).at(e).energy_J) / (2 * kStep);
          EXPECT_NEAR(turned, here.lean_at(e).to_pressure_m * p.force_N, 1e-7 * p.force_N);
        }
}

// The same line told from another place of its axis, on a round body, too: nothing of it depends on where the tip
// stands.
TEST(LineLaw, IsTheSameFromEveryPlaceOfItsAxis) {
  for (const double along : {0.0, 0.2}) {
    const double lean = 0.05, e = 0.15, step = 0.4, bend = along / (1 + along);
    const LineLaw one({1, 1, 1, 1, 1, lean, along, 0, true}, 1, 1);
    const LineLaw other({1, 1 + step, 1 - step, 1, 1, lean - bend * step, along, 0, true}, 1, 1);
    const double there = e + lean * step - 0.5 * bend * step * step;
    EXPECT_NEAR(other.at(there).energy_J, one.at(e).energy_J, 1e-12);
    EXPECT_NEAR(other.at(there).force_N, one.at(e).force_N, 1e-12);
  }
}

// A bar that is pressed by a constant force and held level by a weak spring, let go at a lean: Newton's steps by the
// tangent throw many of them from end to end for ever, for there the moment hardly changes; by the way back none goes
// beyond the level, and each is there in the end.
TEST(LineLaw, TheWayBackOfALeanDoesNotGoBeyondTheLevel) {
  const auto leans_for_ever = [](double half, double along, double force, double start, bool way_back) {
    constexpr double kSpring = 1e-4;  // of the moment's slope at the level one thousandth at most
    double lean = start;
    for (int i = 0; i < 200; ++i) {
      const LineLaw law({1, half, half, 1, 1, lean, along, 0, false}, 1, 1);
      double lowest = law.touches_at_m(), highest = lowest + 1;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (lowest + highest);
        (law.at(middle).force_N < force ? lowest : highest) = middle;
      }
      const LineLaw::Lean here = law.lean_at(highest);
      const double arm = way_back ? law.arm_back_m(here, highest) : here.arm_m;
      EXPECT_GE(law.arm_back_m(here, highest), here.arm_m);
      const double step = (force * here.to_pressure_m + kSpring * lean) / (force * arm + kSpring);
      if (way_back && std::abs(lean - step) > 1.001 * std::abs(lean) + 1e-9) return true;
      lean -= step;
      if (std::abs(lean) < 1e-9) return false;
      if (std::abs(lean) > 0.5) return true;
    }
    return true;
  };
  int thrown = 0;
  for (const double half : {0.5, 2.0})
    for (const double along : {0.0, 0.05})
      for (const double force : {1e-3, 1e-2, 1e-1})
        for (const double start : {1e-3, 1e-2, -5e-2, 0.2}) {
          EXPECT_FALSE(leans_for_ever(half, along, force, start, true)) << half << " " << force << " " << start;
          thrown += leans_for_ever(half, along, force, start, false) ? 1 : 0;
        }
  EXPECT_GT(thrown, 12);
}

// One that leans touches at its end before its middle is in the surface: what it gives in series with the body is found
// there, too. Looked for between no dent of the middle and all of its depth it was 0.64 mm off (2026-11-26).
TEST(LineLaw, InSeriesWithABodyItTouchesAtItsEndFirst) {
  const LineLaw law({0.01, 0.01, 0.01, 1, 1, 0.02, 0, 0, false}, 2e9, 1);
  ASSERT_LT(law.touches_at_m(), -1e-4);
  const PlaceTerms none;
  Tip tip;
  tip.place = &none;
  tip.become(law);
  for (const double depth_m : {-1e-4, 0.0, 1e-5, 1e-3}) {
    tip.depth_m = depth_m;
    const double c_m_per_N = 1.5e-4;
    const TravelResult found = solve_travel({&tip, 1, {c_m_per_N, 0, kHuge}}, 0);
    const double force_N = tip_at(tip, depth_m - found.shift_m).force_N;
    EXPECT_GT(force_N, 0.1) << depth_m;
    EXPECT_NEAR(found.shift_m, c_m_per_N * force_N, 1e-9) << depth_m;
  }
}

}  // namespace
}  // namespace palpate::test
