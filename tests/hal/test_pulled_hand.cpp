// The simulated hand while somebody pulls it: it goes there, smoothly, no faster than a hand, and stays.
#include <gtest/gtest.h>

#include <algorithm>

#include "hal/device/device_sim.h"

namespace palpate {
namespace {

constexpr double kPeriod_s = 1e-3;

TEST(PulledHand, GoesWhereItIsToldAndStays) {
  DevicePlant plant({}, HandPath({{0, {{0, 0.1, 0}, {}}}}));
  for (int i = 0; i < 200; ++i) plant.step({});
  const Vec3 start = plant.pose().position_m, end{0.03, 0.08, 0.01};
  double fastest = 0, step = 0;
  for (int i = 0; i < 1500; ++i) {
    const Vec3 before = plant.pose().position_m;
    // A mouse speaks sixty times a second; what it said last holds in between.
    if (i % 16 == 0) plant.pull({end, rotation_by({0, 0, 0.3})}, false);
    plant.step({});
    fastest = std::max(fastest, norm(plant.pose().position_m - before) / kPeriod_s);
    step = std::max(step, norm(plant.pose().position_m - before));
  }
  // Coulomb friction holds the handle up to 0.05 N / 300 N/m = 0.17 mm short.
  EXPECT_LT(norm(plant.pose().position_m - end), 2e-4);
  EXPECT_NEAR(rotation_vector(plant.pose().orientation).z, 0.3, 2e-3);  // 1e-3 Nm of friction over 1 Nm/rad
  EXPECT_GT(norm(end - start), 0.03);
  EXPECT_LT(fastest, 1.2);  // 1 m/s of the hand, and what its spring swings over
}

TEST(PulledHand, AJumpOfTheMouseIsNoJumpOfTheHand) {
  DevicePlant plant({}, HandPath({{0, {{0, 0.1, 0}, {}}}}));
  plant.step({});
  plant.pull({{0.5, 0.1, 0}, {}}, true);
  EXPECT_TRUE(plant.trigger());
  Vec3 velocity;
  for (int i = 0; i < 100; ++i) {
    plant.step({});
    // The hand itself is at 1 m/s within some milliseconds; the handle, 0.2 kg on 300 N/m and 5 Ns/m, swings after it:
    // w = 38.7/s, so at most about 1 m/s * w + 5 N / 0.2 kg = 64 m/s^2. A jump would be 0.4 m * w^2 = 600 m/s^2.
    EXPECT_LT(norm(plant.velocity_m_per_s() - velocity), 0.065) << i;
    velocity = plant.velocity_m_per_s();
  }
}

TEST(PulledHand, LeavesItsPathWithoutAJump) {
  DevicePlant plant({}, HandPath({{0, {{0, 0.1, 0}, {}}}, {1, {{0.1, 0.1, 0}, {}}}}));
  for (int i = 0; i < 500; ++i) plant.step({});  // half way, at 0.19 m/s
  const Vec3 before = plant.velocity_m_per_s();
  EXPECT_GT(norm(before), 0.1);
  plant.pull(plant.pose(), false);
  plant.step({});
  EXPECT_LT(norm(plant.velocity_m_per_s() - before), 0.02);
}

}  // namespace
}  // namespace palpate
