// Sense and safety around a contact that is a linear spring wall, so that the coupled equilibrium is known exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rt_core/contact/contact.h"
#include "rt_core/tick.h"
#include "rt_core/tool/virtual_coupling.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

// A wall at z = 0 of stiffness k: what collide .. deform would leave behind.
struct Wall {
  double k_N_per_m;
  void operator()(State& state, Scratch& scratch) const {
    const double depth_m = -state.tool_w.position_m.z;
    for (double& entry : state.contact_stiffness) entry = 0;
    if (!(depth_m > 0)) return;
    scratch.contact_wrench_w.force_N = {0, 0, k_N_per_m * depth_m};
    state.contact_stiffness[14] = k_N_per_m;
  }
};

struct Rig {
  Model model;
  StatePtr state = test::roomy_state();
  ScratchPtr scratch = test::roomy_scratch();
  Input input;
  Output output;

  Rig() { model.params = tiny_params(); }
  template <class Contact>
  void step(const Contact& contact) {
    sense(model, *state, *scratch, input);
    clear_contact(*state, *scratch);
    contact(*state, *scratch);
    balance_tool(model, *state, *scratch);
    make_safe(model, *state, *scratch, input, output);
    input.commands = 0;
  }
  // Armed in the free, as it must be; the contact is there from the tick after on.
  template <class Contact>
  void arm(const Contact& contact) {
    const auto nothing = [](State&, Scratch&) {};
    step(nothing);
    input.commands = Command::kArm;
    step(nothing);
    for (int i = 0; i < 300; ++i) step(contact);
  }
};

TEST(VirtualCoupling, HandFeelsTheSpringsInSeriesExactly) {
  for (const double wall : {100.0, 1500.0, 17000.0, 1e6}) {
    Rig rig;
    rig.input.pose_w.position_m = {0, 0, 1e-3};
    rig.arm(Wall{wall});
    EXPECT_EQ(norm(rig.output.device_w.force_N), 0) << "no contact, no force";
    const double kc = rig.model.params.coupling_N_per_m;
    double felt = 0;
    for (int i = 1; i <= 4000; ++i) {
      rig.input.pose_w.position_m.z = 1e-3 - 1e-6 * i;  // 1 mm/s
      rig.step(Wall{wall});
      const double depth = -rig.input.pose_w.position_m.z;
      felt = rig.output.device_w.force_N.z;
      // Exact but for the tick in which the surface is crossed.
      if (depth > 2e-6) {
        ASSERT_NEAR(felt, depth * wall * kc / (wall + kc), 1e-9 * (1 + felt)) << wall;
      }
    }
    EXPECT_GT(felt, 0.2);
    EXPECT_LE(felt, 3e-3 * kc) << "never stiffer than the coupling";
  }
}

TEST(VirtualCoupling, RotationIsCoupledToo) {
  Rig rig;
  rig.model.params.turn_max_rad_per_s = 100;  // 0.037 rad in one tick
  rig.arm([](State&, Scratch&) {});
  rig.input.pose_w.orientation = small_rotation({0.02, -0.01, 0.03});
  rig.step([](State& state, Scratch& scratch) {
    // A torsional spring of 2 N·m/rad about x towards the identity.
    for (double& entry : state.contact_stiffness) entry = 0;
    state.contact_stiffness[21] = 2;
    scratch.contact_wrench_w.torque_Nm = {-2 * small_rotation_vector(state.tool_w.orientation).x, 0, 0};
  });
  // In series: 0.5 and 2 N·m/rad over 0.02 rad. The first tick predicts with no contact known, then corrects.
  EXPECT_NEAR(rig.output.device_w.torque_Nm.x, -0.02 * (0.5 * 2 / 2.5), 2e-6);
  EXPECT_NEAR(rig.output.device_w.torque_Nm.y, 0, 2e-6);
}

TEST(VirtualCoupling, PressDriveBypassesCouplingAndRamp) {
  Rig rig;
  rig.input.drive = Drive::kTool;
  rig.input.pose_w.position_m = {0, 0, -2e-3};
  rig.step(Wall{1000});
  EXPECT_DOUBLE_EQ(rig.output.device_w.force_N.z, 2.0);
  EXPECT_EQ(rig.output.mode, Mode::kForce);
}

TEST(Sense, ImplausibleAndNonFinitePosesAreHeldAndReported) {
  Rig rig;
  rig.arm(Wall{1000});
  const Pose held = rig.state->device_w;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Vec3 bad : {Vec3{nan, 0, 0}, Vec3{0, infinity, 0}, Vec3{0.1, 0, 0}}) {
    rig.input.pose_w.position_m = bad;
    rig.step(Wall{1000});
    EXPECT_TRUE(rig.scratch->status & Status::kInputRejected);
    EXPECT_EQ(rig.state->device_w, held);
    EXPECT_NE(rig.output.mode, Mode::kForce);
    rig.input.pose_w.position_m = held.position_m;
    rig.step(Wall{1000});
    EXPECT_FALSE(rig.scratch->status & Status::kInputRejected);
    EXPECT_EQ(rig.output.mode, Mode::kForce);
  }
}

TEST(Sense, APersistentJumpEndsInAFault) {
  Rig rig;
  rig.arm(Wall{1000});
  rig.input.pose_w.position_m = {1, 0, 0};  // 1 m at 2 m/s would need 500 ticks
  for (int i = 0; i < 30; ++i) rig.step(Wall{1000});
  EXPECT_EQ(rig.output.mode, Mode::kFault);
  EXPECT_EQ(rig.output.fault, Fault::kSamplesRejected) << "samples came; silence it was not";
  EXPECT_EQ(norm(rig.output.device_w.force_N), 0);
}

Quat turn_about_z(double angle_rad) { return {std::cos(angle_rad / 2), 0, 0, std::sin(angle_rad / 2)}; }

// Zeros, a driver's bytes of another meaning, a quaternion of integers: what is no rotation is held out before anything
// makes it one, from the first sample on.
TEST(Sense, AQuaternionThatIsNoRotationIsRejected) {
  for (const Quat& bad : {Quat{0, 0, 0, 0}, Quat{0.5, 0.5, 0.5, 0.4}, Quat{1, 1, 0, 0}, Quat{1e300, 0, 0, 0}}) {
    Rig rig;
    rig.input.pose_w.orientation = bad;
    rig.step(Wall{1000});
    EXPECT_TRUE(rig.scratch->status & Status::kInputRejected);
    EXPECT_EQ(rig.state->started, 0);
    rig.input.pose_w.orientation = {};
    rig.arm(Wall{1000});
    rig.input.pose_w.orientation = bad;
    for (int i = 0; i < 30; ++i) rig.step(Wall{1000});
    EXPECT_EQ(rig.output.fault, Fault::kSamplesRejected);
    EXPECT_EQ(rig.state->device_w.orientation, Quat{});
  }
  Rig rig;
  rig.input.pose_w.orientation = {0.995, 0, 0, 0};  // |q|^2 = 0.990: rounding of a coarse encoder
  rig.step(Wall{1000});
  EXPECT_FALSE(rig.scratch->status & Status::kInputRejected);
}

// The scene's 30 rad/s are 0.03 rad in a tick; the allowance grows with every tick without an accepted sample.
TEST(Sense, ATurnFasterThanAHandsIsRejectedUntilAHandCouldHaveMadeIt) {
  Rig rig;
  rig.arm(Wall{1000});
  rig.input.pose_w.orientation = turn_about_z(0.029);
  rig.step(Wall{1000});
  EXPECT_FALSE(rig.scratch->status & Status::kInputRejected);
  rig.input.pose_w.orientation = turn_about_z(0.029 + 0.1);
  for (int i = 0; i < 3; ++i) {
    rig.step(Wall{1000});
    EXPECT_TRUE(rig.scratch->status & Status::kInputRejected) << i;
  }
  rig.step(Wall{1000});  // 4 ticks: 0.12 rad
  EXPECT_FALSE(rig.scratch->status & Status::kInputRejected);
  const Quat same = rig.input.pose_w.orientation;
  rig.input.pose_w.orientation = {-same.w, -same.x, -same.y, -same.z};  // the same rotation
  rig.step(Wall{1000});
  EXPECT_FALSE(rig.scratch->status & Status::kInputRejected);
}

TEST(Sense, HalfTurnsEveryTickEndInAFault) {
  Rig rig;
  rig.arm(Wall{1000});
  for (int i = 0; i < 60; ++i) {
    rig.input.pose_w.orientation = i % 2 == 0 ? turn_about_z(3.14159) : Quat{};
    rig.step(Wall{1000});
    EXPECT_EQ(rig.state->device_w.orientation, Quat{}) << i;
  }
  rig.input.pose_w.orientation = turn_about_z(3.14159);
  for (int i = 0; i < 25; ++i) rig.step(Wall{1000});
  EXPECT_EQ(rig.output.fault, Fault::kSamplesRejected);
}

TEST(Safety, NonFiniteContactRampsTheLastGoodForceOutAndLatches) {
  Rig rig;
  rig.input.pose_w.position_m = {0, 0, -3e-3};
  rig.arm(Wall{2000});
  double last = rig.output.device_w.force_N.z;
  ASSERT_GT(last, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int ticks = 0;
  do {
    rig.step([nan](State&, Scratch& scratch) { scratch.contact_wrench_w.force_N = {nan, 0, 0}; });
    EXPECT_TRUE(is_finite(rig.output.device_w.force_N));
    EXPECT_LE(rig.output.device_w.force_N.z, last);
    last = rig.output.device_w.force_N.z;
  } while (rig.output.mode == Mode::kRamp && ++ticks < 100);
  EXPECT_EQ(rig.output.mode, Mode::kFault);
  EXPECT_TRUE(rig.output.fault & Fault::kNotFinite);
  EXPECT_EQ(last, 0);
}

TEST(Safety, MagnitudeIsClampedWithItsDirectionKept) {
  Rig rig;
  rig.model.params.ramp_in_s = 0;
  rig.model.params.friction_law = FrictionLaw::kPaper;  // under which a tool may step far by itself
  rig.input.pose_w.position_m = {0, 0, -0.05};
  const auto nothing = [](State&, Scratch&) {};
  rig.step(nothing);
  rig.input.commands = Command::kArm;
  rig.step(nothing);
  // For so short a time: an object that pushes for ever by itself makes energy, which is a fault.
  for (int i = 0; i < 20; ++i)
    rig.step([](State&, Scratch& scratch) { scratch.contact_wrench_w = {{300, 0, 400}, {0, 3, 4}}; });
  EXPECT_TRUE(rig.scratch->status & Status::kForceClamped);
  EXPECT_LE(norm(rig.output.device_w.force_N), rig.model.params.force_max_N * (1 + 1e-12));
  EXPECT_LE(norm(rig.output.device_w.torque_Nm), rig.model.params.torque_max_Nm * (1 + 1e-12));
  EXPECT_GT(rig.output.device_w.force_N.x, 0);
}

// Planted once: a limiter that let torque pass.
TEST(Safety, NoTorqueStepExceedsTheSameShareOfItsLimit) {
  Rig rig;
  rig.model.params.force_rate_max_N_per_s = 0.05 * rig.model.params.force_max_N / rig.model.params.period_s;
  rig.model.params.friction_law = FrictionLaw::kPaper;  // under which a tool may step far by itself
  rig.arm(Wall{2000});
  const double step_Nm = 0.05 * rig.model.params.torque_max_Nm;
  Vec3 last = rig.output.device_w.torque_Nm;
  double largest_Nm = 0;
  for (int i = 0; i < 200; ++i) {
    rig.step([i](State&, Scratch& scratch) { scratch.contact_wrench_w.torque_Nm = {i % 20 < 10 ? 50.0 : 0.0, 0, 0}; });
    const double step = norm(rig.output.device_w.torque_Nm - last);
    EXPECT_LE(step, step_Nm * (1 + 1e-9)) << i;
    largest_Nm = max_of(largest_Nm, step);
    last = rig.output.device_w.torque_Nm;
  }
  EXPECT_NEAR(largest_Nm, step_Nm, 1e-9);
}

// Whatever rate a scene states, every tick changes force and torque by less than a tenth of its limit: with margin, not
// by a rounding.
TEST(Safety, EveryTickChangesTheForceByLessThanATenth) {
  Rig rig;
  rig.model.params.force_rate_max_N_per_s = 1e7;
  rig.model.params.speed_max_m_per_s = 10;
  rig.input.pose_w.position_m = {0, 0, 1e-3};
  rig.arm(Wall{1e5});
  Wrench last = rig.output.device_w;
  double largest_N = 0;
  for (int i = 0; i < 200; ++i) {
    const double sign = i % 40 < 20 ? 1 : -1;
    rig.input.pose_w.position_m.z = 4e-3 * sign;  // a handle that jumps into the wall and out
    rig.step([sign](State& state, Scratch& scratch) {
      Wall{1e5}(state, scratch);
      scratch.contact_wrench_w.torque_Nm = {5 * sign, 0, 0};
    });
    const Wrench now = rig.output.device_w;
    largest_N = max_of(largest_N, norm(now.force_N - last.force_N));
    EXPECT_LE(norm(now.torque_Nm - last.torque_Nm), 0.099 * rig.model.params.torque_max_Nm) << i;
    last = now;
  }
  EXPECT_LT(largest_N, 0.099 * rig.model.params.force_max_N);
  EXPECT_GT(largest_N, 0.09 * rig.model.params.force_max_N);  // it was met
}

// A tool that begins inside would push at once: refused, and said, until it is outside.
TEST(Safety, DoesNotArmAToolThatStartsInside) {
  Rig rig;
  rig.input.pose_w.position_m = {0, 0, -3e-3};
  rig.step(Wall{2000});
  for (int i = 0; i < 10; ++i) {
    rig.input.commands = i % 2 == 0 ? Command::kArm : 0;
    rig.step(Wall{2000});
    EXPECT_EQ(rig.output.mode, Mode::kIdle);
    EXPECT_EQ((rig.scratch->status & Status::kStartsInside) != 0, i % 2 == 0);
    EXPECT_EQ(rig.output.device_w, Wrench{});
  }
  for (int i = 0; i < 10; ++i) {
    rig.input.pose_w.position_m.z += 4e-4;
    rig.step(Wall{2000});
  }
  rig.input.commands = Command::kArm;
  rig.step(Wall{2000});
  EXPECT_EQ(rig.output.mode, Mode::kForce);
  EXPECT_FALSE(rig.scratch->status & Status::kStartsInside);
}

// After a force that is no number every memory of contact is dropped, that of nodes too: what made it may be there.
TEST(Safety, ContactMemoryIsDroppedAfterANonFiniteForce) {
  Rig rig;
  rig.arm(Wall{2000});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  rig.step([nan](State& state, Scratch& scratch) {
    scratch.contact_wrench_w.force_N = {nan, 0, 0};
    state.region[0].id = 7;
    state.point[0].triangle = 3;
    state.nodal.count = 1;
    state.nodal.contact[0].vertex = 2;
    state.contact_stiffness[3] = 5;
  });
  EXPECT_EQ(rig.state->region[0].id, 0u);
  EXPECT_EQ(rig.state->point[0].triangle, -1);
  EXPECT_EQ(rig.state->nodal.count, 0);
  EXPECT_EQ(rig.state->contact_stiffness[3], 0);
}

TEST(Safety, NoForceStepExceedsTheRateLimit) {
  Rig rig;
  rig.model.params.force_rate_max_N_per_s = 500;        // 0.5 N per tick
  rig.model.params.friction_law = FrictionLaw::kPaper;  // under which a tool may step far by itself
  rig.arm(Wall{2000});
  Vec3 last = rig.output.device_w.force_N;
  bool limited = false;
  for (int i = 0; i < 200; ++i) {
    rig.step([i](State&, Scratch& scratch) { scratch.contact_wrench_w.force_N = {0, 0, i % 20 < 10 ? 500.0 : 0.0}; });
    EXPECT_LE(norm(rig.output.device_w.force_N - last), 0.5 + 1e-9);
    limited |= (rig.scratch->status & Status::kRateLimited) != 0;
    last = rig.output.device_w.force_N;
  }
  EXPECT_TRUE(limited);
}

}  // namespace
}  // namespace palpate::test
