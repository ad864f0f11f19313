// What a person at the command line tells an articulated tool's joints: one command for the whole time, or a table of
// commands by time.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "config/scene/scene.h"
#include "rt_core/io.h"
#include "rt_core/model.h"

namespace palpate {

// As typed; nothing checked yet.
struct JointOptions {
  std::vector<double> close;       // --close: one fraction for all fingers, or one per finger
  std::vector<std::string> joint;  // --joint: NAME=VALUE, degrees or millimetres
  std::string table;               // --joints: CSV file
  bool empty() const { return close.empty() && joint.empty() && table.empty(); }
};

// Name of each joint: of a hand by finger, of a gripper jaw0, jaw1, ...
std::vector<std::string> joint_names(const Model& model);
// Thumb first.
const std::vector<std::string>& finger_names();
// Those a finger moves when it closes, from the palm to the tip; of a gripper all.
std::vector<std::size_t> joints_of_finger(const Model& model, std::int32_t finger);
// A position (rad or m) as a command has it: within the joint's limits, not beyond by a rounding either.
float joint_target(const Joint& joint, double position);
// "NAME=VALUE", degrees or millimetres, into the command; throws as JointScript does, naming `where`.
void apply_joint_word(const std::string& word, const Model& model, const std::string& where, JointCommand& joints);
// Number of a joint by its name; throws naming `where` and the joints there are.
std::size_t joint_named(const std::vector<std::string>& names, const std::string& name, const std::string& where);

struct TimedJoints {
  double time_s = 0;
  JointCommand joints;
};

// Commands over time. Empty: nothing is commanded.
class JointScript {
 public:
  JointScript() = default;
  // `scripted`: how the motion itself closes the hand. Where it does, --close says how far, and otherwise how far from
  // the beginning; a table replaces it. Throws std::runtime_error naming the option, what is wrong and what is allowed.
  JointScript(const JointOptions& options, const Model& model, std::vector<TimedJoints> scripted = {});
  bool empty() const { return rows_.empty(); }
  // Between rows linear, before the first and after the last row that row's.
  JointCommand at(double time_s) const;

 private:
  std::vector<TimedJoints> rows_;
};

// What a scene's path tells the fingers at each of its points.
std::vector<TimedJoints> scripted_joints(const PathDesc& path);

// Reads a table with a header row: time_s (strictly increasing), and any of `closing` (all fingers), the fingers thumb,
// index, middle, ring, little (fractions 0 to 1) and joint names (degrees; slides in millimetres). Blank lines and
// lines that start with # are skipped. Throws std::runtime_error "NAME:LINE: COLUMN: what is wrong; what is allowed".
std::vector<TimedJoints> read_joint_table(std::istream& text, const std::string& name, const Model& model);

}  // namespace palpate
