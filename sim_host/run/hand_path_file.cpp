#include "sim_host/run/hand_path_file.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace palpate {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

// Numbers of one comma-separated line; false when a field is no finite number.
bool read_numbers(const std::string& line, std::vector<double>& numbers) {
  numbers.clear();
  const char* at = line.c_str();
  for (;;) {  // bound: fields of the line
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end == at || !std::isfinite(value)) return false;
    numbers.push_back(value);
    while (*end == ' ' || *end == '\t' || *end == '\r') ++end;
    if (*end == '\0') return true;
    if (*end != ',') return false;
    at = end + 1;
  }
}

HandPose pose_of(const std::vector<double>& n) {
  HandPose pose{n[0], {{1e-3 * n[1], 1e-3 * n[2], 1e-3 * n[3]}, {}}};
  if (n.size() >= 7) pose.pose.orientation = rotation_by({kDegree * n[4], kDegree * n[5], kDegree * n[6]});
  pose.trigger = n.size() == 8 && n[7] > 0.5;
  return pose;
}

}  // namespace

bool read_hand_path(const std::string& path, std::vector<HandPose>& poses, std::string& error) {
  poses.clear();
  std::error_code none;
  if (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none)) {
    error = path + ": is no ordinary file";  // /dev/zero has no end
    return false;
  }
  std::ifstream file(path);
  if (!file) {
    error = path + ": cannot open: " + std::strerror(errno);
    return false;
  }
  std::string line;
  std::vector<double> numbers;
  bool names_allowed = true;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
    const bool names = names_allowed && std::isalpha(static_cast<unsigned char>(line[0])) != 0;
    names_allowed = false;
    if (names) continue;
    const std::string where = path + ":" + std::to_string(number) + ": ";
    if (!read_numbers(line, numbers) || (numbers.size() != 4 && numbers.size() != 7 && numbers.size() != 8)) {
      error = where + "expected time_s,x_mm,y_mm,z_mm[,rx_deg,ry_deg,rz_deg[,closing]], got '" + line + "'";
      return false;
    }
    if (!poses.empty() && !(numbers[0] > poses.back().time_s)) {
      error = where + "time_s must rise from row to row";
      return false;
    }
    poses.push_back(pose_of(numbers));
  }
  if (poses.empty()) error = path + ": no poses";
  return !poses.empty();
}

}  // namespace palpate
