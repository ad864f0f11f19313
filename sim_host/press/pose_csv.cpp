#include "sim_host/press/pose_csv.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "hal/device/hand_path.h"
#include "sim_host/csv_cells.h"
#include "sim_host/run/joint_script.h"

namespace palpate {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
// Further than this from the origin a position in millimetres is a mistake of units (the loader's largest body: 10 m).
constexpr double kFarthest_mm = 1e5;

enum Column { kTime, kX, kY, kZ, kRx, kRy, kRz, kQw, kQx, kQy, kQz, kClosing, kColumns };
constexpr std::array<const char*, kColumns> kNames = {"time_s", "x_mm", "y_mm", "z_mm", "rx_deg", "ry_deg",
                                                      "rz_deg", "qw",   "qx",   "qy",   "qz",     "closing"};
constexpr const char* kAllowed =
    "allowed are time_s, x_mm, y_mm, z_mm, closing, and either rx_deg, ry_deg, rz_deg or qw, qx, qy, qz";

[[noreturn]] void refuse(const std::string& name, int line, const std::string& what) {
  throw std::runtime_error(fmt::format("{}:{}: {}", name, line, what));
}

// Which column of the file holds which value.
struct Header {
  std::vector<Column> order;
  std::array<bool, kColumns> has{};
};

Header read_header(std::string_view text, const std::string& name, int line) {
  Header header;
  for (const std::string_view cell : cells_of(text)) {
    std::optional<Column> column;
    for (int k = 0; k < kColumns; ++k) {
      if (cell == kNames[static_cast<std::size_t>(k)]) column = static_cast<Column>(k);
    }
    if (!column) refuse(name, line, fmt::format("unknown column '{}'; {}", cell, kAllowed));
    if (header.has[*column]) refuse(name, line, fmt::format("column {} appears twice", cell));
    header.has[*column] = true;
    header.order.push_back(*column);
  }
  const auto all_or_none = [&](Column first, Column last, bool required) {
    int present = 0;
    for (int k = first; k <= last; ++k) present += header.has[static_cast<std::size_t>(k)] ? 1 : 0;
    if (present == last - first + 1 || (present == 0 && !required)) return;
    for (int k = first; k <= last; ++k) {
      if (!header.has[static_cast<std::size_t>(k)]) {
        refuse(name, line, fmt::format("column {} is missing; {}", kNames[static_cast<std::size_t>(k)], kAllowed));
      }
    }
  };
  all_or_none(kX, kZ, true);
  all_or_none(kRx, kRz, false);
  all_or_none(kQw, kQz, false);
  if (header.has[kRx] && header.has[kQw])
    refuse(name, line, "both a rotation vector and a quaternion; give one of them");
  return header;
}

using Row = std::array<double, kColumns>;

Row read_row(std::string_view text, const Header& header, const std::string& name, int line) {
  const std::vector<std::string_view> cells = cells_of(text);
  if (cells.size() != header.order.size()) {
    refuse(name, line, fmt::format("{} values, but the header names {} columns", cells.size(), header.order.size()));
  }
  Row row{};
  row[kQw] = 1;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Column column = header.order[i];
    const char* label = kNames[column];
    double value = 0;
    const char* end = cells[i].data() + cells[i].size();
    const auto [stop, error] = std::from_chars(cells[i].data(), end, value);
    if (error != std::errc{} || stop != end)
      refuse(name, line, fmt::format("{}: '{}' is not a number", label, cells[i]));
    if (!std::isfinite(value)) refuse(name, line, fmt::format("{}: '{}' is not finite", label, cells[i]));
    if (column >= kX && column <= kZ && std::abs(value) > kFarthest_mm) {
      refuse(name, line, fmt::format("{}: {:g} is outside -1e5 to 1e5 mm; check the unit", label, value));
    }
    if (column == kClosing && !(value >= 0 && value <= 1)) {
      refuse(name, line, fmt::format("{}: {:g} is outside 0 (open) to 1 (closed)", label, value));
    }
    row[column] = value;
  }
  return row;
}

Pose pose_of(const Row& row, const Header& header, const std::string& name, int line) {
  Pose pose{{row[kX] * 1e-3, row[kY] * 1e-3, row[kZ] * 1e-3}, {}};
  if (header.has[kRx]) pose.orientation = rotation_by(kDegree * Vec3{row[kRx], row[kRy], row[kRz]});
  if (header.has[kQw]) {
    const Quat q{row[kQw], row[kQx], row[kQy], row[kQz]};
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(std::abs(length - 1) <= 1e-3)) {
      refuse(name, line, fmt::format("qw, qx, qy, qz: length {:g}; a rotation has length 1 (to 0.001)", length));
    }
    pose.orientation = normalised(q);
  }
  return pose;
}

JointCommand all_fingers(double closing) {
  JointCommand joints;
  for (float& finger : joints.closing) finger = static_cast<float>(closing);
  return joints;
}

// What each finger is told between two commands, `s` of the way: 0 the first, 1 the second.
JointCommand between(const JointCommand& a, const JointCommand& b, double s) {
  JointCommand joints;
  for (std::size_t f = 0; f < kMaxFingers; ++f) {
    const auto from = static_cast<double>(a.closing[f]), to = static_cast<double>(b.closing[f]);
    joints.closing[f] = static_cast<float>(clamp_to(from + s * (to - from), 0, 1));
  }
  return joints;
}

}  // namespace

std::vector<TimedPose> read_poses(std::istream& text, const std::string& name, double period_s) {
  std::vector<TimedPose> poses;
  std::optional<Header> header;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    const std::string_view content = trimmed(line);
    if (content.empty() || content[0] == '#') continue;
    if (!header) {
      header = read_header(content, name, number);
      continue;
    }
    const Row row = read_row(line, *header, name, number);
    const double time_s = header->has[kTime] ? row[kTime] : period_s * static_cast<double>(poses.size());
    if (!poses.empty() && !(time_s > poses.back().time_s)) {
      refuse(name, number, fmt::format("time_s: {:g} does not come after {:g}", time_s, poses.back().time_s));
    }
    poses.push_back({time_s, pose_of(row, *header, name, number), all_fingers(row[kClosing])});
  }
  if (!header) throw std::runtime_error(fmt::format("{}: empty; the first row names the columns: {}", name, kAllowed));
  if (poses.empty()) throw std::runtime_error(name + ": no rows after the header");
  return poses;
}

std::vector<TimedPose> read_pose_file(const std::string& path, double period_s) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(fmt::format("{}: cannot read: {}", path, std::strerror(errno)));
  return read_poses(file, path, period_s);
}

std::vector<TimedPose> resample(std::span<const TimedPose> poses, double period_s) {
  std::vector<TimedPose> out;
  if (poses.empty()) return out;
  const double start = poses.front().time_s, duration = poses.back().time_s - start;
  constexpr double kLongest = 1e8;  // ticks: more than a day at 1 kHz is a mistake of units
  if (!(period_s > 0) || !(duration / period_s < kLongest)) throw std::runtime_error("path too long to resample");
  const auto ticks = static_cast<std::size_t>(std::floor(duration / period_s + 1e-6));
  std::size_t k = 0;
  for (std::size_t n = 0; n <= ticks; ++n) {
    const double time_s = start + period_s * static_cast<double>(n);
    while (k + 2 < poses.size() && poses[k + 1].time_s <= time_s) ++k;
    const TimedPose& a = poses[k];
    const TimedPose& b = poses[std::min(k + 1, poses.size() - 1)];
    const double t = b.time_s > a.time_s ? clamp_to((time_s - a.time_s) / (b.time_s - a.time_s), 0, 1) : 0;
    const Vec3 turn = rotation_vector(conjugate(a.tool_w.orientation) * b.tool_w.orientation);
    out.push_back({time_s,
                   {a.tool_w.position_m + t * (b.tool_w.position_m - a.tool_w.position_m),
                    normalised(a.tool_w.orientation * rotation_by(t * turn))},
                   between(a.joints, b.joints, t)});
  }
  return out;
}

std::vector<TimedPose> scripted_poses(const PathDesc& path, double period_s) {
  std::vector<HandPose> points;
  for (const PathPoint& p : path.point) points.push_back({p.time_s, {p.position_m, rotation_by(p.rotation_rad)}});
  const HandPath hand(std::move(points));
  if (!hand.error().empty()) throw std::runtime_error("path: " + hand.error());
  const std::vector<TimedJoints> commands = scripted_joints(path);
  std::vector<TimedPose> poses;
  const auto ticks = static_cast<std::int64_t>(std::floor(hand.end_s() / period_s + 1e-6));
  std::size_t k = 0;
  for (std::int64_t n = 0; n <= ticks; ++n) {
    const double time_s = period_s * static_cast<double>(n);
    while (k + 2 < commands.size() && path.point[k + 1].time_s <= time_s) ++k;
    const std::size_t next = std::min(k + 1, commands.size() - 1);
    const double span_s = path.point[next].time_s - path.point[k].time_s;
    const double u = span_s > 0 ? clamp_to((time_s - path.point[k].time_s) / span_s, 0, 1) : 0;
    const double s = u * u * u * (10 + u * (-15 + 6 * u));  // minimum jerk, as the pose
    poses.push_back({time_s, hand.at(time_s).pose, between(commands[k].joints, commands[next].joints, s)});
  }
  return poses;
}

}  // namespace palpate
