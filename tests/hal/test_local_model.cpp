// The local contact model on the device: what it refuses and cuts down, what it does between two commands, and when it
// stops.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "hal/bus/codec.h"
#include "hal/bus/device_bus.h"
#include "hal/device/device_sim.h"
#include "hal/device/kinematics.h"

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

TEST(LocalModel, ADeviceWithoutItHoldsTheForce) {
  PlantOptions options;
  options.delay_ticks = 0;
  DevicePlant plant(options, HandPath({{0, {{0.01, 0, 0}, {}}}}));
  for (int i = 0; i < 5; ++i) plant.step({{1, 0, 0}, {}, CommandFlag::kEnable, wall(1000), 1});
  EXPECT_EQ(plant.motor().force_N.x, 1);
}

}  // namespace
}  // namespace palpate
