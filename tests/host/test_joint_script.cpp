// Joint commands typed at the command line: what they mean, what is refused with which words, and that a run obeys.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "sim_host/bake/scene_model.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/run/joint_script.h"
#include "sim_host/run/process.h"
#include "tests/support/ball_run.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

std::string scene_path(const std::string& name) {
  return std::string(PALPATE_SOURCE_DIR) + "/config/scenes/" + name + ".toml";
}

const Model& hand() {
  static const SceneModel scene(scene_path("grasp_cylinder_2"));
  return scene.model();
}

std::string refusal(const JointOptions& options, const Model& model) {
  return test::refusal_by<std::runtime_error>([&] { const JointScript script(options, model); });
}

std::string table_refusal(const std::string& table) {
  std::istringstream text(table);
  return test::refusal_by<std::runtime_error>([&] { read_joint_table(text, "t.csv", hand()); });
}

TEST(JointScript, ClosesAllFingersOrEachItsOwn) {
  EXPECT_TRUE(JointScript().empty());
  EXPECT_TRUE(JointScript({}, hand()).empty());
  const JointCommand all = JointScript({{0.7}, {}, ""}, hand()).at(3);
  for (const float closing : all.closing) EXPECT_EQ(closing, 0.7f);
  EXPECT_EQ(all.direct, 0u);
  const JointCommand each = JointScript({{1, 0.8, 0, 0.25, 0}, {}, ""}, hand()).at(0);
  EXPECT_EQ(each.closing[1], 0.8f);
  EXPECT_EQ(each.closing[3], 0.25f);
}

// Where the motion itself closes the hand, the option says how far.
TEST(JointScript, ClosesAsFarAsToldWhenTheMotionCloses) {
  const SceneModel scene(scene_path("grasp_cylinder_2"));
  const std::vector<TimedJoints> scripted = scripted_joints(scene.scene()->path);
  ASSERT_EQ(scripted.size(), scene.scene()->path.point.size());
  const JointScript script({{0.5, 1, 0, 0, 0}, {"index_tip_flexion=20"}, ""}, hand(), scripted);
  for (const TimedJoints& row : scripted) {
    const JointCommand command = script.at(row.time_s);
    EXPECT_EQ(command.closing[0], 0.5f * row.joints.closing[0]) << row.time_s;
    EXPECT_EQ(command.closing[1], row.joints.closing[1]) << row.time_s;
    EXPECT_EQ(command.closing[2], 0) << row.time_s;
    EXPECT_EQ(command.direct, 1u << 8) << row.time_s;
  }
  // One joint alone leaves the closing as it is.
  const JointScript joint({{}, {"index_tip_flexion=20"}, ""}, hand(), scripted);
  EXPECT_EQ(joint.at(scripted[3].time_s).closing[0], scripted[3].joints.closing[0]);
}

TEST(JointScript, NamesEveryJointOfTheHandOnce) {
  const std::vector<std::string> names = joint_names(hand());
  ASSERT_EQ(names.size(), hand().joint.size());
  JointOptions options;
  for (const std::string& name : names) options.joint.push_back(name + "=1.5");
  const JointCommand command = JointScript(options, hand()).at(0);
  EXPECT_EQ(command.direct, (1u << kMaxJoints) - 1);
  for (const float target : command.target) EXPECT_NEAR(static_cast<double>(target), 1.5 * kDegree, 1e-8);
  EXPECT_EQ(names[6], "index_flexion");
  EXPECT_EQ(names[20], "little_tip_flexion");
}

TEST(JointScript, TableIsInterpolatedInTimeAndHeldAtItsEnds) {
  std::istringstream text("# slow\ntime_s, index, middle_tip_flexion\n1, 0, 10\n3, 1, 30\n");
  const std::vector<TimedJoints> rows = read_joint_table(text, "t.csv", hand());
  ASSERT_EQ(rows.size(), 2u);
  const std::string file = testing::TempDir() + "joints.csv";
  std::ofstream(file) << "time_s,index,middle_tip_flexion\n1,0,10\n3,1,30\n";
  const JointScript script({{}, {}, file}, hand());
  for (const auto& [time_s, share] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.5, 0.25}, {3.0, 1.0}, {9.0, 1.0}}) {
    const JointCommand command = script.at(time_s);
    EXPECT_NEAR(static_cast<double>(command.closing[1]), share, 1e-6) << time_s;
    EXPECT_EQ(command.closing[2], 0);
    EXPECT_NEAR(static_cast<double>(command.target[12]), (10 + 20 * share) * kDegree, 1e-6) << time_s;
    EXPECT_EQ(command.direct, 1u << 12);
  }
}

TEST(JointScript, MistakesAreNamedWithWhatIsAllowed) {
  EXPECT_NE(refusal({{1.5}, {}, ""}, hand()).find("--close: 1.5 is outside 0 (open) to 1 (closed)"), std::string::npos);
  EXPECT_NE(refusal({{std::nan("")}, {}, ""}, hand()).find("--close"), std::string::npos);
  EXPECT_NE(refusal({{1, 0}, {}, ""}, hand()).find("2 values; allowed 1 or 5"), std::string::npos);
  EXPECT_NE(refusal({{}, {"index_flexion"}, ""}, hand()).find("NAME=VALUE"), std::string::npos);
  EXPECT_NE(refusal({{}, {"toe=1"}, ""}, hand()).find("no joint 'toe'; joints are thumb_root_spread"),
            std::string::npos);
  EXPECT_NE(refusal({{}, {"index_flexion=91"}, ""}, hand()).find("91 is outside -20 to 90 degrees"), std::string::npos);
  EXPECT_NE(refusal({{}, {"index_flexion=x"}, ""}, hand()).find("'x' is not a number"), std::string::npos);
  EXPECT_NE(refusal({{0.5}, {}, "t.csv"}, hand()).find("one or the other"), std::string::npos);
  EXPECT_NE(refusal({{}, {}, "/nowhere.csv"}, hand()).find("/nowhere.csv: cannot read"), std::string::npos);
  const SceneModel rigid(scene_path("ellipsoid_mallet"));
  EXPECT_NE(refusal({{0.5}, {}, ""}, rigid.model()).find("the scene's tool has no joints"), std::string::npos);
  EXPECT_NE(table_refusal("").find("no rows"), std::string::npos);
  EXPECT_NE(table_refusal("closing\n1\n").find("t.csv:1: needs one column time_s"), std::string::npos);
  EXPECT_NE(table_refusal("time_s,toe\n").find("no joint 'toe'"), std::string::npos);
  EXPECT_NE(table_refusal("time_s,closing\n0\n").find("t.csv:2: 1 values, but the header names 2"), std::string::npos);
  EXPECT_NE(table_refusal("time_s,closing\n0,2\n").find("t.csv:2: closing: 2 is outside 0"), std::string::npos);
  EXPECT_NE(table_refusal("time_s,closing\n1,0\n1,1\n").find("t.csv:3: time_s: 1 does not come after 1"),
            std::string::npos);
}

class RunWithJoints : public BallRun {};

// Through the mailbox into the running controller: the records hold the command, and nothing else closes the hand.
TEST_F(RunWithJoints, TheControllerIsTold) {
  // The scene's path without its closing: told from the beginning.
  std::ifstream source(scene_path("grasp_cylinder_2"));
  const std::string text{std::istreambuf_iterator<char>(source), {}};
  options_.scene = (folder_ / "hand.toml").string();
  std::ofstream(options_.scene) << std::regex_replace(text, std::regex(", closing = \\[[^]]*\\]"), "");
  options_.record = (folder_ / "run.plr").string();
  options_.image = (folder_ / "run.pal").string();
  options_.duration_s = 1.0;
  options_.joints = {{0.7}, {"index_tip_flexion=20"}, ""};
  run_session(options_);
  const MappedFile file(options_.record);
  RecordingReader reader(file.bytes());
  TickRecord record, last;
  while (reader.next(record)) last = record;
  ASSERT_GT(reader.records(), 0u);
  EXPECT_EQ(last.input.joints.closing[0], 0.7f);
  EXPECT_EQ(last.input.joints.direct, 1u << 8);
  EXPECT_NEAR(static_cast<double>(last.input.joints.target[8]), 20 * kDegree, 1e-6);
  EXPECT_EQ(last.input.buttons & kButtonClose, 0u);
}

TEST_F(RunWithJoints, ARigidToolIsRefusedBeforeAnythingStarts) {
  options_.record = (folder_ / "run.plr").string();
  options_.joints.close = {0.5};
  EXPECT_THROW(run_session(options_), std::runtime_error);
}

}  // namespace
}  // namespace palpate
