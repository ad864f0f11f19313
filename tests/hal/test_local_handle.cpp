// Where a device with a loop of its own takes its handle to be: quiet on soft objects, by its encoder's edges on stiff
// ones, from one to the other without a step, and at rest with the friction that was asked for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "hal/device/local_handle.h"
#include "rt_core/safety/smoothing_friction.h"
#include "tests/support/held_handle.h"

namespace palpate {
namespace {

constexpr double kStep_m = 3e-5, kPeriod_s = 1e-4, kTwoPi = 6.283185307179586;
constexpr LocalHandle::Options kDevice{kStep_m, kPeriod_s, 0.1, 0.06};  // sim-6dof-local's
constexpr double kSoft_N_per_m = 1600, kStiff_N_per_m = 1800;           // 1701 is where its friction is just enough

// A device's loop on a spring of which the commands tell a part as the model's stiffness.
class OnSpring {
 public:
  OnSpring(const LocalHandle::Options& device, double at_m) : handle_(device, {at_m, 0, 0}), at_m_(at_m) {}
  double next(double told_m, double told_N_per_m, double spring_N_per_m) {
    constexpr double kPressed_N = 5;
    if (periods_++ % 10 == 0)
      handle_.obey({kPressed_N - spring_N_per_m * at_m_, 0, 0},
                   told_N_per_m > 0 ? LocalModel{{at_m_, 0, 0}, {told_N_per_m, 0, 0}, {}, 5e-3} : LocalModel{});
    return at_m_ = handle_.next({told_m, 0, 0}).x;
  }
  double next(double told_m, double spring_N_per_m) { return next(told_m, spring_N_per_m, spring_N_per_m); }

 private:
  LocalHandle handle_;
  double at_m_;
  int periods_ = 0;
};

// Where the encoder's edges have the handle, a period after the last time.
class ByEdges {
 public:
  double next(double told_m) {
    const double change_m = told_m - std::exchange(told_m_, told_m);
    return told_m + between_edges(kStep_m, kPeriod_s, {change_m, 0, 0}, edges_).x;
  }

 private:
  EdgeMemory edges_;
  double told_m_ = 0;
};

// RMS second difference over a millisecond of what it is off, in a tremor: the staircase that a hand feels. A lag,
// smooth at 9 Hz, is hardly in it.
double roughness_m(double stiffness_N_per_m, double amplitude_m) {
  const auto motion = [&](int i) { return 0.7e-5 + amplitude_m * std::sin(kTwoPi * 9 * kPeriod_s * i); };
  OnSpring handle(kDevice, test::told_m(motion(0), kStep_m));
  double last = 0, before = 0, sum = 0;
  for (int i = 0; i < 30000; ++i) {
    const double off = handle.next(test::told_m(motion(i), kStep_m), stiffness_N_per_m) - motion(i);
    if (i % 10 != 0) continue;
    const double bend = off - 2 * last + before;
    if (i >= 10000) sum += bend * bend;
    before = std::exchange(last, off);
  }
  return std::sqrt(sum / 2000);
}

TEST(LocalHandle, IsQuietOnASoftObject) {
  for (const double amplitude_m : {1.5e-5, 4e-5, 1e-4, 1.2e-4})
    EXPECT_LT(roughness_m(kSoft_N_per_m, amplitude_m), 0.5 * roughness_m(kStiff_N_per_m, amplitude_m)) << amplitude_m;
}

// On a stiff one, and on none, it is where the edges have it, to the bit; without an encoder's step where it is told.
TEST(LocalHandle, FollowsEdgesWhereFrictionIsNotEnough) {
  for (const double stiffness : {0.0, kStiff_N_per_m}) {
    OnSpring handle(kDevice, 0);
    ByEdges by_edges;
    for (int i = 0; i < 5000; ++i) {
      const double told = test::told_m(1e-4 * std::sin(kTwoPi * 9 * kPeriod_s * i), kStep_m);
      ASSERT_EQ(handle.next(told, stiffness), by_edges.next(told));
    }
  }
  OnSpring exact({0, kPeriod_s, 0.1, 0.06}, 0);
  EXPECT_EQ(exact.next(1.2345e-5, kSoft_N_per_m), 1.2345e-5);
}

// Told of no stiffness, with a model all the same, it is by the edges a hundredth of a second later, whatever commands
// added before: the next object may be stiff, and from the track it was met where the handle was not. A hold of snap_in
// went to and fro so, and gave a hand .6 mJ (2026-11-29).
TEST(LocalHandle, FollowsEdgesBetweenContacts) {
  LocalHandle handle(kDevice, {});
  ByEdges edges;
  double at_m = 0, apart_m = 0;
  for (int i = 0; i < 12000; ++i) {
    const bool touches = i < 10000;
    if (i % 10 == 0)
      handle.obey({touches ? 5 - kSoft_N_per_m * at_m : 0, 0, 0},
                  {{at_m, 0, 0}, {touches ? 0.8 * kSoft_N_per_m : 0, 0, 0}, {}, 5e-3});
    const double told = test::told_m(1e-4 * std::sin(kTwoPi * 9 * kPeriod_s * i), kStep_m);
    const double by_edges = edges.next(told);
    at_m = handle.next({told, 0, 0}).x;
    if (touches) apart_m = std::max(apart_m, std::abs(at_m - by_edges));
    if (i > 10110) {
      ASSERT_EQ(at_m, by_edges) << i;
    }
  }
  EXPECT_GT(apart_m, 0.3 * kStep_m);  // it was on the track
}

// Told half of what the object is, it goes by what the commands add: by the edges, as of one told all.
TEST(LocalHandle, SeesTheStiffnessThatItIsNotTold) {
  OnSpring half(kDevice, 0), all(kDevice, 0);
  for (int i = 0; i < 20000; ++i) {
    const double told = test::told_m(1e-4 * std::sin(kTwoPi * 9 * kPeriod_s * i), kStep_m);
    const double by_half = half.next(told, 0.5 * kStiff_N_per_m, kStiff_N_per_m);
    const double by_all = all.next(told, kStiff_N_per_m);
    if (i > 2000) {
      ASSERT_EQ(by_half, by_all) << i;
    }
  }
}

// An object that stiffens and softens in turn adds to what an edge moves the handle by no more than a fortieth of what
// edges and track are apart, two and a half steps at most; and it is never farther off than the track may be.
TEST(LocalHandle, GoesFromOneToTheOtherWithoutAStep) {
  const auto most_m = [](bool softens) {
    OnSpring handle(kDevice, 0);
    double before = 0, most = 0;
    for (int i = 0; i < 40000; ++i) {
      const double told = test::told_m(8e-5 * std::sin(kTwoPi * 9 * kPeriod_s * i), kStep_m);
      const double at = handle.next(told, softens && i / 300 % 2 == 0 ? kSoft_N_per_m : kStiff_N_per_m);
      EXPECT_LE(std::abs(at - told), 1.5 * kStep_m * (1 + 1e-9));
      most = std::max(most, std::abs(at - std::exchange(before, at)));
    }
    return most;
  };
  EXPECT_LT(most_m(true), most_m(false) + 2.5 * kStep_m / 40);
}

// An encoder that jumps takes the handle along, and is no speed: behind a jump of 4 mm the track would run on by steps.
TEST(LocalHandle, IsCarriedByAJumpAndHasNoSpeedFromIt) {
  OnSpring handle(kDevice, 0);
  for (int i = 0; i < 2000; ++i) handle.next(0, kSoft_N_per_m);
  for (int i = 0; i < 2000; ++i) EXPECT_NEAR(handle.next(4e-3, kSoft_N_per_m), 4e-3, 1e-3 * kStep_m);
}

TEST(LocalHandle, RestsWithTheFrictionAskedFor) {
  for (const double mass : {0.05, 0.1, 0.3})
    for (const double stiffness : {700.0, 1300.0, 2000.0, 3000.0})
      for (const double damping : {0.5, 2.5})
        for (const auto& [hand, hand_damping, hand_kg] :
             {std::tuple{100.0, 1.0, 0.05}, {800.0, 8.0, 0.1}, {2000.0, 16.0, 0.2}})
          for (const double aside_m : {3e-4, 1.5e-3})
            for (const double edge : {0.0, 0.25, 0.5}) {
              const test::HeldHandle h{mass, damping, 0, kPeriod_s, hand, hand_damping, hand_kg, stiffness, kStep_m, 3};
              const double friction_N =
                  1.2 * friction_to_smooth(EncoderLaw::kMotion, kSmoothedPosition, stiffness, kStep_m, mass);
              // Just enough but for what rounding makes of a force's change over its way.
              OnSpring handle({kStep_m, kPeriod_s, mass, friction_N * (1 + 1e-6)},
                              test::told_m(aside_m, kStep_m, edge));
              const auto told = [&](double told_m) { return handle.next(told_m, stiffness); };
              EXPECT_LT(test::unrest_N(h, friction_N, aside_m, edge, told), 0.02 * stiffness * kStep_m)
                  << mass << " kg, " << stiffness << " N/m, " << damping << " N s/m, hand " << hand << ", " << aside_m
                  << " m, " << edge;
            }
}

}  // namespace
}  // namespace palpate
