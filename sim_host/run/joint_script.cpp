#include "sim_host/run/joint_script.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "sim_host/csv_cells.h"

namespace palpate {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
const std::vector<std::string> kFingers{"thumb", "index", "middle", "ring", "little"};

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw std::runtime_error(where + ": " + what);
}

double number(std::string_view text, const std::string& where) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value))
    refuse(where, fmt::format("'{}' is not a number", text));
  return value;
}

void set_fraction(JointCommand& joints, std::size_t finger, double value, const std::string& where) {
  if (!(value >= 0 && value <= 1)) refuse(where, fmt::format("{:g} is outside 0 (open) to 1 (closed)", value));
  joints.closing[finger] = static_cast<float>(value);
}

// Degrees or millimetres, within the joint's limits.
void set_joint(JointCommand& joints, const Model& model, std::size_t j, double value, const std::string& where) {
  const Joint& joint = model.joint[j];
  const bool slides = joint.kind == JointKind::kSlide;
  const double unit = slides ? 1e-3 : kDegree;
  const double low = joint.lowest / unit, high = joint.highest / unit;
  if (!(value >= low - 1e-9 && value <= high + 1e-9))
    refuse(where, fmt::format("{:g} is outside {:g} to {:g} {}", value, low, high, slides ? "mm" : "degrees"));
  joints.direct |= 1u << j;
  joints.target[j] = joint_target(joint, value * unit);
}

// One column's value into a row.
void set_cell(TimedJoints& row, const std::string& column, double value, const Model& model,
              const std::vector<std::string>& names, const std::string& where) {
  if (column == "time_s") {
    row.time_s = value;
  } else if (column == "closing") {
    for (std::size_t f = 0; f < kMaxFingers; ++f) set_fraction(row.joints, f, value, where);
  } else if (const auto f = std::find(kFingers.begin(), kFingers.end(), column); f != kFingers.end()) {
    set_fraction(row.joints, static_cast<std::size_t>(f - kFingers.begin()), value, where);
  } else {
    set_joint(row.joints, model, joint_named(names, column, where), value, where);
  }
}

void need_joints(const Model& model, const std::string& option) {
  if (model.joint.empty()) refuse(option, "the scene's tool has no joints; use it with a [hand] or a [gripper]");
}

}  // namespace

std::size_t joint_named(const std::vector<std::string>& names, const std::string& name, const std::string& where) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) refuse(where, fmt::format("no joint '{}'; joints are {}", name, fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

const std::vector<std::string>& finger_names() { return kFingers; }

std::vector<std::size_t> joints_of_finger(const Model& model, std::int32_t finger) {
  std::vector<std::size_t> joints;
  for (std::size_t j = 0; j < model.joint.size(); ++j)
    if (model.joint[j].finger == finger) joints.push_back(j);
  return joints;
}

float joint_target(const Joint& joint, double position) {
  const double within = std::clamp(position, joint.lowest, joint.highest);
  const auto target = static_cast<float>(within);
  // The tick compares in double precision, and would tell of a limit that nobody asked to pass.
  if (double{target} > joint.highest) return std::nextafter(target, -10.0f);
  if (double{target} < joint.lowest) return std::nextafter(target, 10.0f);
  return target;
}

void apply_joint_word(const std::string& word, const Model& model, const std::string& where, JointCommand& joints) {
  need_joints(model, where);
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) refuse(where, "write NAME=VALUE, as index_flexion=30");
  set_joint(joints, model, joint_named(joint_names(model), word.substr(0, equals), where),
            number(word.substr(equals + 1), where), where);
}

std::vector<std::string> joint_names(const Model& model) {
  std::vector<std::string> names;
  if (model.params.articulation == Articulation::kHand) {
    names = {"thumb_root_spread", "thumb_root_flexion", "thumb_spread", "thumb_flexion", "thumb_tip_flexion"};
    for (std::size_t f = 1; f < kFingers.size(); ++f)
      for (const char* joint : {"_spread", "_flexion", "_middle_flexion", "_tip_flexion"})
        names.push_back(kFingers[f] + joint);
    return names;
  }
  for (std::size_t j = 0; j < model.joint.size(); ++j) names.push_back(fmt::format("jaw{}", j));
  return names;
}

std::vector<TimedJoints> read_joint_table(std::istream& text, const std::string& name, const Model& model) {
  const std::vector<std::string> names = joint_names(model);
  std::vector<TimedJoints> rows;
  std::vector<std::string> columns;
  std::string line;
  for (int at = 1; std::getline(text, line); ++at) {
    const std::string_view content = trimmed(line);
    const std::string where = fmt::format("{}:{}", name, at);
    if (content.empty() || content[0] == '#') continue;
    const std::vector<std::string_view> cells = cells_of(line);
    if (columns.empty()) {
      columns.assign(cells.begin(), cells.end());
      if (std::count(columns.begin(), columns.end(), "time_s") != 1) refuse(where, "needs one column time_s");
      for (const std::string& column : columns)
        if (column != "time_s" && column != "closing" && std::ranges::find(kFingers, column) == kFingers.end())
          joint_named(names, column, where);
      continue;
    }
    if (cells.size() != columns.size())
      refuse(where, fmt::format("{} values, but the header names {} columns", cells.size(), columns.size()));
    TimedJoints row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string cell_where = where + ": " + columns[i];
      set_cell(row, columns[i], number(cells[i], cell_where), model, names, cell_where);
    }
    if (!rows.empty() && !(row.time_s > rows.back().time_s))
      refuse(where, fmt::format("time_s: {:g} does not come after {:g}", row.time_s, rows.back().time_s));
    rows.push_back(row);
  }
  if (rows.empty()) refuse(name, "no rows; the first one names the columns: time_s, closing, fingers, joints");
  return rows;
}

std::vector<TimedJoints> scripted_joints(const PathDesc& path) {
  std::vector<TimedJoints> rows;
  JointCommand now;
  for (const PathPoint& point : path.point) {
    for (std::size_t f = 0; !point.closing.empty() && f < kMaxFingers; ++f)
      now.closing[f] = static_cast<float>(point.closing[point.closing.size() == 1 ? 0 : f]);
    rows.push_back({point.time_s, now});
  }
  return rows;
}

JointScript::JointScript(const JointOptions& options, const Model& model, std::vector<TimedJoints> scripted) {
  if (options.empty()) return;
  need_joints(model, !options.close.empty() ? "--close" : !options.joint.empty() ? "--joint" : "--joints");
  if (!options.table.empty()) {
    if (!options.close.empty() || !options.joint.empty())
      refuse("--joints", "a table leaves nothing to --close and --joint; give one or the other");
    std::ifstream file(options.table);
    if (!file) refuse(options.table, std::string("cannot read: ") + std::strerror(errno));
    rows_ = read_joint_table(file, options.table, model);
    return;
  }
  TimedJoints row;
  if (options.close.size() > 1 && options.close.size() != kMaxFingers)
    refuse("--close", fmt::format("{} values; allowed 1 or {}, thumb first", options.close.size(), kMaxFingers));
  for (std::size_t f = 0; !options.close.empty() && f < kMaxFingers; ++f)
    set_fraction(row.joints, f, options.close[options.close.size() == 1 ? 0 : f], "--close");
  for (const std::string& given : options.joint) apply_joint_word(given, model, "--joint " + given, row.joints);
  const bool closes = std::ranges::any_of(scripted, [](const TimedJoints& r) {
    return std::ranges::any_of(r.joints.closing, [](float closing) { return closing > 0; });
  });
  if (!closes) scripted = {row};
  for (TimedJoints& r : scripted) {
    for (std::size_t f = 0; closes && !options.close.empty() && f < kMaxFingers; ++f)
      r.joints.closing[f] *= row.joints.closing[f];
    std::copy_n(row.joints.target, kMaxJoints, r.joints.target);
    r.joints.direct = row.joints.direct;
  }
  rows_ = std::move(scripted);
}

JointCommand JointScript::at(double time_s) const {
  if (rows_.empty()) return {};
  const auto after = std::upper_bound(rows_.begin(), rows_.end(), time_s,
                                      [](double at, const TimedJoints& row) { return at < row.time_s; });
  if (after == rows_.begin()) return rows_.front().joints;
  if (after == rows_.end()) return rows_.back().joints;
  const TimedJoints &a = *(after - 1), &b = *after;
  const auto s = static_cast<float>((time_s - a.time_s) / (b.time_s - a.time_s));
  JointCommand joints = a.joints;
  const auto mix = [s](float from, float to) { return from + s * (to - from); };
  for (std::size_t f = 0; f < kMaxFingers; ++f)
    joints.closing[f] = std::clamp(mix(a.joints.closing[f], b.joints.closing[f]), 0.0f, 1.0f);
  for (std::size_t j = 0; j < kMaxJoints; ++j) joints.target[j] = mix(a.joints.target[j], b.joints.target[j]);
  return joints;
}

}  // namespace palpate
