// Forces limited where they arise, damping that balances what sampling makes, energy that is drained, and the detectors
// of what none of them holds: each fires in a test of its own.
#include <gtest/gtest.h>

#include <cmath>

#include "rt_core/contact/contact.h"
#include "rt_core/contact/contact_stiffness.h"
#include "rt_core/safety/hand_energy.h"
#include "rt_core/tick.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

Pose at(Vec3 position_m, Vec3 turn_rad = {}) { return {position_m, small_rotation(turn_rad)}; }

TEST(HeldEnd, IsTheHandleUntilTheDeviceIsBeaten) {
  Model model;
  model.params = tiny_params();  // 8.5 N, 1500 N/m: 5.67 mm; 0.2 N m, 0.5 N m/rad: 0.4 rad
  std::uint32_t status = 0;
  const Pose tool = at({0.1, 0, 0}), near = at({0.1, 0.005, 0}, {0, 0.3, 0}), far = at({0.1, 0.05, 0});
  EXPECT_EQ(held_end(model, near, tool, status).position_m, near.position_m);
  EXPECT_EQ(status, 0u);
  EXPECT_NEAR(held_end(model, far, tool, status).position_m.y, 8.5 / 1500, 1e-15);
  EXPECT_EQ(status, Status::kForceClamped);
  status = 0;
  const Pose turned = held_end(model, at({0.1, 0, 0}, {0.9, 0, 0}), tool, status);
  EXPECT_EQ(status, Status::kTorqueClamped);
  EXPECT_NEAR(norm(coupling_wrench(model, turned, tool).torque_Nm), 0.2, 0.2 * 0.01);
  status = 0;
  model.params.torque_max_Nm = 0;  // three motors: the tool turns with the handle
  EXPECT_EQ(held_end(model, at({0.1, 0, 0}, {0.9, 0, 0}), tool, status).orientation, at({}, {0.9, 0, 0}).orientation);
  EXPECT_EQ(status, 0u);
}

TEST(WithinStep, BoundsWhatTheToolDoesByItself) {
  Model model;
  model.params = tiny_params();
  const StatePtr state = roomy_state();
  state->safety.mode = Mode::kForce;
  const double own_m = kCalmStepShare * 8.5 / 1500;
  std::uint32_t status = 0;
  EXPECT_EQ(within_step(model, *state, at({0.9 * own_m, 0, 0}), status).position_m.x, 0.9 * own_m);
  EXPECT_EQ(status, 0u);
  EXPECT_NEAR(within_step(model, *state, at({0.01, 0, 0}), status).position_m.x, own_m, 1e-15);
  EXPECT_EQ(status, Status::kToolHeldBack);
  state->device_w = at({0, 0, 1e-4});  // the hand moves by 0.1 mm: so may the tool
  EXPECT_NEAR(within_step(model, *state, at({0.01, 0, 0}), status).position_m.x, own_m + 1e-4, 1e-15);
  state->device_w = at({0, 0, 2.5e-4});  // by more: a quarter of it besides
  EXPECT_NEAR(within_step(model, *state, at({0.01, 0, 0}), status).position_m.x, 1.25 * 2.5e-4, 1e-15);
  state->device_w = at({0, 0, 0.002});  // but never eight times as far as by itself
  EXPECT_NEAR(within_step(model, *state, at({0.01, 0, 0}), status).position_m.x, 8 * own_m + 0.002, 1e-15);
  state->safety.swings = 1;
  EXPECT_NEAR(within_step(model, *state, at({0.01, 0, 0}), status).position_m.x, 8 * own_m / 5 + 0.002, 1e-15);
  state->safety.swings = 0;
  state->device_w = {};
  state->safety.mode = Mode::kIdle;  // renders nothing: no step is felt, and it is eight times as wide
  EXPECT_NEAR(within_step(model, *state, at({0.01, 0, 0}), status).position_m.x, 8 * own_m, 1e-15);
  state->safety.mode = Mode::kForce;
  model.params.friction_law = FrictionLaw::kPaper;  // gives energy back: as wide
  EXPECT_NEAR(within_step(model, *state, at({0.01, 0, 0}), status).position_m.x, 8 * own_m, 1e-15);
}

// Behind a coupling so soft that a hundredth of its stretch is millimetres, no faster than a quarter of a metre a
// second; turns are as they were.
TEST(WithinStep, OfASoftCouplingIsNoFasterThanAHand) {
  Model model;
  model.params = tiny_params();
  model.params.coupling_N_per_m = 50;  // 170 mm
  const StatePtr state = roomy_state();
  state->safety.mode = Mode::kForce;
  std::uint32_t status = 0;
  const double own_m = 0.25 * model.params.period_s, own_rad = kCalmStepShare * 0.4;
  EXPECT_NEAR(within_step(model, *state, at({0.01, 0, 0}), status).position_m.x, own_m, 1e-15);
  EXPECT_EQ(status, Status::kToolHeldBack);
  const Pose turned = within_step(model, *state, at({}, {0, 0.1, 0}), status);
  EXPECT_NEAR(small_rotation_vector(turned.orientation).y, own_rad, 1e-6);
  state->device_w = at({0, 0, 0.002});  // a fast hand's: a quarter of its way
  EXPECT_NEAR(within_step(model, *state, at({0.01, 0, 0}), status).position_m.x, 1.25 * 0.002, 1e-15);
}

// Of a contact that pushes along one slanted direction: the springs in series along it, nothing across.
TEST(FeltStiffness, IsCouplingAndContactInSeries) {
  Model model;
  model.params = tiny_params();  // 1500 N/m
  model.params.local_period_s = 1e-4;
  const StatePtr state = roomy_state();
  const ScratchPtr scratch = roomy_scratch();
  scratch->status = 0;
  scratch->held_by_hand = scratch->contact_count = 1;
  scratch->told_besides = {};
  const Vec3 n = unit_or({1, 2, 3}, {});
  ContactStiffness contact;
  add_spring(contact, 3000, n, {});
  store(contact, state->contact_stiffness);
  const FeltStiffness felt = felt_stiffness(model, *state, *scratch);
  const double series = 1500.0 * 3000 / 4500;
  EXPECT_NEAR(norm(felt.along - series * Vec3{n.x * n.x, n.y * n.y, n.z * n.z}), 0, 1e-9);
  EXPECT_NEAR(norm(felt.across - series * Vec3{n.y * n.z, n.x * n.z, n.x * n.y}), 0, 1e-9);
  state->live.stiffness = 2;  // contact of 6000 N/m, found in units of two newtons
  EXPECT_NEAR(felt_stiffness(model, *state, *scratch).along.z, 1500.0 * 6000 / 7500 * n.z * n.z, 1e-9);
  state->live.stiffness = 1;
  scratch->contact_count = 0;
  EXPECT_EQ(felt_stiffness(model, *state, *scratch).along, Vec3{});
  scratch->contact_count = 1;
  // What slips before long is taken off it; what a tool has come to and does not press yet holds it all the same.
  add_spring(scratch->told_besides, -2000, n, {});
  EXPECT_NEAR(felt_stiffness(model, *state, *scratch).along.z, 1500.0 * 1000 / 2500 * n.z * n.z, 1e-9);
  for (double& k : state->contact_stiffness) k = 0;
  scratch->contact_count = 0;
  scratch->told_besides = {};
  add_spring(scratch->told_besides, 4500, n, {});
  EXPECT_NEAR(felt_stiffness(model, *state, *scratch).along.z, 1500.0 * 4500 / 6000 * n.z * n.z, 1e-9);
  scratch->contact_count = 1;
  model.params.local_period_s = 0;  // a device that holds forces
  EXPECT_EQ(felt_stiffness(model, *state, *scratch).along, Vec3{});
}

// A handle that moves by 0.4 mm a tick towards and through the place where the force ends at F_max, and back: the share
// told is the secant of min(K x, F_max) over each way, whatever part of it lies on either side.
TEST(FeltStiffness, OfWhatIsLeftBeforeTheLargestForce) {
  Model model;
  model.params = tiny_params();
  model.params.local_period_s = 1e-4;
  const double coupling = model.params.coupling_N_per_m, force_N = model.params.force_max_N;
  const double series = 500;  // with a softer object: the handle goes as much farther as it gives way
  const FeltStiffness felt{{series, 0, 0}, {}};
  const StatePtr state = roomy_state();
  const auto force_at = [&](double x_m) { return std::min(force_N, series * x_m); };  // handle at x, of the contact
  const double limit_m = force_N / series;
  for (const double tick_m : {4e-4, -4e-4, 1e-5, -1e-5})
    for (const double from_ticks : {-1.0, 0.0})
      for (double x_m = limit_m - 1e-3; x_m < limit_m + 1e-3; x_m += 1.3e-5) {
        // The tool's place by which the coupling has this force; beyond the limit the tool stays.
        const double tool_m = x_m < limit_m ? x_m - series * x_m / coupling : limit_m - force_N / coupling;
        state->safety.tool_corrected_w.position_m = {tool_m, 0, 0};
        state->device_w.position_m = {x_m, 0, 0};
        state->device_previous_w.position_m = {x_m - tick_m, 0, 0};
        const double to_ticks = from_ticks < 0 ? 0 : 1.5;
        const double begin_m = x_m + from_ticks * tick_m, end_m = x_m + to_ticks * tick_m;
        EXPECT_NEAR(share_below_limit(model, *state, felt, from_ticks, to_ticks) * series * (end_m - begin_m),
                    force_at(end_m) - force_at(begin_m), 1e-9)
            << x_m - limit_m << " by " << tick_m;
      }
  state->device_previous_w = state->device_w;  // at rest beyond the limit: the force is held
  EXPECT_EQ(share_below_limit(model, *state, felt, 0, 1.5), 0);
  state->safety.tool_corrected_w.position_m = state->device_w.position_m - Vec3{0.5 * force_N / coupling, 0, 0};
  EXPECT_EQ(share_below_limit(model, *state, felt, 0, 1.5), 1);  // below it: all of it
}

// Told so that the device's own limit cuts where the force ends: what it makes of the command at any place it can reach
// is the spring's force. Farther beyond the limit, and with less than F_max to give, it is told nothing that pushes on.
TEST(FeltStiffness, IsToldFromTheEndOfTheSpring) {
  Model model;
  model.params = tiny_params();
  model.params.local_period_s = 1e-4;
  const double coupling = model.params.coupling_N_per_m, force_N = model.params.force_max_N, series = 500;
  const FeltStiffness felt{{series, 0, 0}, {}};
  const StatePtr state = roomy_state();
  SafetyState& safety = state->safety;
  safety.ramp = 1;
  safety.last_device_w.force_N = {-force_N, 0, 0};
  const auto told_at = [&](double beyond_m, double tick_m) {
    state->device_w.position_m = {force_N / coupling + beyond_m, 0, 0};  // the tool at 0
    state->device_previous_w.position_m = state->device_w.position_m - Vec3{tick_m, 0, 0};
    return local_felt(model, *state, felt);
  };
  for (const double tick_m : {4e-4, -4e-4, 0.0}) {
    const LocalFelt told = told_at(5e-5, tick_m);
    EXPECT_EQ(told.felt.along.x, series);
    EXPECT_NEAR(told.point_w_m.x, force_N / coupling, 1e-15);
    EXPECT_EQ(told_at(1e-2, tick_m).felt.along, Vec3{});  // it cannot come back so soon
    EXPECT_EQ(told_at(-1e-4, tick_m).felt.along.x, series);
    EXPECT_EQ(told_at(-1e-4, tick_m).point_w_m, state->device_w.position_m);
  }
  safety.last_device_w.force_N = {-0.9 * force_N, 0,
                                  0};  // braked: that stays, and what is left is the share of the way
  EXPECT_EQ(told_at(5e-5, 4e-4).felt.along, Vec3{});
  EXPECT_EQ(told_at(5e-5, 4e-4).point_w_m, state->device_w.position_m);
  EXPECT_GT(told_at(5e-5, -4e-4).felt.along.x, 0.5 * series);
  safety.last_device_w.force_N = {-force_N, 0, 0};
  state->live.force_limit = 0.5;  // less than the device would cut at
  EXPECT_EQ(told_at(5e-5, 4e-4).felt.along, Vec3{});
}

// A wall of 100 N/mm, and a hand that goes 50 mm behind it and back at 0.2 m/s: the wall is pressed with what the
// device has, the force says nothing of the rest and comes back when the hand is within 5.7 mm again.
TEST(SaturatedProxy, NothingWindsUpBehindAHandThatWins) {
  Model model;
  model.params = tiny_params();
  const StatePtr state = roomy_state();
  const ScratchPtr scratch = roomy_scratch();
  Input input;
  Output output;
  double wall_N = 0, deepest_N = 0, last_N = 0, step_N = 0;
  for (int i = 0; i < 700; ++i) {
    input.pose_w.position_m.z = i < 250 ? 1e-3 - 2e-4 * i : 1e-3 - 2e-4 * std::max(0, 500 - i);
    input.commands = i == 1 ? Command::kArm : 0;
    sense(model, *state, *scratch, input);
    clear_contact(*state, *scratch);
    const double depth_m = -state->tool_w.position_m.z;
    if (depth_m > 0) {
      scratch->contact_wrench_w.force_N.z = 1e5 * depth_m;
      state->contact_stiffness[14] = 1e5;
      scratch->energy_J = 0.5e5 * depth_m * depth_m;
    }
    balance_tool(model, *state, *scratch);
    make_safe(model, *state, *scratch, input, output);
    EXPECT_EQ(output.fault, 0u) << i;
    wall_N = std::max(wall_N, scratch->contact_wrench_w.force_N.z);
    if (i == 250) deepest_N = output.device_w.force_N.z;
    step_N = std::max(step_N, std::abs(output.device_w.force_N.z - last_N));
    last_N = output.device_w.force_N.z;
  }
  EXPECT_NEAR(deepest_N, 8.5, 1e-6);
  EXPECT_LT(wall_N, 1.1 * 8.5);
  EXPECT_LE(step_N, kOutputStepShare * 8.5 * (1 + 1e-9));
  EXPECT_EQ(last_N, 0);
}

class Damped : public testing::Test {
 protected:
  Damped() {
    model_.params = tiny_params();
    model_.params.coupling_Ns_per_m = 2;
  }
  // The coupling's force while it is stretched at `speed`, from `first_m` on.
  Vec3 after(double first_m, double speed, int ticks) {
    Vec3 force;
    for (int i = 0; i <= ticks; ++i) {
      force = {0, 0, 1500 * (first_m + 1e-3 * speed * i)};
      undamped_N_ = force.z;
      add_coupling_damping(model_, safety_, force);
    }
    return force;
  }
  Model model_;
  SafetyState safety_;
  double undamped_N_ = 0;
};

TEST_F(Damped, ResistsAboveTheDeadSpeedOnly) {
  EXPECT_NEAR(after(0, 0.1, 100).z - undamped_N_, 2 * (0.1 - 0.03), 1e-6);
  safety_ = {};
  EXPECT_EQ(after(0, 0.02, 100).z, undamped_N_);
}

TEST_F(Damped, NeverPullsTheHandToTheSurfaceItLeaves) {
  model_.params.coupling_Ns_per_m = 1000;
  EXPECT_GE(after(0.02, -0.2, 95).z, 0);
  EXPECT_LT(after(0.02, -0.2, 95).z, undamped_N_);
}

class DrainEnergy : public testing::TestWithParam<int> {
 protected:
  DrainEnergy() {
    model.params = tiny_params();
    state->safety.mode = Mode::kForce;
    state->safety.ramp = 1;
  }
  Model model;
  const StatePtr state = roomy_state();
  const ScratchPtr scratch = roomy_scratch();
  Input input;
};

// Driven fingers fill the object: not the handle's energy, nor that of the coupling, so none of it is braked away. When
// they open, they take it back.
TEST_F(DrainEnergy, LeavesTheFingersWorkToTheFingers) {
  state->articulation.moved = 1;
  for (int i = 0; i < 200; ++i) {
    const double closed = i < 100 ? i : 199 - i;
    scratch->energy_J = 1e-6 * closed * closed;
    scratch->contact_wrench_w.force_N.z = 0.02 * closed;
    scratch->status = 0;
    Vec3 force{};
    state->hand_velocity_m_per_s = {0, 0, 0.1};
    drain_energy(model, *state, *scratch, input, 0, force);
    EXPECT_EQ(scratch->status, 0u) << i;
    EXPECT_NEAR(state->safety.surplus_J, 0, 1e-15) << i;
  }
}

// The tool goes with the object it holds: what the object does on it is the fingers' work, the part of it that the
// coupling does not get is not.
TEST_F(DrainEnergy, CountsWhatFingersDoOnTheToolOnce) {
  state->articulation.moved = 1;
  for (int i = 0; i < 50; ++i) {  // pulled by 0.5 N over 2.5 mm, and the coupling not yet stretched: 1.25 mJ too few
    state->tool_previous_w = state->tool_w;
    state->tool_w.position_m.z = 5e-5 * i;
    scratch->contact_wrench_w.force_N.z = 0.5;
    scratch->status = 0;
    Vec3 force{0, 0, 1e-3};
    drain_energy(model, *state, *scratch, input, 0, force);
  }
  EXPECT_NEAR(state->safety.surplus_J, -0.005 * 0.5 * 8.5 * 8.5 / 1500, 1e-12);  // the credit ends there
  state->articulation.moved = 0;  // a force that nobody drives has stored its work before
  const double before_J = state->safety.surplus_J;
  Vec3 force{0, 0, 1e-3};
  drain_energy(model, *state, *scratch, input, 0, force);
  EXPECT_NEAR(state->safety.surplus_J, before_J, 1e-12);
}

// A spring that a tick's delay turns into a source: what it returns more than it took is found, and braked; also while
// fingers move.
TEST_P(DrainEnergy, FindsWhatDelayMakes) {
  state->articulation.moved = GetParam();
  double drained_N = 0;
  for (int i = 0; i < 40; ++i) {  // pressed at 0.1 m/s into nothing but the coupling, whose other end stands still
    state->device_previous_w = state->device_w;
    state->device_w.position_m.z = -1e-4 * i;
    state->hand_velocity_m_per_s = {0, 0, -0.1};
    scratch->grip_w = state->device_w;
    scratch->status = 0;
    Vec3 force{0, 0, 0.15 * i};
    drain_energy(model, *state, *scratch, input, 0, force);
    drained_N = force.z - 0.15 * i;
    state->safety.last_device_w.force_N = {0, 0, 0.15 * i};
    remember_output(model, state->safety, {});
  }
  // Each tick the held force is 0.075 N short of the mean: K (v T)^2 / 2 a tick, less the credit of 0.5 %.
  const double made_J = 39 * 0.5 * 1500 * 1e-8;
  EXPECT_NEAR(state->safety.surplus_J, made_J, 0.005 * 0.5 * 8.5 * 8.5 / 1500 + 1e-9);
  EXPECT_NE(scratch->status & Status::kEnergyDrained, 0u);
  EXPECT_GT(drained_N, 0);  // against the motion
  EXPECT_LE(drained_N, 1500 * 1e-3 * 0.1 + 1e-12);
}

// A device that evaluates the local model is told of a contact after 2 ms and the tick in which it was met: the hand
// comes 0.3 mm in for nothing, K x^2 / 2. In the tick in which it is told, what it is short of, 0.45 N, is made up for
// at 0.765 N/ms, in 0.588 ms, and 0.15 N of the way come half of its 0.1 ms late: 0.385 N in the mean where the spring
// has 0.525. From then on those 7.5 mN over 0.1 mm a tick are all that is not paid. It is braked on its way out alone.
TEST_F(DrainEnergy, CountsWhatADeviceHasNotComeTo) {
  model.params.local_period_s = 1e-4;
  model.params.delay_s = 2e-3;
  for (int i = 0; i < 60; ++i) {
    const double in_m = 1e-4 * (i < 40 ? i : 79 - i);
    state->device_previous_w = state->device_w;
    state->device_w.position_m.z = -in_m;
    state->hand_velocity_m_per_s = {0, 0, i < 40 ? -0.1 : 0.1};
    scratch->grip_w = state->device_w;
    scratch->status = 0;
    const Vec3 wanted{0, 0, 1500 * in_m};
    Vec3 force = wanted;
    drain_energy(model, *state, *scratch, input, 0, force);
    if (i < 40) {
      EXPECT_EQ(force, wanted) << i;
    }
    if (i == 39) {
      const double made_up_N = (1 - 0.5 * 0.45 / 0.765) * 0.45 + (0.5 - 0.05) * 0.15;
      EXPECT_NEAR(state->safety.surplus_J, 0.5 * 1500 * 9e-8 + (0.525 - made_up_N) * 1e-4 + 35 * 7.5e-3 * 1e-4, 1e-9);
    }
    if (i == 42) {
      EXPECT_LT(force.z, wanted.z - 0.01);
    }
    state->safety.last_device_w.force_N = force;
    remember_output(model, state->safety, {{{0, 0, in_m > 0 ? 1500.0 : 0}, {}}, state->device_w.position_m});
  }
}
INSTANTIATE_TEST_SUITE_P(WithFingersStillAndMoving, DrainEnergy, testing::Values(0, 1));

TEST(IsUnstable, FiresOnForcesThatAlternate) {
  Model model;
  model.params = tiny_params();
  SafetyState buzzing, peaks;
  int fired_at = -1, fired_by_peaks = -1;
  for (int i = 0; i < 400; ++i) {
    if (is_unstable(model, buzzing, {0, 0, i % 2 == 0 ? 1.0 : 2.0}, 0) && fired_at < 0) fired_at = i;
    // Up and down again once in five ticks: peaks, not a limit cycle.
    if (is_unstable(model, peaks, {0, 0, i % 5 == 0 ? 2.0 : 1.0}, 0) && fired_by_peaks < 0) fired_by_peaks = i;
  }
  EXPECT_GT(fired_at, 10);
  EXPECT_LT(fired_at, 20);
  EXPECT_EQ(fired_by_peaks, -1);
}

TEST(IsUnstable, FiresOnEnergyTheMotorsCannotHold) {
  Model model;
  model.params = tiny_params();
  SafetyState safety;
  safety.surplus_J = 0.9 * 0.5 * 8.5 * 8.5 / 1500;
  EXPECT_FALSE(is_unstable(model, safety, {}, 0));
  safety.surplus_J *= 1.2;
  EXPECT_TRUE(is_unstable(model, safety, {}, 0.1));
  model.params.local_period_s = 1e-4;  // lets go of 8.5 N within 11 ms: 4.7 mJ to a hand that leaves at 0.1 m/s
  EXPECT_FALSE(is_unstable(model, safety, {}, 0.1));
  safety.surplus_J += 4.7e-3;
  EXPECT_TRUE(is_unstable(model, safety, {}, 0.1));
}

class Samples : public testing::Test {
 protected:
  Samples() {
    model_.params = tiny_params();
    model_.params.silence_hold_ticks = 3;
    model_.params.acceleration_max_m_per_s2 = 200;
    model_.params.speed_max_m_per_s = 5;
  }
  void sample(double z_m, std::uint32_t stale = 0) {
    input_.pose_w.position_m.z = z_m;
    input_.stale_ticks = stale;
    sense(model_, *state_, *scratch_, input_);
  }
  bool refused() const { return (scratch_->status & Status::kInputRejected) != 0; }
  Model model_;
  StatePtr state_ = roomy_state();
  ScratchPtr scratch_ = roomy_scratch();
  Input input_;
};

TEST_F(Samples, ThreeLostOnesAreBridged) {
  for (int i = 0; i < 100; ++i) sample(1e-4 * i);  // 0.1 m/s
  for (std::uint32_t stale = 1; stale <= 3; ++stale) {
    sample(99e-4, stale);
    EXPECT_NEAR(state_->device_w.position_m.z, 99e-4 + 1e-4 * stale, 1e-8);
    EXPECT_NE(scratch_->status & Status::kSampleBridged, 0u);
  }
  sample(99e-4, 4);  // from here on it is held
  EXPECT_NEAR(state_->device_w.position_m.z, 102e-4, 1e-8);
  EXPECT_EQ(scratch_->status & Status::kSampleBridged, 0u);
}

TEST_F(Samples, AJumpNoHandCouldMakeIsRefusedUntilOneCould) {
  for (int i = 0; i < 20; ++i) sample(0);
  sample(1e-3);  // 200 m/s2 over a tick and the velocity's lag: 1.4 mm
  EXPECT_FALSE(refused());
  for (int i = 0; i < 50; ++i) sample(1e-3);
  sample(5e-3);  // 4 mm at once is 4 m/s, below the top speed
  EXPECT_TRUE(refused());
  sample(5e-3);  // 3.2 mm in two ticks
  EXPECT_TRUE(refused());
  sample(5e-3);  // 5.4 mm in three
  EXPECT_FALSE(refused());
}

// At 10 kHz an encoder's step of 30 um comes in one tick of many: nobody's acceleration. A jump still is.
TEST_F(Samples, AnEncodersStaircaseIsNoJumpAtAnyRate) {
  for (const double period_s : {1e-3, 2.5e-4, 1e-4}) {
    reset(*state_);
    model_.params.period_s = period_s;
    int count = 0;
    for (int i = 0; i < 20000; ++i) {
      const double at_m = 0.02 * std::sin(2 * 3.14159265358979 * 3 * period_s * i);  // 3 Hz, up to 0.38 m/s
      sample(3e-5 * static_cast<double>(static_cast<long>(at_m / 3e-5)));
      count += refused() ? 1 : 0;
    }
    EXPECT_EQ(count, 0) << period_s;
    sample(state_->told_w.position_m.z + 4e-3);
    EXPECT_TRUE(refused()) << period_s;
  }
}

TEST_F(Samples, ADeviceThatSendsTooFewIsAFault) {
  Output output;
  std::uint32_t fault = 0;
  int latched_at = -1;
  for (int i = 0; i < 1000; ++i) {
    input_.commands = i == 1 ? Command::kArm : 0;
    sample(0, i < 300 || i % 2 == 0 ? 0 : 1);  // then 500 a second
    clear_contact(*state_, *scratch_);
    make_safe(model_, *state_, *scratch_, input_, output);
    if (fault == 0 && output.fault != 0) latched_at = i;
    fault |= output.fault;
  }
  EXPECT_EQ(fault, Fault::kSamplesSparse);
  EXPECT_GT(latched_at, 300 + 100);
}

}  // namespace
}  // namespace palpate::test
