// The bench against closed forms: where a sampled spring begins to oscillate, what energy it moves, what its meters
// see.
#include <gtest/gtest.h>

#include <cmath>

#include "sim_host/feel/feel_meters.h"
#include "sim_host/feel/z_width.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

// A heavy mass oscillates slowly at the limit (1 kg: under 50 rad/s, 0.05 rad in a tick), so the held force is late by
// half a tick and the delay, and motion neither grows nor decays at K = 2b / (T + 2 tau); what is left is of second
// order in the angle per tick. Measured 2026-11-22: within 0.3 %.
TEST(FeelLoop, AHeavyMassSettlesUpToTheRule) {
  for (const double delay_s : {0.0, 5e-4, 1e-3}) {
    const BareDevice device{1, 1, delay_s};
    const double rule = rule_limit_N_per_m(device);
    EXPECT_NEAR(measured_limit_N_per_m(device) / rule, 1, 0.02) << delay_s;
  }
  EXPECT_DOUBLE_EQ(rule_limit_N_per_m({1, 1, 0}), 2000);
  EXPECT_DOUBLE_EQ(rule_limit_N_per_m({1, 1, 1e-3}), 2000.0 / 3);
}

// Friction holds what the encoder's step would drive: below 2 f_c / Delta a spring far beyond the damping's rule comes
// to rest, and above it the same one does not (Abbott & Okamura 2005). It may not begin fast: what sampling drives
// grows with the speed, friction does not, and from 10 mm the same spring diverges (Diolaiti et al. 2006).
TEST(FeelLoop, FrictionAgainstTheEncodersStep) {
  BareDevice device{0.2, 0, 0};
  device.encoder_m = 1e-4;
  device.start_m = 2e-3;
  device.friction_N = 0.2;  // 2 f_c / Delta = 4000 N/m
  EXPECT_TRUE(rests(device, 1000));
  device.start_m = 1e-2;
  EXPECT_FALSE(rests(device, 1000));
  device.start_m = 2e-3;
  device.friction_N = 0.002;  // 40 N/m
  EXPECT_FALSE(rests(device, 1000));
}

struct Ledger {
  double worst_J = 0, motor_J = 0;
  double way_m = 0;
};

Ledger press_spring(double stiffness, double hand_N_per_m, double depth_m, double delay_s) {
  FeelSetup setup;
  setup.plant.hand_stiffness_N_per_m = hand_N_per_m;
  setup.plant.tremor_m = 2e-5;
  setup.delay_s = delay_s;
  setup.path = HandPath({{0, {}}, {2, {{-depth_m, 0, 0}, {}}}, {2.5, {{-depth_m, 0, 0}, {}}}});
  Ledger ledger;
  run_feel_loop(
      setup,
      [&](const Input& input, Output& output) { output.device_w.force_N = -stiffness * input.pose_w.position_m; },
      [&](const FeelTick& now) {
        const PlantEnergy& e = now.energy;
        ledger.worst_J = std::max(ledger.worst_J, std::abs(e.motor_J + e.hand_J - e.lost_J - now.kinetic_J));
        ledger.motor_J = e.motor_J;
        ledger.way_m = -now.handle_w.position_m.x;
      });
  return ledger;
}

// Work of motors and hand less losses is the kinetic energy, to rounding, in every tick.
TEST(FeelLoop, TheLedgerCloses) {
  for (const double delay_s : {0.0, 3e-3}) EXPECT_LT(press_spring(400, 300, 0.02, delay_s).worst_J, 1e-12);
}

// A spring pressed slowly takes K x^2 / 2; the force held for a tick on a moving handle returns K T v^2 / 2 of it a
// second: 2 % is ten times that here (v about 10 mm/s; measured 2026-11-22: 0.4 %).
TEST(FeelLoop, AnAnalyticSpringStoresItsEnergy) {
  const Ledger pressed = press_spring(400, 300, 0.02, 0);
  EXPECT_NEAR(-pressed.motor_J / (0.5 * 400 * pressed.way_m * pressed.way_m), 1, 0.02);
}

TEST(FeelLoop, LosesAndShiftsSamplesAsTold) {
  FeelSetup setup;
  setup.plant.encoder_m = 0;
  setup.path = HandPath({{0, {}}, {0.1, {}}});
  setup.event = {{0.02, 3, {}}, {0.05, 0, {1e-3, 0, 0}}};
  int stale = 0, most = 0;
  double last_m = 0;
  run_feel_loop(
      setup, [](const Input&, Output&) {},
      [&](const FeelTick& now) {
        stale += now.input.stale_ticks > 0 ? 1 : 0;
        most = std::max(most, static_cast<int>(now.input.stale_ticks));
        last_m = now.input.pose_w.position_m.x;
      });
  EXPECT_EQ(stale, 3);
  EXPECT_EQ(most, 3);
  EXPECT_EQ(last_m, 1e-3);
  setup.event.clear();
  setup.sample_period_s = 2.5e-3;  // 400 a second in 100 ticks of 1 ms: 40 fresh
  stale = 0;
  run_feel_loop(
      setup, [](const Input&, Output&) {}, [&](const FeelTick& now) { stale += now.input.stale_ticks > 0 ? 1 : 0; });
  EXPECT_EQ(stale, 60);
}

TEST(FeelLoop, IsTheSameEveryTime) {
  EXPECT_EQ(press_spring(400, 300, 0.02, 1e-3).motor_J, press_spring(400, 300, 0.02, 1e-3).motor_J);
}

TEST(FeelMeters, SeeWhatBuzzes) {
  SwingMeter still(0.02), slow(0.02), buzzing(0.02);
  for (int i = 0; i < 100; ++i) {
    still.add(1 + (i % 2) * 0.01);
    slow.add(std::sin(0.1 * i));
    buzzing.add(i % 2 == 0 ? 1.65 : -1.65);
  }
  EXPECT_EQ(still.turns(), 0);
  EXPECT_LE(slow.longest(), 1);
  EXPECT_GT(buzzing.longest(), 90);
}

// A turn alone is a peak; with a second one behind it both count.
TEST(FeelMeters, TheFirstTurnOfASwingCounts) {
  SwingMeter peak(0.02), swing(0.02);
  for (const double x : {0.0, 1.0, 0.0, 0.0}) peak.add(x);
  for (const double x : {0.0, 1.0, 0.0, 1.0, 1.0}) swing.add(x);
  EXPECT_EQ(peak.turns(), 0);
  EXPECT_EQ(swing.turns(), 2);
}

// Torque is judged as force is: by its own limit, and not at all where a device has none. A coupling that is stretched
// beyond what the largest force or torque does is not held.
TEST(FeelMeters, SeeTorqueAndTheLeash) {
  ModelParams params = test::tiny_params();
  const auto figures = [&](double torque_Nm, double stretch_m, double stretch_rad) {
    FeelMeters meters(params, FeelSetup{});
    FeelTick tick;
    for (int i = 0; i < 20; ++i) {
      tick.time_s = 1e-3 * i;
      tick.output.device_w.torque_Nm.y = i % 2 == 0 ? torque_Nm : 0;
      tick.output.device_w.force_N.x = i >= 7 ? 0.05 * params.force_max_N : 0;
      tick.stretch_m = stretch_m;
      tick.stretch_rad = stretch_rad;
      meters.add(tick);
    }
    return meters.figures();
  };
  const double longest_m = params.force_max_N / params.coupling_N_per_m;
  const double longest_rad = params.torque_max_Nm / params.coupling_Nm_per_rad;
  const FeelFigures buzz = figures(0.03 * params.torque_max_Nm, 0.5 * longest_m, 0.7 * longest_rad);
  EXPECT_EQ(buzz.torque_alternations, 19);
  EXPECT_NEAR(buzz.torque_step_share, 0.03, 1e-12);
  EXPECT_NEAR(buzz.step_share, 0.05, 1e-12);
  EXPECT_NEAR(buzz.step_at_s, 7e-3, 1e-12);
  EXPECT_EQ(buzz.alternations, 0);
  EXPECT_NEAR(buzz.leash_share, 0.7, 1e-12);
  EXPECT_EQ(figures(0.015 * params.torque_max_Nm, 0, 0).torque_alternations, 0);
  EXPECT_NEAR(figures(0, 3 * longest_m, 0).leash_share, 3, 1e-12);
  params.torque_max_Nm = 0;
  EXPECT_EQ(figures(0.1, 0, 1).torque_alternations, 0);
  EXPECT_EQ(figures(0.1, 0, 1).leash_share, 0);
}

// A handle that goes 3 mm along one axis and 4 along another, 7 of an encoder's steps of 30 um behind 2 N/mm and 5 of
// 40 mN of friction; the object on the tool is a spring of 1.5 N/mm where it presses, whatever the tool does along it.
// Without contact the way counts nothing.
TEST(FeelMeters, TellTheObjectAndWhatAnEncoderCanGive) {
  ModelParams params = test::tiny_params();
  params.coupling_N_per_m = 2000;
  FeelSetup setup;
  setup.plant.encoder_m = 3e-5;
  setup.plant.friction_N = 0.04;
  for (const double force_N : {0.0, 1.0}) {
    FeelMeters meters(params, setup);
    FeelTick tick;
    tick.output.device_w.force_N.y = force_N;
    meters.add(tick);
    for (int i = 0; i < 10; ++i) {
      tick.handle_w.position_m += Vec3{3e-4, -4e-4, 0};
      meters.add(tick);
    }
    EXPECT_NEAR(meters.figures().quantum_J, force_N > 0 ? 0.06 * 7e-3 - 0.04 * 5e-3 : 0, 1e-12);
    EXPECT_EQ(meters.figures().object_N_per_m, 0);  // a still tool
  }
  FeelMeters pressed(params, setup);
  FeelTick tick;
  for (int i = 0; i < 12; ++i) {
    const double aside_m = 1e-4 * (i % 3), in_m = 1e-5 * (i % 4);
    tick.output.tool_w.position_m = {0, -in_m, aside_m};
    tick.output.contact_w.force_N = {0, 7 + 1500 * in_m, 0};
    pressed.add(tick);
  }
  EXPECT_NEAR(pressed.figures().object_N_per_m, 1500, 1e-6);
  EXPECT_EQ(pressed.figures().coupling_N_per_m, 2000);
}

// Of a device that makes a spring's force by itself, motors that follow the handle are no step, whatever the command
// says; what they change beyond that is, and so is their swinging.
TEST(FeelMeters, AStepIsWhatTheDeviceHadNotMadeByItself) {
  ModelParams params = test::tiny_params();
  const auto figures = [&](double unmoved_N, double swing_N) {
    FeelMeters meters(params, FeelSetup{});
    FeelTick tick;
    for (int i = 0; i < 20; ++i) {
      tick.output.device_w.force_N.x = std::min(params.force_max_N, 0.8 * i);
      tick.rendered_N.x = 0.4 * i + (i % 2 == 0 ? swing_N : 0);
      tick.unmoved_N.x = i < 10 ? 0 : unmoved_N;
      meters.add(tick);
    }
    return meters.figures();
  };
  EXPECT_NEAR(figures(0.3, 0).step_share, 0.8 / params.force_max_N, 1e-12);
  EXPECT_EQ(figures(0, 2).alternations, 0);
  params.local_period_s = 1e-4;
  EXPECT_EQ(figures(0, 0).step_share, 0);
  EXPECT_NEAR(figures(0.3, 0).step_share, 0.3 / params.force_max_N, 1e-12);
  EXPECT_EQ(figures(0, 0).alternations, 0);
  EXPECT_GT(figures(0, 2).alternations, 15);
}

// The device's ledger of it: a tap of 0.3 m/s on a spring of 4 N/mm raises its force by 1.2 N a tick and is no step but
// for the encoder's; an encoder that jumps is one of its slope.
TEST(FeelLoop, TellsWhatTheHandleDidNotMake) {
  for (const bool jumps : {false, true}) {
    FeelSetup setup;
    setup.plant.local_Hz = 1e4;
    setup.plant.local_N_per_m = 5000;
    setup.plant.hand_stiffness_N_per_m = 5000;
    setup.path = HandPath({{0, {}}, {0.02, {{-2e-3, 0, 0}, {}}}, {0.04, {{-2e-3, 0, 0}, {}}}});
    if (jumps) setup.event = {{0.03, 0, {1.5e-3, 0, 0}}};
    double step_N = 0, change_N = 0;
    FeelTick last;
    run_feel_loop(
        setup,
        [&](const Input& input, Output& output) {
          output.device_w.force_N = {4 - 4000 * input.pose_w.position_m.x, 0, 0};
          output.handle_w_m = input.pose_w.position_m;
          output.felt_along_N_per_m = {4000, 0, 0};
        },
        [&](const FeelTick& now) {
          if (now.time_s > 0.01) {  // it has come to the 4 N
            step_N = std::max(step_N, norm(now.unmoved_N - last.unmoved_N));
            change_N = std::max(change_N, norm(now.rendered_N - last.rendered_N));
          }
          last = now;
        });
    EXPECT_GT(change_N, 0.4);
    EXPECT_LT(step_N, (jumps ? kLocalSlopeShare_per_ms * 8.5 : 0) + 4000 * 1.5 * 3e-5);  // and the smoothing's reach
    EXPECT_EQ(step_N > 0.5, jumps);
  }
}

// A sine within the band counts with its RMS; one below it does not; the window's leakage is below a percent.
TEST(FeelMeters, NoiseIsThatOfTheBand) {
  std::vector<double> inside, below;
  for (int i = 0; i < 1000; ++i) {
    inside.push_back(5 + 0.1 * std::sin(2 * kPi * 0.2003 * i));
    below.push_back(5 + 0.1 * std::sin(2 * kPi * 0.0093 * i));
  }
  EXPECT_NEAR(band_rms(inside, 1e-3, 50, 500), 0.1 / std::sqrt(2.0), 1e-3);
  EXPECT_LT(band_rms(below, 1e-3, 50, 500), 1e-5);
}

}  // namespace
}  // namespace palpate
