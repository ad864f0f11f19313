// Kinematics, hand path and simulated plant against closed forms; real-time set-up verdicts.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <random>

#include "hal/device/device_sim.h"
#include "hal/system/rt_linux.h"

namespace palpate {
namespace {

TEST(Kinematics, RoundTripsAndKeepsPower) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 500; ++i) {
    const auto vec = [&] { return Vec3{normal(random), normal(random), normal(random)}; };
    const auto quat = [&] { return normalised({normal(random), normal(random), normal(random), normal(random)}); };
    const CartesianKinematics k{vec(), quat(), std::exp(normal(random)), 10};
    ASSERT_TRUE(valid(k));
    DeviceSample sample;
    sample.position_m = vec();
    sample.orientation = quat();
    const Pose world = pose_in_world(k, sample);
    const Pose back = pose_in_device(k, world);
    EXPECT_LT(norm(back.position_m - sample.position_m), 1e-12);
    EXPECT_LT(norm(small_rotation_vector(back.orientation * conjugate(sample.orientation))), 1e-12);
    // Virtual work: force times velocity in the world is `scale` times that at the device, and so is torque times spin.
    const Vec3 v = vec(), spin = vec();
    const Wrench w{vec(), vec()};
    EXPECT_NEAR(dot(w.torque_Nm, rotate(k.orientation_w, spin)), k.scale * dot(wrench_in_device(k, w).torque_Nm, spin),
                1e-10);
    EXPECT_NEAR(dot(w.force_N, rotate(k.orientation_w, k.scale * v)), k.scale * dot(wrench_in_device(k, w).force_N, v),
                1e-10);
  }
  EXPECT_FALSE(valid({{}, {2, 0, 0, 0}, 1, 1}));
  EXPECT_FALSE(valid({{std::nan(""), 0, 0}, {}, 1, 1}));
  EXPECT_FALSE(valid({{}, {}, 0, 1}));
}

TEST(Kinematics, CountsSaturateAndNeverCarryNan) {
  EXPECT_EQ(to_counts(1e9, 1e-7, 24), 8388607);
  EXPECT_EQ(to_counts(-1e9, 1e-7, 24), -8388607);
  EXPECT_EQ(to_counts(std::nan(""), 1e-7, 24), 0);
  EXPECT_EQ(to_counts(HUGE_VAL, 1, 16), 0);
  EXPECT_EQ(to_counts(0.5, 1, 16), 1);
  EXPECT_EQ(to_counts(-0.5, 1, 16), -1);
  EXPECT_DOUBLE_EQ(from_counts(-300, 1e-7), -3e-5);
  Output output;
  output.device_w.force_N = {1, std::nan(""), 0};
  EXPECT_EQ(to_command({}, output, 1).force_N, Vec3{});
}

TEST(HandPath, StartsAndEndsAtRestAndPeaksAtTheKnownSpeed) {
  const HandPath path({{1, {}}, {3, {{0.2, 0, 0}, rotation_by({0, 0, 1})}}});
  EXPECT_EQ(path.at(0).pose.position_m, Vec3{});
  EXPECT_EQ(path.at(9).pose.position_m.x, 0.2);
  const HandTarget middle = path.at(2);
  EXPECT_NEAR(middle.pose.position_m.x, 0.1, 1e-15);
  EXPECT_NEAR(middle.velocity_m_per_s.x, 1.875 * 0.2 / 2, 1e-15);  // minimum jerk: 15/8 of the mean
  EXPECT_NEAR(rotation_vector(middle.pose.orientation).z, 0.5, 1e-12);
  EXPECT_NEAR(middle.spin_rad_per_s.z, 1.875 / 2, 1e-12);
  EXPECT_FALSE(HandPath({{1, {}}, {1, {}}}).error().empty());
  EXPECT_FALSE(HandPath({{1, {{std::nan(""), 0, 0}, {}}}}).error().empty());
}

PlantOptions oscillator() {
  PlantOptions o;
  o.mass_kg = 0.15;
  o.hand_mass_kg = 0.05;
  o.damping_N_s_per_m = 0.4;
  o.hand_damping_N_s_per_m = 0.6;
  o.hand_stiffness_N_per_m = 200;
  o.friction_N = 0;
  o.encoder_m = 0;
  o.delay_ticks = 0;
  o.force_max_N = 100;
  return o;
}

// Step response of M x'' + B x' + K x = F, underdamped.
double step_response(double F, double t) {
  const double M = 0.2, B = 1.0, K = 200;
  const double decay = B / (2 * M), w = std::sqrt(K / M - decay * decay);
  return F / K * (1 - std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t)));
}

// Second order: halving the substep divides the error by four.
TEST(Plant, FollowsTheMassSpringDamperSolution) {
  double error[2];
  for (int level = 0; level < 2; ++level) {
    PlantOptions o = oscillator();
    o.substeps = 20 << level;
    DevicePlant plant(o, HandPath());
    error[level] = 0;
    for (int i = 1; i <= 500; ++i) {
      plant.step({{1, 0, 0}, {}, CommandFlag::kEnable});
      error[level] = std::max(error[level], std::abs(plant.pose().position_m.x - step_response(1, i * 1e-3)));
    }
  }
  EXPECT_LT(error[0], 1e-8);  // of a 5 mm step
  EXPECT_NEAR(error[0] / error[1], 4, 0.1);
}

TEST(Plant, FrictionHoldsBelowItsLimitAndBrakesLinearlyAbove) {
  PlantOptions o = oscillator();
  o.hand_stiffness_N_per_m = o.hand_damping_N_s_per_m = o.damping_N_s_per_m = 0;
  o.friction_N = 0.5;
  DevicePlant stuck(o, HandPath());
  for (int i = 0; i < 100; ++i) stuck.step({{0.49, 0, 0}, {}, CommandFlag::kEnable});
  EXPECT_EQ(stuck.pose().position_m, Vec3{});
  DevicePlant sliding(o, HandPath());
  for (int i = 0; i < 100; ++i) sliding.step({{1.5, 0, 0}, {}, CommandFlag::kEnable});
  EXPECT_NEAR(sliding.velocity_m_per_s().x, (1.5 - 0.5) / 0.2 * 0.1, 1e-12);
  for (int i = 0; i < 300; ++i) sliding.step({});
  EXPECT_EQ(sliding.velocity_m_per_s(), Vec3{});  // stopped, after 0.5 v^2 M / f = 0.05 m
  EXPECT_NEAR(sliding.pose().position_m.x, 0.025 + 0.05, 1e-5);
}

TEST(Plant, DelayQuantisationAndSaturation) {
  PlantOptions o = oscillator();
  o.delay_ticks = 3;
  o.force_max_N = 2;
  o.encoder_m = 3e-5;
  DevicePlant plant(o, HandPath());
  for (int i = 0; i < 3; ++i) {
    plant.step({{3, 4, 0}, {}, CommandFlag::kEnable});
    EXPECT_EQ(plant.motor().force_N, Vec3{});
  }
  plant.step({});
  EXPECT_NEAR(plant.motor().force_N.x, 1.2, 1e-15);
  EXPECT_NEAR(plant.motor().force_N.y, 1.6, 1e-15);
  EXPECT_TRUE(plant.saturated());
  for (int i = 0; i < 20; ++i) plant.step({});
  const double counts = plant.measured_m().x / 3e-5;
  EXPECT_NEAR(counts, std::round(counts), 1e-9);
  EXPECT_LE(std::abs(plant.measured_m().x - plant.pose().position_m.x), 1.5001e-5);
  DevicePlant nan(oscillator(), HandPath());
  nan.step({{std::nan(""), 0, 0}, {0, HUGE_VAL, 0}, CommandFlag::kEnable});
  EXPECT_TRUE(is_finite(nan.pose()));
  DevicePlant disabled(oscillator(), HandPath());
  disabled.step({{1, 0, 0}, {}, 0});
  EXPECT_EQ(disabled.motor().force_N, Vec3{});
}

TEST(Plant, TurnsLikeATorsionOscillator) {
  PlantOptions o = oscillator();
  o.inertia_kg_m2 = 2e-4;
  o.friction_Nm = o.damping_Nm_s_per_rad = o.hand_damping_Nm_s_per_rad = 0;
  o.hand_stiffness_Nm_per_rad = 0.5;
  o.torque_max_Nm = 1;
  DevicePlant plant(o, HandPath());
  double worst = 0;
  for (int i = 1; i <= 200; ++i) {
    plant.step({{}, {0, 0.1, 0}, CommandFlag::kEnable});
    const double exact = 0.1 / 0.5 * (1 - std::cos(std::sqrt(0.5 / 2e-4) * i * 1e-3));
    worst = std::max(worst, std::abs(rotation_vector(plant.pose().orientation).y - exact));
  }
  EXPECT_LT(worst, 2e-5);  // of 0.4 rad; phase error w^3 dt^2 t / 12 = 5e-6 rad
}

TEST(Plant, SameSeedSameMotion) {
  PlantOptions o;
  o.noise_m = 1e-4;
  DevicePlant a(o, HandPath()), b(o, HandPath());
  o.noise_seed = 2;
  DevicePlant c(o, HandPath());
  int different = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 measured = a.measured_m();
    EXPECT_EQ(measured, b.measured_m());
    different += measured != c.measured_m();
    EXPECT_LE(abs_of(measured.x), 1.2e-4);
  }
  EXPECT_GT(different, 80);
}

// In a child without privileges: every measure is tried, each has a verdict, nothing aborts.
TEST(RtSetup, RefusalsAreVerdictsNotFailures) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_RTPRIO, &none);
    ::setrlimit(RLIMIT_MEMLOCK, &none);
    if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) ::_exit(2);
    RtOptions options;
    options.cpu = 100'000;
    const RtSetup setup(options);
    int wrong = setup.verdicts().size() == 6 && !setup.all_ok() ? 0 : 4;
    for (const RtVerdict& v : setup.verdicts()) {
      if (v.detail.empty() || v.ok != (v.error == 0)) wrong |= 8;
      if (v.item == "scheduler" && (v.ok || v.error != EPERM || v.detail.find("rtprio") == std::string::npos))
        wrong |= 16;
      if (v.item == "affinity" && (v.ok || v.error != EINVAL)) wrong |= 32;
      if (v.item == "stack" && !v.ok) wrong |= 64;
    }
    if (setup.text().find("REFUSED  scheduler") == std::string::npos) wrong |= 128;
    ::_exit(wrong);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(RtSetup, NothingAskedNothingDone) {
  const RtSetup setup({0, -1, false, false, 0, false});
  EXPECT_TRUE(setup.all_ok()) << setup.text();
  EXPECT_FALSE(RtSetup({100, -1, false, false, 0, false}).all_ok());  // no such priority
}

TEST(RtSetup, TermSetsTheFlag) {
  const std::atomic<bool>& stop = install_stop_signals();
  EXPECT_FALSE(stop.load());
  ::raise(SIGTERM);
  EXPECT_TRUE(stop.load());
  ::signal(SIGTERM, SIG_DFL);
  ::signal(SIGINT, SIG_DFL);
}

TEST(MonotonicClock, NeverReturnsBeforeTheDeadline) {
  MonotonicClock clock;
  const std::int64_t deadline_ns = clock.now_ns() + 2'000'000;
  clock.wait_until(deadline_ns);
  EXPECT_GE(clock.now_ns(), deadline_ns);
  clock.wait_until(0);  // long past: at once
}

}  // namespace
}  // namespace palpate
