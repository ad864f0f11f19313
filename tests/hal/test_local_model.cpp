// The local contact model on the device: what it refuses and cuts down, what it does between two commands, and when it
// stops.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "hal/bus/codec.h"
#include "hal/bus/device_bus.h"
#include "hal/device/device_sim.h"
#include "hal/device/kinematics.h"
#include "rt_core/safety/device_shadow.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

LocalModel wall(double stiffness) { return {{0.01, 0, 0}, {stiffness, 0, 0}, {}, 3e-3}; }

TEST(LocalModel, IsRefusedWhereItIsNone) {
  EXPECT_EQ(bounded_model(wall(1000), 4000).along_N_per_m.x, 1000);
  for (int i = 0; i < 6; ++i) {
    LocalModel bad = wall(1000);
    (i == 0   ? bad.point_m.y
     : i == 1 ? bad.along_N_per_m.z
     : i == 2 ? bad.across_N_per_m.x
              : bad.valid_s) = i == 3   ? 6e-3
                               : i == 4 ? -1e-3
                                        : kNaN;
    EXPECT_EQ(bounded_model(bad, 4000).valid_s, 0) << i;
  }
}

// A stiffness that would push along with a motion is none: a diagonal below zero, or off-diagonals too large for it.
TEST(LocalModel, MustBePositiveSemiDefinite) {
  LocalModel model = wall(1000);
  model.along_N_per_m.y = -1;
  EXPECT_EQ(bounded_model(model, 4000).valid_s, 0);
  model = wall(1000);
  model.along_N_per_m.y = 1000;
  model.across_N_per_m.z = 999;
  EXPECT_GT(bounded_model(model, 4000).valid_s, 0);
  model.across_N_per_m.z = 1001;
  EXPECT_EQ(bounded_model(model, 4000).valid_s, 0);
  const Vec3 n = unit_or({1, 2, 3}, {});  // what a contact sends: k n n^T, singular
  const LocalModel slanted{{},
                           {900 * n.x * n.x, 900 * n.y * n.y, 900 * n.z * n.z},
                           {900 * n.y * n.z, 900 * n.x * n.z, 900 * n.x * n.y},
                           1e-3};
  EXPECT_GT(bounded_model(slanted, 4000).valid_s, 0);
}

TEST(LocalModel, IsNoStifferThanTheDeviceAllows) {
  EXPECT_NEAR(bounded_model(wall(9000), 4000).along_N_per_m.x, 4000, 1e-9);
  LocalModel held = wall(3900);  // by friction too: as stiff in each direction, and no stiffer in any
  held.along_N_per_m = {3900, 3900, 3900};
  EXPECT_EQ(bounded_model(held, 4000).along_N_per_m, held.along_N_per_m);
  // Whatever it was, it pushes by no more than 4000 N/m along any line.
  std::mt19937_64 draw(4);
  std::normal_distribution<double> part;
  for (int i = 0; i < 2000; ++i) {
    LocalModel model{{}, {}, {}, 1e-3};
    for (int k = 0; k < 3; ++k) {
      const Vec3 n{part(draw), part(draw), part(draw)};
      model.along_N_per_m += 3000 * Vec3{n.x * n.x, n.y * n.y, n.z * n.z};
      model.across_N_per_m += 3000 * Vec3{n.y * n.z, n.x * n.z, n.x * n.y};
    }
    const LocalModel bounded = bounded_model(model, 4000);
    const Vec3 d = bounded.along_N_per_m, o = bounded.across_N_per_m,
               u = unit_or({part(draw), part(draw), part(draw)}, {1, 0, 0});
    const Vec3 push{d.x * u.x + o.z * u.y + o.y * u.z, o.z * u.x + d.y * u.y + o.x * u.z,
                    o.y * u.x + o.x * u.y + d.z * u.z};
    ASSERT_LE(norm(push), 4000 * (1 + 1e-12)) << i;
  }
}

TEST(LocalModel, PushesByHookeAndNeverPullsBack) {
  const LocalModel model = wall(1000);
  EXPECT_NEAR(local_force_N({2, 0, 0}, model, {0.009, 0, 0}).x, 3, 1e-12);
  EXPECT_NEAR(local_force_N({2, 0, 0}, model, {0.011, 0, 0}).x, 1, 1e-12);
  EXPECT_EQ(local_force_N({2, 0, 0}, model, {0.020, 0, 0}).x, 0);  // beyond the surface
  EXPECT_EQ(local_force_N({0, 1, 0}, model, {0.009, 0, 0}).y, 1);  // across
}

// A contact without friction is stiff in one direction alone. Rounded to the wire's step it may seem to push in the
// others: whichever its direction, it is taken, and pushes by no more than the rounding.
TEST(LocalModel, IsTakenInEveryDirectionAfterRounding) {
  std::mt19937_64 draw(1);
  std::normal_distribution<double> part;
  for (const double k : {10.0, 100.0, 1000.0, 5000.0, 50000.0}) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3 n = unit_or({part(draw), part(draw), part(draw)}, {1, 0, 0});
      wire::LocalCommand command;
      wire::set_local(command,
                      {{}, k * Vec3{n.x * n.x, n.y * n.y, n.z * n.z}, k * Vec3{n.y * n.z, n.x * n.z, n.x * n.y}, 1e-3});
      const LocalModel taken = bounded_model(wire::get_local(command), 1e5);
      ASSERT_GT(taken.valid_s, 0) << k << " N/m along " << n.x << " " << n.y << " " << n.z;
      const Vec3 across = cross(n, unit_or({part(draw), part(draw), part(draw)}, {0, 1, 0}));
      ASSERT_LT(norm(local_force_N({}, taken, 1e-3 * across)), 1.5e-5 + 1e-12);
    }
  }
}

TEST(LocalModel, TravelsOnTheWire) {
  const Vec3 n = unit_or({1, -2, 3}, {});
  const LocalModel model{{0.0123456, -0.2, 0.3},
                         {2500 * n.x * n.x, 2500 * n.y * n.y, 2500 * n.z * n.z},
                         {2500 * n.y * n.z, 2500 * n.x * n.z, 2500 * n.x * n.y},
                         3e-3};
  wire::LocalCommand command;
  wire::set_local(command, model);
  const LocalModel back = wire::get_local(command);
  EXPECT_LT(norm(back.point_m - model.point_m), 1e-7);
  EXPECT_LT(norm(back.along_N_per_m - model.along_N_per_m), 0.01);
  EXPECT_LT(norm(back.across_N_per_m - model.across_N_per_m), 0.01);
  EXPECT_NEAR(back.valid_s, 3e-3, 1e-12);
  EXPECT_GT(bounded_model(back, 1e5).valid_s, 0);  // rounded, it is still positive semi-definite to a millionth
  wire::LocalCommand stiff;
  wire::set_local(stiff, wall(2e5));  // beyond the field
  EXPECT_NEAR(wire::get_local(stiff).along_N_per_m.x, 83886.07, 1e-6);
  wire::LocalCommand none;
  LocalModel bad = wall(1000);
  bad.across_N_per_m.y = kNaN;
  wire::set_local(none, bad);
  EXPECT_EQ(none, wire::LocalCommand{});
}

// Turned into a device whose x is the world's z, and whose motion is magnified five times: five times as stiff.
TEST(LocalModel, IsTurnedIntoTheDevicesFrame) {
  CartesianKinematics k;
  k.position_w = {0.1, 0.2, 0.3};
  k.orientation_w = rotation_between({1, 0, 0}, {0, 0, 1});
  k.scale = 5;
  Output output;
  output.handle_w_m = {0.1, 0.2, 0.35};
  output.felt_along_N_per_m = {0, 0, 700};
  const LocalModel model = local_model_in_device(k, output, 1e-3);
  EXPECT_NEAR(model.along_N_per_m.x, 3500, 1e-9);
  EXPECT_NEAR(model.along_N_per_m.y + model.along_N_per_m.z, 0, 1e-9);
  EXPECT_NEAR(model.point_m.x, 0.01, 1e-12);
}

// A mass on its own spring, commanded once: the device closes the loop by itself until the model is stale.
TEST(LocalModel, IsEvaluatedByTheDeviceUntilItIsStale) {
  PlantOptions options;
  options.encoder_m = options.friction_N = options.damping_N_s_per_m = 0;
  options.hand_mass_kg = options.hand_stiffness_N_per_m = options.hand_damping_N_s_per_m = 0;
  options.delay_ticks = 0;
  options.period_s = 1e-4;
  options.substeps = 1;
  options.local_Hz = 1e4;
  options.local_N_per_m = 5000;
  options.local_slope_share_per_ms = 0;  // any: from the first moment on
  DevicePlant plant(options, HandPath({{0, {{0.01, 0, 0}, {}}}}));
  DeviceCommand command{{1, 0, 0}, {}, CommandFlag::kEnable, wall(1000), 1};
  for (int i = 0; i < 30; ++i) {
    plant.step(command);
    // 1 N = 1 mm off: a cosine about 11 mm, at sqrt(1000 / 0.1) = 100 rad/s, late by half a device tick.
    EXPECT_NEAR(plant.pose().position_m.x, 0.011 - 0.001 * std::cos(100 * plant.time_s()), 2e-6) << i;
    EXPECT_NEAR(plant.motor().force_N.x, 1000 * (0.011 - plant.pose().position_m.x), 0.02) << i;
  }
  const double last_N = plant.motor().force_N.x;
  for (int i = 0; i < 20; ++i) plant.step(command);
  EXPECT_NEAR(plant.motor().force_N.x, last_N, 0.02);  // 3 ms are over: held
  command.flags = 0;
  plant.step(command);
  EXPECT_EQ(plant.motor().force_N.x, 0);
}

constexpr LocalLoop kLoop{1e-4, 8.5, 900};

// A first command that comes late, 0.5 mm in: what the handle's way makes is there at once, the rest by the slope.
TEST(LocalModel, AWayActsAtOnceAndACommandWithTheSlope) {
  const LocalModel model = wall(1000);  // its rest 2 mm off its point
  double x = 0.0115, force_N = 0;
  for (int i = 1; i <= 10; ++i) {
    const LocalWay way{{x, 0, 0}, {x -= 1e-5, 0, 0}};
    const double before_N = force_N;
    force_N = next_force_N(kLoop, {force_N, 0, 0}, {2, 0, 0}, model, way).x;
    const double wanted_N = 2 - 1000 * (x - 0.01);
    EXPECT_NEAR(force_N, std::min(wanted_N, before_N + 0.01 + 0.09), 1e-12) << i;
  }
  EXPECT_NEAR(force_N, 2 - 1000 * (x - 0.01), 1e-12);
}

// Whatever is between the force rendered and the spring's, while nothing takes from it a way in and out gives nothing.
TEST(LocalModel, ASpringOffItsRestGivesBackWhatItWasGiven) {
  LocalLoop loop = kLoop;
  loop.slope_N_per_s = 1e-9;
  LocalModel model = wall(1000);
  model.along_N_per_m.y = 600;
  model.across_N_per_m.z = -300;
  Vec3 force_N{1.5, 0.4, 0}, at{0.0101, 0.0002, 0};
  double work_J = 0, least_J = 0;
  constexpr int kSteps = 1000;
  for (int i = 1; i <= kSteps; ++i) {
    const double turn = 2 * kPi * i / kSteps;
    const Vec3 to{0.0101 - 0.0008 * std::sin(turn), 0.0002 + 0.0004 * (1 - std::cos(turn)), 0};
    const Vec3 before_N = force_N;
    force_N = next_force_N(loop, force_N, {2, 0, 0}, model, {at, to});
    work_J += 0.5 * dot(before_N + force_N, to - at);
    least_J = std::min(least_J, work_J);
    at = to;
  }
  EXPECT_LT(least_J, -1e-3);  // of so much
  EXPECT_NEAR(work_J, 0, 1e-9);
  EXPECT_NEAR(force_N.x, 1.5, 1e-6);
}

TEST(LocalModel, AnEncoderThatJumpsIsASlope) {
  const LocalModel model = wall(4000);
  const Vec3 jumped = next_force_N(kLoop, {2, 0, 0}, {2, 0, 0}, model, {{0.01, 0, 0}, {0.006, 0, 0}});
  EXPECT_NEAR(jumped.x, 2 + 0.09, 1e-12);
  const Vec3 moved = next_force_N(kLoop, {2, 0, 0}, {2, 0, 0}, model, {{0.01, 0, 0}, {0.0099, 0, 0}});
  EXPECT_NEAR(moved.x, 2 + 0.4, 1e-12);  // 1 m/s
}

// A force that is left over of another model does not pull the hand that leaves: it turns round against F no farther.
TEST(LocalModel, WhatIsLeftOverDoesNotPull) {
  Vec3 force_N;
  for (double x = 0.01; x < 0.013; x += 5e-5) {  // 0.5 mm in when it is told of 2 N
    force_N = next_force_N(kLoop, force_N, {2, 0, 0}, wall(4000), {{x, 0, 0}, {x + 5e-5, 0, 0}});
    ASSERT_GE(force_N.x, 0);
  }
  force_N = next_force_N(kLoop, {-1, 0, 0}, {2, 0, 0}, wall(4000), {{0.02, 0, 0}, {0.0201, 0, 0}});
  EXPECT_NEAR(force_N.x, -0.91, 1e-12);
}

// The controller's shadow of a device (rt_core/safety/device_shadow.h) against that device's own law, ten steps a tick:
// a hand that taps an object which stiffens, braked in every other tick on its way out, told after any delay. A step's
// own force, held for 0.1 ms on 0.5 m/s and 4 N/mm, is 0.1 N off the mean of it.
TEST(DeviceShadow, RendersWhatTheDeviceDoes) {
  constexpr double kTicks = 50, kDeep_m = 4e-3;
  for (const double delay_s : {0.0, 3e-4, 1e-3, 2.7e-3}) {
    Model model;
    model.params = test::tiny_params();
    ModelParams& p = model.params;
    p.local_period_s = 1e-4;
    p.encoder_step_m = 5e-5;
    p.delay_s = delay_s;
    const StatePtr state = test::roomy_state();
    SafetyState& safety = state->safety;
    const LocalLoop loop{1e-4, p.force_max_N, 1e3 * kLocalSlopeShare_per_ms * p.force_max_N, 5e-5};
    const auto place = [&](double ticks) { return Vec3{-kDeep_m * std::sin(2 * kPi * ticks / kTicks), 0, 0}; };
    std::vector<std::pair<Vec3, LocalModel>> told;
    Vec3 rendered_N, at_m = place(0);
    double worst_N = 0, work_J = 0, shadow_J = 0, given_J = 0;
    for (int n = 0; n < 200; ++n) {
      const double in_m = std::max(0.0, -place(n).x), stiffness = in_m > 0 ? 800 + 4e5 * in_m : 0;
      const double brake_N = n % 50 > 15 && n % 2 == 0 ? 0.8 : 0;
      const Vec3 force_N{std::max(0.0, 800 * in_m + 2e5 * in_m * in_m - brake_N), 0, 0};
      told.push_back({force_N, {place(n), {stiffness, 0, 0}, {}, kLocalValid_s}});
      safety.last_device_w.force_N = force_N;
      remember_told(safety, {{{stiffness, 0, 0}, {}}, place(n)});
      Vec3 mean_N;
      for (int i = 0; i < 10; ++i) {
        const auto command = static_cast<int>(std::floor(n + 0.1 * i - 1e3 * delay_s + 1e-6));
        const auto [now_N, local] =
            command < 0 ? std::pair{Vec3{}, LocalModel{}} : told[static_cast<std::size_t>(command)];
        const Vec3 to_m = place(n + 0.1 * i);
        rendered_N = next_force_N(loop, rendered_N, now_N, local, {at_m, to_m});
        at_m = to_m;
        mean_N += 0.1 * rendered_N;
      }
      state->device_previous_w.position_m = place(n);
      state->device_w.position_m = place(n + 1);
      const Vec3 shadow_N = shadow_device(model, *state), way_m = place(n + 1) - place(n);
      worst_N = std::max(worst_N, norm(shadow_N - mean_N));
      work_J += dot(mean_N, way_m);
      shadow_J += dot(shadow_N, way_m);
      given_J += std::max(0.0, dot(mean_N, way_m));
    }
    EXPECT_LT(worst_N, 0.1) << delay_s;
    EXPECT_GT(given_J, 0.02) << delay_s;  // in four taps
    // In the ticks in which a force begins, turns or ends 0.04 mJ each: 1.5 % of what a tap gives back.
    EXPECT_NEAR(shadow_J, work_J, 0.02 * given_J) << delay_s;
  }
}

// Coarse steps through a stiff spring leave less of the slope, a fine encoder's all of it, and never less than a half.
TEST(LocalModel, ACoarseEncoderLeavesLessOfTheSlope) {
  const auto step_N = [](double encoder_m, double stiffness) {
    LocalLoop loop = kLoop;
    loop.slope_N_per_s = 90 * loop.force_max_N;
    loop.encoder_step_m = encoder_m;
    return next_force_N(loop, {}, {2, 0, 0}, wall(stiffness), {{0.01, 0, 0}, {0.01, 0, 0}}).x;
  };
  EXPECT_NEAR(step_N(0, 2000), 9e-3 * 8.5, 1e-12);
  EXPECT_NEAR(step_N(2e-5, 1500), 9e-3 * 8.5, 1e-12);
  EXPECT_NEAR(step_N(1e-4, 2000), 0.1 * (0.098 * 8.5 - 1.3 * 0.2), 1e-12);  // a millisecond's: 1.3 steps of 0.2 N less
  EXPECT_NEAR(step_N(1e-3, 2000), 0.5 * 9e-3 * 8.5, 1e-12);
}

// Largest change of the force in a millisecond under commands that mean harm, on a handle that friction holds still
// behind an encoder that jumps.
double worst_step_N(double slope_share_per_ms) {
  std::mt19937_64 draw(3);
  std::uniform_real_distribution<double> part(-1, 1);
  const auto vector = [&] { return Vec3{part(draw), part(draw), part(draw)}; };
  PlantOptions options;
  options.friction_N = 1e3;
  options.delay_ticks = 0;
  options.period_s = 1e-4;
  options.substeps = 1;
  options.local_Hz = 1e4;
  options.local_N_per_m = 5000;
  options.local_slope_share_per_ms = slope_share_per_ms;
  DevicePlant plant(options, HandPath(std::vector<HandPose>(1)));
  DeviceCommand command;
  Vec3 past[11];
  double worst_N = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    if (draw() % 4 == 0) {
      const Vec3 n = unit_or(vector(), {1, 0, 0});
      const double k = 50'000 * std::abs(part(draw));
      command = {20.0 * vector(),
                 {},
                 CommandFlag::kEnable,
                 {0.01 * vector(), k * Vec3{n.x * n.x, n.y * n.y, n.z * n.z}, k * Vec3{n.y * n.z, n.x * n.z, n.x * n.y},
                  draw() % 3 == 0 ? 0.0 : 4e-3},
                 i + 1};
      if (draw() % 5 == 0) command.local.along_N_per_m = 1e4 * vector();
      if (draw() % 9 == 0) command.local.point_m.y = kNaN;
      if (draw() % 9 == 0) command.force_N.z = kNaN;
      if (draw() % 7 == 0) command.force_N = {};
    }
    if (draw() % 50 == 0) plant.shift_encoder(0.004 * unit_or(vector(), {1, 0, 0}));
    plant.step(command);
    EXPECT_LE(norm(plant.motor().force_N), 8.5 * (1 + 1e-12));
    past[i % 11] = plant.motor().force_N;
    if (i > 10) worst_N = std::max(worst_N, norm(past[i % 11] - past[(i + 1) % 11]));
  }
  return worst_N;
}
TEST(LocalModel, NoCommandChangesTheForceFasterThanTheSlope) {
  // An encoder's step smoothed to half of it through 5 N/mm adds 0.15 N at most (30 um on the way and back).
  EXPECT_LE(worst_step_N(kLocalSlopeShare_per_ms), 8.5 * kLocalSlopeShare_per_ms + 0.15);
  EXPECT_GT(worst_step_N(kLocalSlopeShare_per_ms), 8.5 * kLocalSlopeShare_per_ms - 1e-9);  // it is as hard as that
  EXPECT_GT(worst_step_N(0), 8.5);                                                         // without a slope
}

TEST(LocalModel, ADeviceWithoutItHoldsTheForce) {
  PlantOptions options;
  options.delay_ticks = 0;
  DevicePlant plant(options, HandPath({{0, {{0.01, 0, 0}, {}}}}));
  for (int i = 0; i < 5; ++i) plant.step({{1, 0, 0}, {}, CommandFlag::kEnable, wall(1000), 1});
  EXPECT_EQ(plant.motor().force_N.x, 1);
}

}  // namespace
}  // namespace palpate
