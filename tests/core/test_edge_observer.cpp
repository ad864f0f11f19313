// A handle between two edges of its encoder, ten thousand times a second in a device and once a millisecond in the
// controller: near what is told, smooth where the hand is, still on an edge, and at rest with little friction when a
// stiff spring is closed on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "rt_core/safety/edge_observer.h"
#include "rt_core/safety/encoder_observer.h"
#include "rt_core/safety/smoothing_friction.h"
#include "tests/support/held_handle.h"

namespace palpate {
namespace {

constexpr double kStep_m = 3e-5, kPeriod_s = 1e-4, kTwoPi = 6.283185307179586;

double quantised(double x, double edge = 0) { return test::told_m(x, kStep_m, edge); }

class Follower {
 public:
  explicit Follower(double told_m) : told_m_(told_m) {}
  double next(double told_m, double period_s = kPeriod_s) {
    const double change_m = told_m - told_m_;
    told_m_ = told_m;
    const double estimate = told_m + between_edges(kStep_m, period_s, {change_m, 0, 0}, memory_).x;
    EXPECT_LE(std::abs(estimate - told_m), (0.5 + kMostEased) * kStep_m * (1 + 1e-9));
    return estimate;
  }

 private:
  double told_m_;
  EdgeMemory memory_;
};

// What is left of the staircase is at most half, and the estimate is nearer than what is told.
TEST(EdgeObserver, TakesTheStaircaseOutOfATremor) {
  for (const auto& [period_s, ticks_per_ms] : {std::pair{kPeriod_s, 10}, {1e-3, 1}})
    for (const double amplitude : {1.2e-5, 3e-5, 1.2e-4}) {
      const auto motion = [&](double t) { return 0.7e-5 + amplitude * std::sin(kTwoPi * 9 * t); };
      Follower follower(quantised(motion(0)));
      double jumps = 0, told_jumps = 0, before = motion(0), told_before = before;
      for (int i = 0; i < 2000 * ticks_per_ms; ++i) {
        const double x = motion(i * period_s), told = quantised(x), estimate = follower.next(told, period_s);
        if (i % ticks_per_ms == 0) {  // the force a hand gets, once a millisecond
          jumps += (estimate - x - before) * (estimate - x - before);
          told_jumps += (told - x - told_before) * (told - x - told_before);
          before = estimate - x, told_before = told - x;
        }
      }
      EXPECT_LT(std::sqrt(jumps), 0.5 * std::sqrt(told_jumps)) << amplitude;  // 0.25 to 0.38, 2026-11-26
    }
}

// Mean delay as a share of a step: 0.27 at most (2026-11-26); it must not lead either, which would be energy. Faster
// than a step in a period it may, by 0.4 at 1.02 of them (the same day): of several edges passed at once the last one
// counts, and what the estimate jumps by is let go of slowly. At such speeds damping takes many times what that gives.
TEST(EdgeObserver, IsHardlyLate) {
  for (const double period_s : {kPeriod_s, 1e-3})
    for (const double speed : {3.1e-4, 1.1e-3, 1.07e-2, 1.03e-1, 3.07e-1}) {
      Follower follower(0);
      double late = 0;
      const int ticks = static_cast<int>(std::max(2000.0, 60 * kStep_m / speed / period_s)), counted = ticks / 2;
      for (int i = 0; i < ticks; ++i) {
        const double x = speed * i * period_s, estimate = follower.next(quantised(x), period_s);
        if (i >= ticks - counted) late += (x - estimate) / counted;
      }
      EXPECT_LT(late, 0.35 * kStep_m) << speed << " m/s, " << period_s << " s";
      EXPECT_GT(late, (speed * period_s > kStep_m ? -0.45 : -0.1) * kStep_m) << speed << " m/s, " << period_s << " s";
    }
}

TEST(EdgeObserver, FollowsAJumpAndForgetsIt) {
  Follower follower(0);
  for (int i = 0; i < 100; ++i) follower.next(0);
  double estimate = 0;
  for (int i = 0; i < 2000; ++i) estimate = follower.next(400 * kStep_m);
  EXPECT_NEAR(estimate, 400 * kStep_m, 1e-6 * kStep_m);
}

// A jump carries the estimate along, and an edge soon after it is not a handle that goes on by as much: without speed
// the estimate comes to it and stays, but for what it goes to what is told in a millisecond (5 and 12 ms): 0.12 steps.
TEST(EdgeObserver, HasNoSpeedFromAJump) {
  Follower follower(0);
  for (int i = 0; i < 100; ++i) follower.next(0);
  follower.next(-400 * kStep_m);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(follower.next(-400 * kStep_m), -400 * kStep_m);
  const double on_edge = follower.next(-401 * kStep_m);
  EXPECT_NEAR(on_edge, -400.25 * kStep_m, 0.26 * kStep_m);
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(follower.next(-401 * kStep_m), on_edge, 0.15 * kStep_m);
}

TEST(EdgeObserver, WithoutStepsIsWhatIsTold) {
  EdgeMemory memory;
  EXPECT_EQ(between_edges(0, kPeriod_s, {1e-3, -2e-3, 0}, memory).x, 0);
  EXPECT_EQ(between_edges(0, kPeriod_s, {0, 0, 0}, memory).y, 0);
}

// Told now as one step and now as the other, it stays where they meet.
TEST(EdgeObserver, StaysOnAnEdge) {
  const double edge_m = 20.5 * kStep_m, speed = 0.01;
  Follower follower(0);
  double least = 1, most = -1;
  for (int i = 0; i < 4000; ++i) {
    const double way = speed * i * kPeriod_s;
    const double x = way < edge_m ? way : edge_m + (i % 4 < 2 ? 1e-9 : -1e-9);
    const double estimate = follower.next(quantised(x));
    if (i > 3000) least = std::min(least, estimate), most = std::max(most, estimate);
  }
  EXPECT_LT(most - least, 0.1 * kStep_m);  // what it goes towards either reading in two periods of the way's 5 ms
  EXPECT_NEAR(0.5 * (most + least), edge_m, 0.1 * kStep_m);
}

TEST(EdgeObserver, LeavesAHandleAtRestThatLittleFrictionHolds) {
  constexpr double kShare = 0.66;  // 0.55 to 0.6 is enough, and a tenth
  for (const double mass : {0.1, 0.15, 0.4})
    for (const double stiffness : {1300.0, 2700.0, 4000.0, 8000.0})
      for (const auto& [hand, damping] : {std::pair{100.0, 1.0}, {300.0, 5.0}, {800.0, 8.0}, {2000.0, 16.0}})
        for (const double aside_m : {6e-5, 3e-4, 1.5e-3})
          for (const double edge : {0.0, 0.25, 0.5}) {
            const double step_N = stiffness * kStep_m;
            const test::HeldHandle h{mass, 2.5, 0, kPeriod_s, hand, damping, 0, stiffness, kStep_m, 1.5};
            Follower follower(quantised(aside_m, edge));
            const auto next = [&](double told) { return follower.next(told); };
            EXPECT_LT(test::unrest_N(h, kShare * step_N, aside_m, edge, next), 0.02 * step_N)
                << mass << " kg, " << stiffness << " N/m, hand " << hand << ", " << aside_m << " m, " << edge;
          }
}

constexpr struct {
  double stiffness, damping, mass;
} kHands[] = {{100, 1, 0.05}, {300, 5, 0.1}, {800, 8, 0.1}, {2000, 16, 0.2}};

double unrest_N(const test::HeldHandle& h, double friction_N, double aside_m, double edge) {
  Follower follower(quantised(aside_m, edge));
  return test::unrest_N(h, friction_N, aside_m, edge, [&](double told) { return follower.next(told, h.period_s); });
}

// The controller's loop: with the friction that smoothing by edges asks for, and with more, every kick comes to rest.
TEST(EdgeObserver, LeavesAHandleAtRestThatTheFrictionAskedForHolds) {
  for (const double mass : {0.05, 0.1, 0.3, 0.5, 0.8})
    for (const auto& [damping, delay_s, period_s] : {std::tuple{0.5, 0.0, 1e-3},
                                                     {0.5, 5e-4, 1e-3},
                                                     {2.5, 5e-4, 1e-3},
                                                     {2.5, 3e-3, 1e-3},
                                                     {6.0, 1e-4, 1e-3},
                                                     {12.0, 3e-4, 1e-3},
                                                     {2.5, 5e-4, 2.4e-4},
                                                     {2.5, 5e-4, 2e-3}})
      for (const auto& hand : kHands) {
        const double stiffness = std::min(1e4, 0.8 * 2 * damping / (period_s + 2 * delay_s));
        const test::HeldHandle h{mass,         damping,   delay_s,   period_s, hand.stiffness,
                                 hand.damping, hand.mass, stiffness, kStep_m,  3};
        const double asked_N = friction_to_smooth(EncoderLaw::kEdges, kSmoothedPosition, stiffness, kStep_m, mass);
        for (const double more : {1.0, 1.3, 2.0})
          for (const double aside_m : {6e-5, 3e-4, 1.5e-3})
            for (const double edge : {0.0, 0.25, 0.5})
              EXPECT_LT(unrest_N(h, more * asked_N, aside_m, edge), 0.02 * stiffness * kStep_m)
                  << mass << " kg, " << stiffness << " N/m, " << period_s << " s, hand " << hand.stiffness << ", "
                  << aside_m << " m, " << edge << ", " << more;
      }
}

// And no friction that is not asked for: with two thirds of it some handle goes to and fro by half a step's force.
TEST(EdgeObserver, SetsAHandleWithLessFrictionGoing) {
  const test::HeldHandle h{0.1, 6, 1e-4, 1e-3, 100, 1, 0.05, 8000, kStep_m, 3};
  const double asked_N = friction_to_smooth(EncoderLaw::kEdges, kSmoothedPosition, 8000, kStep_m, 0.1);
  double most_N = 0;
  for (const double aside_m : {6e-5, 3e-4, 1.5e-3})
    for (const double edge : {0.0, 0.25, 0.5}) most_N = std::max(most_N, unrest_N(h, asked_N / 1.5, aside_m, edge));
  EXPECT_GT(most_N, 0.25 * 8000 * kStep_m);
}

// What a coupling's own bound leaves of friction, 0.625 of a step's torque, holds an angle on its track where the
// object turns with it, and not where that grips the tool firmly; followed by its edges the handle rests on either.
TEST(EdgeObserver, LeavesAnAngleAtRestThatAnObjectGripsFirmly) {
  constexpr double kStep_rad = 1e-3, kCoupling_Nm_per_rad = 0.8, kTick_s = 1e-3;
  const double step_Nm = kCoupling_Nm_per_rad * kStep_rad, friction_Nm = 0.625 * step_Nm;
  EXPECT_EQ(smoothing_need(kSmoothedAngle, kCoupling_Nm_per_rad, kStep_rad, 1e-4, friction_Nm).law,
            EncoderLaw::kMotion);
  const SmoothingNeed firm = smoothing_need(kSmoothedFirmAngle, kCoupling_Nm_per_rad, kStep_rad, 1e-4, friction_Nm);
  EXPECT_EQ(firm.law, EncoderLaw::kEdges);
  EXPECT_LE(firm.friction, friction_Nm);
  for (const double felt : {0.75, 1.0}) {
    double on_track_Nm = 0, by_edges_Nm = 0;
    for (const auto& [hand, damping] : {std::pair{0.3, 0.005}, {1.0, 0.02}, {2.0, 0.02}})
      for (const double aside_rad : {2e-3, 1e-2, 5e-2})
        for (const double edge : {0.0, 0.25, 0.5}) {
          const test::HeldHandle h{1e-4,      1e-3, 5e-4, kTick_s, hand, damping, 0, felt * kCoupling_Nm_per_rad,
                                   kStep_rad, 3};
          double at = test::told_m(aside_rad, kStep_rad, edge), per_s = 0, apart = 0, told = at;
          const ObserverGains gains = observer_gains(kObservedAngle, kStep_rad, kTick_s);
          const auto on_track = [&](double now) { return at += observe(gains, now - at, per_s, apart); };
          EdgeMemory memory;
          const auto by_edges = [&](double now) {
            const double change = now - std::exchange(told, now);
            return now + between_edges(kStep_rad, kTick_s, {change, 0, 0}, memory).x;
          };
          on_track_Nm = std::max(on_track_Nm, test::unrest_N(h, friction_Nm, aside_rad, edge, on_track));
          by_edges_Nm = std::max(by_edges_Nm, test::unrest_N(h, friction_Nm, aside_rad, edge, by_edges));
        }
    EXPECT_LT(by_edges_Nm, 1e-3 * step_Nm) << felt;
    if (felt < 1)
      EXPECT_LT(on_track_Nm, 1e-3 * step_Nm);
    else
      EXPECT_GT(on_track_Nm, 0.5 * step_Nm);  // 0.63, 2026-11-27
  }
}

// Friction decides who follows: the motion where it holds what that is late by, else the edges, which ask for less; of
// a heavy handle, or where turning asks for little, the edges have nothing to offer.
TEST(SmoothingNeed, TakesTheEdgesWhereTheMotionAsksForTooMuch) {
  const double step_N = 5000 * kStep_m;
  const auto need = [&](double friction_N, double mass) {
    return smoothing_need(kSmoothedPosition, 5000, kStep_m, mass, friction_N);
  };
  EXPECT_EQ(need(1.5 * step_N, 0.1).law, EncoderLaw::kMotion);
  for (const double share : {0.0, 0.6, 0.65, 1.0, 1.4}) {
    EXPECT_EQ(need(share * step_N, 0.1).law, EncoderLaw::kEdges) << share;
    EXPECT_EQ(need(share * step_N, 0.1).friction > share * step_N, share <= 0.6) << share;
    EXPECT_EQ(need(share * step_N, 2).law, EncoderLaw::kMotion) << share;
  }
  EXPECT_EQ(smoothing_need(kSmoothedAngle, 0.8, 1e-3, 1e-4, 1e-4).law, EncoderLaw::kMotion);
  EXPECT_EQ(smoothing_need(kSmoothedAngle, 2.5, 1e-3, 1e-4, 2e-3).law, EncoderLaw::kEdges);
}

}  // namespace
}  // namespace palpate
