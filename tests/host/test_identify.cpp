// A device's numbers come back from a motion of its handle, and nothing moves where it must not.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "hal/device/device_sim.h"
#include "sim_host/doctor/identify.h"

namespace palpate::test {
namespace {

PlantOptions free_handle(double mass_kg, double damping, double friction_N, double encoder_m, double delay_s) {
  PlantOptions plant;
  plant.mass_kg = mass_kg, plant.damping_N_s_per_m = damping, plant.friction_N = friction_N;
  plant.encoder_m = encoder_m;
  plant.hand_mass_kg = plant.hand_stiffness_N_per_m = plant.hand_damping_N_s_per_m = 0;
  plant.period_s = 1e-4, plant.substeps = 2;
  plant.delay_ticks = static_cast<int>(std::lround(delay_s / plant.period_s));
  return plant;
}

class OnBench : public testing::Test {
 protected:
  Identified measure(const PlantOptions& plant) {
    SimulatedDevice device(plant, HandPath(), clock_);
    most_N_ = most_m_ = last_N_ = 0;
    return identify({1e-3,
                     [&](DeviceSample& sample) {
                       device.receive(sample);
                       most_m_ = std::max(most_m_, std::abs(device.plant().pose().position_m.x));
                       if (spoil_) spoil_(sample, tick_);
                       tick_ += 1;
                     },
                     [&](const DeviceCommand& command) {
                       last_N_ = command.force_N.x;
                       most_N_ = std::max(most_N_, std::abs(last_N_));
                       device.transmit(command);
                     },
                     [&] { clock_.advance(1'000'000); }},
                    limits_);
  }
  // Refused for this reason, with nothing on the motors in the end.
  void expect_refused(const PlantOptions& plant, const std::string& why) {
    const Identified found = measure(plant);
    EXPECT_NE(found.refused.find(why), std::string::npos) << found.refused;
    EXPECT_EQ(last_N_, 0);
  }
  VirtualClock clock_;
  IdentifyLimits limits_;
  std::function<void(DeviceSample&, int tick)> spoil_;
  int tick_ = 0;
  double most_N_ = 0, most_m_ = 0, last_N_ = 0;
};

struct Known {
  double mass_kg, damping, friction_N, encoder_m, delay_s;
};

// The fit's model is integrated as the plant is not: friction and forces are those of 0.1 ms. Mass within 3 %, damping
// within 5 % and 0.03 N s/m (at 4 to 20 Hz a light damping is a small share of the force), friction within 5 % and 5
// mN, the delay within 0.15 ms (measured 2026-11-23: 0.11 at worst), a tenth of what the coupling's bound has in 2 tau
// + T.
TEST_F(OnBench, TheNumbersComeBack) {
  for (const Known& k : {Known{0.1, 2.5, 0.06, 3e-5, 5e-4},
                         {0.05, 0.1, 0.03, 1e-5, 1e-3},
                         {0.1, 0.5, 0.05, 1e-4, 3e-3},
                         {0.4, 1.0, 0.15, 3e-5, 0},
                         {0.1, 2.5, 0.06, 0, 2e-3}}) {
    const Identified found = measure(free_handle(k.mass_kg, k.damping, k.friction_N, k.encoder_m, k.delay_s));
    ASSERT_EQ(found.refused, "") << k.mass_kg;
    EXPECT_NEAR(found.fit.mass_kg, k.mass_kg, 0.03 * k.mass_kg);
    EXPECT_NEAR(found.fit.damping_Ns_per_m, k.damping, 0.05 * k.damping + 0.03) << k.mass_kg;
    EXPECT_NEAR(found.fit.friction_N, k.friction_N, 0.05 * k.friction_N + 5e-3) << k.mass_kg;
    EXPECT_NEAR(found.fit.delay_s, k.delay_s, 1.5e-4) << k.mass_kg;
    EXPECT_NEAR(found.encoder_step_m, k.encoder_m, 0.01 * k.encoder_m) << k.mass_kg;
    EXPECT_LT(most_m_, limits_.travel_m);
    EXPECT_LE(most_N_, limits_.force_N);
  }
}

TEST_F(OnBench, AHandOnTheHandleIsNoticed) {
  PlantOptions held = free_handle(0.1, 2.5, 0.06, 3e-5, 5e-4);
  held.hand_mass_kg = 0.1, held.hand_stiffness_N_per_m = 300, held.hand_damping_N_s_per_m = 5;
  expect_refused(held, "let go of it");
  held.hand_stiffness_N_per_m = 3000;
  expect_refused(held, "somebody holds");
}

TEST_F(OnBench, WhatIsNotSafeIsRefused) {
  const PlantOptions plant = free_handle(0.1, 2.5, 0.06, 3e-5, 5e-4);
  spoil_ = [](DeviceSample& sample, int) { sample.flags &= ~DeviceFlag::kCalibrated; };
  expect_refused(plant, "not calibrated");
  EXPECT_EQ(most_N_, 0);  // found before anything moved
  spoil_ = [](DeviceSample& sample, int) { sample.flags |= DeviceFlag::kStopButton; };
  expect_refused(plant, "emergency stop");
  EXPECT_EQ(most_N_, 0);
  spoil_ = [](DeviceSample& sample, int tick) { sample.position_m.x += 2e-6 * tick; };
  tick_ = 0;
  expect_refused(plant, "moves by itself");
  EXPECT_EQ(most_N_, 0);
}

TEST_F(OnBench, WhatHappensOnTheWayEndsIt) {
  const PlantOptions plant = free_handle(0.1, 2.5, 0.06, 3e-5, 5e-4);
  const auto from = [&](int tick, std::function<void(DeviceSample&)> what) {
    tick_ = 0;
    spoil_ = [tick, what](DeviceSample& sample, int now) {
      if (now >= tick) what(sample);
    };
  };
  from(900, [](DeviceSample& sample) { sample.fresh = false; });
  expect_refused(plant, "samples stopped");
  EXPECT_GT(most_N_, 0);
  from(900, [](DeviceSample& sample) { sample.position_m.x += 0.02; });
  expect_refused(plant, "somebody moved it");
  from(900, [](DeviceSample& sample) { sample.flags |= DeviceFlag::kError; });
  expect_refused(plant, "reports an error");
  spoil_ = nullptr;
  limits_.travel_m = 1e-3;
  expect_refused(plant, "left 1 mm");
  limits_ = {};
  expect_refused(free_handle(0.1, 2.5, 5, 3e-5, 5e-4), "nothing moves under 2 N");
}

TEST(Identify, WritesAProfileThatReads) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("palpate_identify_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string to = (folder / "measured.toml").string(), from = PALPATE_SOURCE_DIR "/config/devices/sim-6dof.toml";
  EXPECT_EQ(identify_simulated(from, to).refused, "");
  std::string error;
  const auto known = read_device_profile(from, error), read = read_device_profile(to, error);
  ASSERT_TRUE(read) << error;
  EXPECT_EQ(read->force_max_N, known->force_max_N);
  EXPECT_NEAR(read->mass_kg, known->mass_kg, 0.03 * known->mass_kg);
  EXPECT_NEAR(read->delay_s, known->delay_s, 1.5e-4);
  EXPECT_NEAR(read->encoder_step_m, known->encoder_step_m, 0.01 * known->encoder_step_m);
  EXPECT_THROW(identify_simulated((folder / "none.toml").string(), to), std::runtime_error);
  EXPECT_THROW(identify_simulated(from, (folder / "no" / "where.toml").string()), std::runtime_error);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace palpate::test
