// A person moves simulated drives of every protocol with what may be wrong with their wires: the axis is named, and no
// motor is ever enabled. In virtual time; the person aims badly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "hal/bus/loopback.h"
#include "hal/device/device_profile.h"
#include "hal/drives/drive_link.h"
#include "sim_host/doctor/move_check.h"
#include "sim_host/doctor/push_check.h"
#include "tests/hal/arm_text.h"

namespace palpate {
namespace {

using testing::HasSubstr;

std::string shipped(const std::string& name) {
  std::ifstream stream(std::string(PALPATE_SOURCE_DIR) + "/config/devices/" + name);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string replaced(std::string text, const std::string& old, const std::string& fresh) {
  const auto at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? text : text.replace(at, old.size(), fresh);
}

DeviceProfile profile_of(const std::string& text) {
  std::string error;
  const auto profile = parse_device_profile(text, "arm.toml", error);
  EXPECT_TRUE(profile && profile->arm) << error;
  return profile.value_or(DeviceProfile{});
}

// One profile of each protocol.
const char* const kShipped[] = {"example-arm-odrive.toml", "example-delta-cia402.toml", "example-arm-moteus.toml",
                                "example-falcon.toml"};

Pose home_of(const ArmProfile& arm) {
  double home[kMaxAxes] = {};
  for (std::size_t i = 0; i < arm.axes.size(); ++i) home[i] = arm.axes[i].home_joint;
  return linkage_at(arm.linkage, home).pose;
}

// "1 of 3: move ...", not what is said between.
bool is_request(const std::string& line) { return line[0] >= '1' && line[0] <= '9'; }

// The hand's own mechanics matter little here; the usual 20 steps a period take long.
PlantOptions quick() {
  PlantOptions options;
  options.substeps = 2;
  return options;
}

struct Fault {
  int axis = -1;
  AxisFault what;
  int other = -1;  // swapped with it
};

class Person {
 public:
  explicit Person(const std::string& text, unsigned seed = 1)
      : profile_(profile_of(text)),
        arm_(*profile_.arm),
        home_(home_of(arm_)),
        ends_(open_loopback_pair(error_)),
        sim_(make_drive_sim(*ends_.second, arm_, quick(), HandPath({{0, home_}}))),
        drives_(make_drives(*ends_.first, arm_, 1e-3)),
        device_(*drives_, arm_, profile_.frame, 1e-3),
        draw_(seed) {}

  void set(const Fault& fault) {
    if (fault.axis < 0) return;
    sim_->plant().set_fault(fault.axis, fault.what);
    if (fault.other < 0) return;
    sim_->plant().set_fault(fault.axis, {.reads = fault.other});
    sim_->plant().set_fault(fault.other, {.reads = fault.axis});
  }
  std::string find() {
    return device_.find([this] { sim_->step_bus(); });
  }
  std::string start() {
    return device_.start([this] { sim_->step_bus(); });
  }
  std::vector<DoctorItem> check() {
    EXPECT_EQ(find(), "");
    MoveCheck check(
        device_, arm_, profile_.frame,
        [this] {
          sim_->plant().plant().pull(there_, false);
          sim_->step();
          enabled_ = enabled_ || sim_->any_enabled();
        },
        [this](const std::string& line) { hear(line); });
    const auto rows = check.run();
    EXPECT_FALSE(enabled_) << "a motor was enabled";
    return rows;
  }
  // The row that judges, of a check with this wrong.
  std::string verdict(const Fault& fault = {}) {
    set(fault);
    const auto rows = check();
    return (rows.back().verdict == Verdict::kPass ? "pass: " : "fail: ") + rows.back().found;
  }
  // Each motor by itself, the hand holding still.
  std::vector<DoctorItem> push() {
    EXPECT_EQ(find(), "");
    double most_N = 0;
    int ms = 0;
    PushCheck check(*drives_, arm_, [&] {
      const double swing_m = restless ? 0.02 * std::sin(0.02 * ms++) : 0.0;
      sim_->plant().plant().pull({home_.position_m + Vec3{0, swing_m, 0}, home_.orientation}, false);
      sim_->step();
      most_N = std::max(most_N, norm(sim_->plant().plant().motor().force_N));
    });
    const auto rows = check.run();
    EXPECT_LT(most_N, 3.0) << "a fifth of what the motors can";
    EXPECT_FALSE(sim_->any_enabled());
    EXPECT_EQ(sim_->plant().plant().motor().force_N, Vec3{});
    return rows;
  }
  bool restless = false;
  bool lazy = false;  // never moves
  double way = 1;     // of what was asked
  Quat place = {};    // how the person stands to the scene
  const std::vector<std::string>& heard() const { return heard_; }

 private:
  // 15 degrees beside what was asked, between 40 and 60 mm.
  void hear(const std::string& line) {
    heard_.push_back(line);
    if (!is_request(line)) return static_cast<void>(there_ = home_);
    if (lazy) return;
    const HandMove& move = moves_[next_++];
    if (move.of_gimbal) return turn(move.along);
    std::uniform_real_distribution<double> any(-1, 1);
    const Vec3 aside = cross(move.along, Vec3{any(draw_), any(draw_), any(draw_)});
    const Vec3 aim = way * (1 + 0.2 * any(draw_)) * kAskedMove_m * unit_or(move.along + 0.26 * aside, move.along);
    const Vec3 there = rotate(conjugate(profile_.frame.orientation_w), rotate(place, aim));
    there_ = {home_.position_m + there, home_.orientation};
  }
  // Only that joint of the gimbal, the place stays.
  void turn(Vec3 along) {
    double joint[kMaxAxes] = {};
    for (std::size_t i = 0; i < arm_.axes.size(); ++i) joint[i] = arm_.axes[i].home_joint;
    joint[3] += kAskedTurn_rad * along.x, joint[4] += kAskedTurn_rad * along.y, joint[5] += kAskedTurn_rad * along.z;
    there_ = linkage_at(arm_.linkage, joint).pose;
  }

  DeviceProfile profile_;
  const ArmProfile& arm_;
  Pose home_, there_ = home_;  // where the hand is asked to be
  std::string error_;
  std::pair<std::unique_ptr<Transport>, std::unique_ptr<Transport>> ends_;
  std::unique_ptr<DriveSim> sim_;
  std::unique_ptr<AxisDrives> drives_;
  AxisDevice device_;
  std::mt19937 draw_;
  std::vector<HandMove> moves_ = asked_moves(arm_, profile_.frame);
  std::size_t next_ = 0;
  std::vector<std::string> heard_;
  bool enabled_ = false;
};

TEST(MoveCheck, ARightDevicePassesWhoeverMovesIt) {
  for (const char* name : kShipped)
    for (unsigned seed = 1; seed <= 5; ++seed)
      EXPECT_EQ(Person(shipped(name), seed).verdict(), "pass: signs, order and scale are the profile's") << name;
}

TEST(MoveCheck, ThePersonIsToldWhatToDo) {
  Person person(shipped(kShipped[0]));
  person.check();
  ASSERT_EQ(person.heard().size(), 7u);
  EXPECT_THAT(person.heard()[0], HasSubstr("Hold the handle still"));
  EXPECT_THAT(person.heard()[1], HasSubstr("1 of 3: move the handle forward (x+) by 50 mm"));
  EXPECT_THAT(person.heard()[2], HasSubstr("Back to the middle"));
  EXPECT_THAT(person.heard()[5], HasSubstr("3 of 3: move the handle to the right (z+)"));
}

TEST(MoveCheck, AReversedEncoderIsNamed) {
  for (const char* name : kShipped)
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_THAT(Person(shipped(name)).verdict({axis, {.scale = -1}}),
                  testing::AllOf(HasSubstr("fail: axis " + std::to_string(axis + 1) + " (node"),
                                 HasSubstr("is reversed: its direction, or its encoder's leads")))
          << name;
}

// The profile's own mistake looks the same.
TEST(MoveCheck, AWrongDirectionInTheProfileIsNamed) {
  for (const char* name : kShipped) {
    const DeviceProfile wrong = profile_of(replaced(shipped(name), "direction = 1", "direction = -1"));
    const DeviceProfile right = profile_of(shipped(name));
    std::string error;
    auto ends = open_loopback_pair(error);
    const auto sim = make_drive_sim(*ends.second, *right.arm, quick(), HandPath({{0, home_of(*right.arm)}}));
    const auto drives = make_drives(*ends.first, *wrong.arm, 1e-3);
    AxisDevice device(*drives, *wrong.arm, wrong.frame, 1e-3);
    ASSERT_EQ(device.find([&] { sim->step_bus(); }), "");
    const auto moves = asked_moves(*right.arm, right.frame);
    std::size_t next = 0;
    Pose there = home_of(*right.arm);
    const auto pause = [&] {
      sim->plant().plant().pull(there, false);
      sim->step();
    };
    const auto hear = [&](const std::string& line) {
      there = home_of(*right.arm);
      if (!is_request(line)) return;
      const Vec3 along = rotate(conjugate(right.frame.orientation_w), moves[next++].along);
      there.position_m = there.position_m + kAskedMove_m * along;
    };
    MoveCheck check(device, *wrong.arm, wrong.frame, pause, hear);
    EXPECT_THAT(check.run().back().found, HasSubstr("axis 1 (node 1) is reversed")) << name;
    EXPECT_FALSE(sim->any_enabled());
  }
}

TEST(MoveCheck, SwappedAxesAreNamed) {
  for (const char* name : kShipped)
    for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      const std::string verdict = Person(shipped(name)).verdict({a, {}, b});
      EXPECT_THAT(verdict, HasSubstr("are swapped: their encoders, or their nodes")) << name << a << b;
      EXPECT_THAT(verdict, HasSubstr("fail: axis " + std::to_string(a + 1))) << name << a << b;
      EXPECT_THAT(verdict, HasSubstr("and axis " + std::to_string(b + 1))) << name << a << b;
    }
}

TEST(MoveCheck, ADeadEncoderIsNamed) {
  for (const char* name : kShipped)
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_THAT(Person(shipped(name)).verdict({axis, {.scale = 0}}),
                  testing::MatchesRegex("fail: axis " + std::to_string(axis + 1) + " .node .. did not count: .*"))
          << name;
}

TEST(MoveCheck, AWrongScaleIsNamed) {
  for (const char* name : kShipped)
    for (int axis = 0; axis < 3; ++axis)
      for (const double scale : {4.0, 0.25}) {
        const std::string verdict = Person(shipped(name)).verdict({axis, {.scale = scale}});
        EXPECT_THAT(verdict, HasSubstr("fail: axis " + std::to_string(axis + 1))) << name << scale;
        EXPECT_THAT(verdict, HasSubstr("times too much")) << name << scale;
      }
}

TEST(MoveCheck, AnotherWayThanAskedInAllMovesIsToldSo) {
  Person person(shipped(kShipped[0]));
  person.way = 0.4;
  EXPECT_THAT(person.verdict(), HasSubstr("times as far as was asked"));
}

TEST(MoveCheck, ATurnedFrameIsNamed) {
  Person person(shipped(kShipped[0]));
  person.place = rotation_by({0, 0.5 * kPi, 0});
  EXPECT_THAT(person.verdict(), HasSubstr("fail: the device stands turned"));
}

TEST(MoveCheck, TwoMistakesAreBothNamed) {
  Person person(shipped(kShipped[0]));
  person.set({0, {.scale = -1}});
  EXPECT_THAT(person.verdict({2, {.scale = -1}}), HasSubstr("fail: axis 1 (node 1) is reversed; axis 3 (node 3) is "));
}

TEST(MoveCheck, NobodyWhoMovesItIsNoProof) {
  Person person(shipped(kShipped[0]));
  person.lazy = true;
  EXPECT_THAT(person.verdict(), HasSubstr("fail: no axis counted a motion in 30 s"));
}

// Slides: two mistakes of axes look like a frame that stands turned, and both are said.
std::string slides() {
  std::string text = shipped("example-arm-odrive.toml");
  text =
      replaced(replaced(text, "kind = \"serial_3r\"", "kind = \"cartesian\""), "upper_mm = 205\nfore_mm = 245\n", "");
  for (std::size_t at = 0; (at = text.find("ratio = ", at)) != std::string::npos;)
    text.replace(at, text.find('\n', at) - at, "mm_per_turn = 20");
  for (const char* key : {"home", "lowest", "highest"})
    for (std::size_t at = 0; (at = text.find(std::string(key) + "_deg", at)) != std::string::npos; ++at)
      text.replace(at, std::string(key).size() + 4, std::string(key) + "_mm");
  for (const char* home : {"home_mm = 0", "home_mm = 80", "home_mm = -20"}) text = replaced(text, home, "home_mm = 1");
  for (const char* low : {"lowest_mm = -60", "lowest_mm = 10", "lowest_mm = -90"})
    text = replaced(text, low, "lowest_mm = -99");
  for (const char* high : {"highest_mm = 60", "highest_mm = 120", "highest_mm = 40"})
    text = replaced(text, high, "highest_mm = 99");
  return text;
}

TEST(MoveCheck, SlidesAreJudgedAlike) {
  EXPECT_THAT(Person(slides()).verdict(), HasSubstr("pass: "));
  EXPECT_THAT(Person(slides()).verdict({1, {.scale = -1}}), HasSubstr("fail: axis 2 (node 2) is reversed"));
  EXPECT_THAT(Person(slides()).verdict({0, {}, 2}), HasSubstr("fail: axis 1 (node 1) and axis 3 (node 3) are swapped"));
  Person two(slides());
  two.set({0, {.scale = -1}});
  EXPECT_THAT(two.verdict({2, {.scale = -1}}),
              testing::AllOf(HasSubstr("stands turned"), HasSubstr("axis 1 (node 1) is reversed; axis 3")));
}

// Three encoders on a handle that turns, without motors.
std::string gimbal() {
  std::string text = replaced(shipped("example-arm-odrive.toml"), "serial_3r", "serial_3r_gimbal");
  for (int i = 4; i <= 6; ++i)
    text += "[[axis]]\nnode = " + std::to_string(i) + "\nserial = " + std::to_string(i) +
            "\ncounts_per_turn = 4096\nratio = 1\ndirection = 1\nhome_deg = 0\nhome_turns = 0\nlowest_deg = -80\n"
            "highest_deg = 80\ntorque_max_Nm = 0\n";
  return text;
}

TEST(MoveCheck, AGimbalIsTurnedToo) {
  const auto row = [](const std::vector<DoctorItem>& rows, const char* name) {
    for (const DoctorItem& item : rows)
      if (item.name == name) return (item.verdict == Verdict::kPass ? "pass: " : "fail: ") + item.found;
    return std::string("no row");
  };
  EXPECT_THAT(row(Person(gimbal()).check(), "axes of the gimbal"), HasSubstr("pass: "));
  Person reversed(gimbal());
  reversed.set({4, {.scale = -1}});
  const auto rows = reversed.check();
  EXPECT_THAT(row(rows, "axes"), HasSubstr("pass: "));
  EXPECT_THAT(row(rows, "axes of the gimbal"), HasSubstr("fail: axis 5 (node 5) is reversed"));
  Person swapped(gimbal());
  EXPECT_THAT(swapped.verdict({3, {}, 5}), HasSubstr("axis 4 (node 4) and axis 6 (node 6) are swapped"));
}

TEST(PushCheck, MotorsThatPushTheWayTheyCountPass) {
  for (const char* name : kShipped) {
    const auto rows = Person(shipped(name)).push();
    ASSERT_EQ(rows.size(), 3u) << name;
    for (const DoctorItem& row : rows) EXPECT_EQ(row.verdict, Verdict::kPass) << name << row.found;
  }
}

TEST(PushCheck, AMotorThatPushesTheWrongWayIsNamedAndTheRestIsLeft) {
  for (const char* name : kShipped)
    for (int axis = 0; axis < 3; ++axis) {
      Person person(shipped(name));
      person.set({axis, {.motor = -1}});
      const auto rows = person.push();
      ASSERT_EQ(rows.size(), static_cast<std::size_t>(axis + 1)) << name;
      EXPECT_THAT(rows.back().name, HasSubstr("motor of axis " + std::to_string(axis + 1))) << name;
      EXPECT_EQ(rows.back().verdict, Verdict::kFail);
      EXPECT_THAT(rows.back().found, HasSubstr("pushes against its own count")) << name;
    }
}

TEST(PushCheck, AHandThatMovesIsNoProof) {
  Person person(shipped(kShipped[0]));
  person.restless = true;
  EXPECT_THAT(person.push().back().found, HasSubstr("moves by itself with no torque"));
}

TEST(PushCheck, AMotorThatMovesNothingIsNoProof) {
  Person person(shipped(kShipped[1]));
  person.set({1, {.motor = 0}});
  EXPECT_THAT(person.push().back().found, HasSubstr("does not move with 20 % of its torque"));
}

// A run does not even begin where a joint stands beyond its limits, which a wrong zero or another axis often means.
TEST(AxisDeviceStart, JointsBeyondTheirLimitsAreRefused) {
  EXPECT_EQ(Person(shipped(kShipped[0])).start(), "");
  Person swapped(shipped(kShipped[0]));
  swapped.set({1, {.shift_turns = 2.5}});  // 75 degrees of the joint
  const std::string wrong = swapped.start();
  EXPECT_THAT(wrong, HasSubstr("axis 2 stands at 155 degrees, its limits are 10 to 120"));
  EXPECT_THAT(wrong, HasSubstr("palpate device-test ADDRESS --profile FILE --move"));
  EXPECT_THAT(replaced(wrong, "155", ""), HasSubstr("axes are swapped"));
}

}  // namespace
}  // namespace palpate
