// The output stage's mode machine: every transition of the table in mode_machine.h, and the properties that must hold
// for any sequence of inputs.
#include <gtest/gtest.h>

#include <random>

#include "rt_core/safety/mode_machine.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

struct Machine {
  Model model;
  SafetyState safety;
  Input input;
  std::uint32_t late_fault = Fault::kDeviceSilent;
  bool pressed = false;

  Machine() { model.params = tiny_params(); }
  void step(std::uint32_t late = 0, std::uint32_t new_faults = 0) {
    input.stale_ticks = late;
    advance_mode(model, input, {new_faults, late, late_fault, pressed}, safety);
  }
  void arm() {
    input.commands = Command::kArm;
    step();
    input.commands = 0;
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) step();
  }
};

TEST(ModeMachine, ArmsOnAnEdgeAndRampsIn) {
  Machine m;
  m.step();
  EXPECT_EQ(m.safety.mode, Mode::kIdle);
  m.arm();
  EXPECT_EQ(m.safety.mode, Mode::kForce);
  EXPECT_NEAR(m.safety.ramp, 1.0 / 200, 1e-12);
  m.run(198);
  EXPECT_LT(m.safety.ramp, 1);
  m.run(2);
  EXPECT_EQ(m.safety.ramp, 1);
}

TEST(ModeMachine, DoesNotArmOnALevelAStaleSampleOrWhileStopped) {
  Machine m;
  m.input.commands = Command::kArm;
  m.step(1);  // edge, but no sample
  m.step();   // level, no edge
  EXPECT_EQ(m.safety.mode, Mode::kIdle);
  m.input.commands = 0;
  m.step();
  m.input.commands = Command::kArm | Command::kStop;
  m.step();
  EXPECT_EQ(m.safety.mode, Mode::kIdle);
}

TEST(ModeMachine, SilenceGoesThroughHoldPassiveRampToFault) {
  Machine m;
  m.arm();
  m.run(300);
  m.step(1);
  EXPECT_EQ(m.safety.mode, Mode::kHold);
  EXPECT_EQ(m.safety.ramp, 1);
  for (std::uint32_t late = 2; late <= 5; ++late) m.step(late);
  EXPECT_EQ(m.safety.mode, Mode::kPassive);
  EXPECT_NEAR(m.safety.ramp, 0.8 * 0.8 * 0.8 * 0.8, 1e-12);
  m.step(6);
  EXPECT_EQ(m.safety.mode, Mode::kRamp);
  std::uint32_t late = 7;
  while (m.safety.mode == Mode::kRamp && late < 100) m.step(late++);
  // 0.41 of gain at 1/20 per tick is gone after 9 ticks, before the silence limit latches the fault at 20.
  while (late <= 20) m.step(late++);
  EXPECT_EQ(m.safety.mode, Mode::kFault);
  EXPECT_EQ(m.safety.fault, Fault::kDeviceSilent);
  EXPECT_EQ(m.safety.ramp, 0);
}

TEST(ModeMachine, RecoversFromAShortSilence) {
  Machine m;
  m.arm();
  m.run(300);
  m.step(1);
  m.step(2);
  const double gain = m.safety.ramp;
  m.step(0);
  EXPECT_EQ(m.safety.mode, Mode::kForce);
  EXPECT_NEAR(m.safety.ramp, gain + 1.0 / 200, 1e-12);
}

TEST(ModeMachine, MissedDeadlinesLatchTheirOwnFault) {
  Machine m;
  m.arm();
  m.run(300);
  m.late_fault = Fault::kStalled;
  m.step(25);
  EXPECT_EQ(m.safety.fault, Fault::kStalled);
  EXPECT_EQ(m.safety.mode, Mode::kRamp);
}

TEST(ModeMachine, EveryFaultRampsOutLatchesAndNeedsAResetEdge){
#define PALPATE_FIELD(name, bit, cause, remedy)                           \
  {                                                                       \
    Machine m;                                                            \
    m.arm();                                                              \
    m.run(300);                                                           \
    m.input.device_fault = Fault::name;                                   \
    double last = m.safety.ramp;                                          \
    int ticks = 0;                                                        \
    do {                                                                  \
      m.step();                                                           \
      EXPECT_LE(m.safety.ramp, last);                                     \
      last = m.safety.ramp;                                               \
    } while (m.safety.mode == Mode::kRamp && ++ticks < 100);              \
    EXPECT_LE(ticks, 20) << "ramp_out_s is 20 ticks: " << #name;          \
    EXPECT_EQ(m.safety.mode, Mode::kFault) << #name;                      \
    m.input.commands = Command::kReset;                                   \
    m.step();                                                             \
    EXPECT_EQ(m.safety.mode, Mode::kFault) << "the cause is still there"; \
    m.input.device_fault = 0;                                             \
    m.step();                                                             \
    EXPECT_EQ(m.safety.mode, Mode::kFault) << "a level is no edge";       \
    m.arm();                                                              \
    EXPECT_EQ(m.safety.mode, Mode::kFault) << "arming does not clear";    \
    m.step();                                                             \
    m.input.commands = Command::kReset;                                   \
    m.step();                                                             \
    EXPECT_EQ(m.safety.mode, Mode::kIdle) << #name;                       \
    EXPECT_EQ(m.safety.fault, 0u);                                        \
  }
    PALPATE_FAULT_BITS(PALPATE_FIELD)
#undef PALPATE_FIELD
}

TEST(ModeMachine, StopRampsToIdleFromForceAndHold) {
  for (const std::uint32_t late : {0u, 1u}) {
    Machine m;
    m.arm();
    m.run(300);
    m.input.commands = Command::kStop;
    m.step(late);
    EXPECT_EQ(m.safety.mode, Mode::kRamp);
    m.input.commands = 0;  // a short press is enough
    int ticks = 0;
    while (m.safety.mode == Mode::kRamp && ++ticks < 100) m.step();
    EXPECT_EQ(m.safety.mode, Mode::kIdle);
    EXPECT_LE(ticks, 20);
  }
}

TEST(ModeMachine, ADeviceThatDoesNotHearAndAStallRampOutAndBackIn) {
  for (const std::uint32_t let_go : {Command::kUnheard, Command::kStall}) {
    Machine m;
    m.arm();
    m.run(300);
    m.input.commands = let_go;
    m.run(10);
    EXPECT_EQ(m.safety.mode, Mode::kRamp);
    EXPECT_NEAR(m.safety.ramp, 0.5, 1e-12);
    m.run(20);
    EXPECT_EQ(m.safety.mode, Mode::kRamp) << "waiting is neither rest nor a fault";
    EXPECT_EQ(m.safety.ramp, 0);
    m.input.commands = 0;
    m.step();
    EXPECT_EQ(m.safety.mode, Mode::kForce);
    EXPECT_NEAR(m.safety.ramp, 1.0 / 200, 1e-12);
  }
}

TEST(ModeMachine, DoesNotArmUnheardStalledOrPressed) {
  Machine m;
  for (const std::uint32_t let_go : {Command::kUnheard, Command::kStall}) {
    m.input.commands = Command::kArm | let_go;
    m.step();
    EXPECT_EQ(m.safety.mode, Mode::kIdle);
    m.input.commands = 0;
    m.step();
  }
  m.pressed = true;
  m.arm();
  EXPECT_EQ(m.safety.mode, Mode::kIdle);
  m.pressed = false;
  m.step();
  EXPECT_EQ(m.safety.mode, Mode::kIdle) << "a refused edge is gone";
  m.arm();
  EXPECT_EQ(m.safety.mode, Mode::kForce);
}

TEST(ModeMachine, SilenceWhileIdleIsNoFault) {
  Machine m;
  for (std::uint32_t late = 1; late < 100; ++late) m.step(late);
  EXPECT_EQ(m.safety.mode, Mode::kIdle);
  EXPECT_EQ(m.safety.fault, 0u);
}

// Any random sequence: the gain stays in [0, 1] and never jumps up; it is zero at rest; a fault never clears without a
// reset edge; force never appears without an arm edge.
TEST(ModeMachine, PropertiesHoldForRandomSequences) {
  std::mt19937 random(20261121);
  for (int run = 0; run < 200; ++run) {
    Machine m;
    bool armed_edge = false;
    std::uint32_t late = 0;
    for (int i = 0; i < 500; ++i) {
      const SafetyState before = m.safety;
      m.input.commands = random() % 10 == 0 ? static_cast<std::uint32_t>(random() % 32) : 0;
      m.input.device_fault = random() % 100 == 0 ? 1u << (random() % 14) : 0;
      m.pressed = random() % 4 == 0;
      late = random() % 6 == 0 ? late + 1 : (random() % 3 == 0 ? late + 1 : 0);
      m.step(late);
      armed_edge |= (m.input.commands & Command::kArm) != 0;
      ASSERT_GE(m.safety.ramp, 0);
      ASSERT_LE(m.safety.ramp, 1);
      ASSERT_LE(m.safety.ramp - before.ramp, 1.0 / 200 + 1e-12);
      if (m.safety.mode == Mode::kIdle || m.safety.mode == Mode::kFault) {
        ASSERT_EQ(m.safety.ramp, 0);
      }
      if (before.fault != 0 && m.safety.fault == 0) {
        ASSERT_TRUE(m.input.commands & Command::kReset);
      }
      if (m.safety.mode == Mode::kForce) {
        ASSERT_TRUE(armed_edge);
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
