#include "hal/device/fault_script.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace palpate {
namespace {

struct Kind {
  DeviceFault fault;
  const char* word;
  double value, lowest, highest;
  const char* what;
};

constexpr Kind kKinds[] = {
#define PALPATE_KIND(kind, word, value, lowest, highest, what) {DeviceFault::kind, word, value, lowest, highest, what},
    PALPATE_DEVICE_FAULTS(PALPATE_KIND)
#undef PALPATE_KIND
};

bool number(const std::string& text, double lowest, double highest, double& value) {
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' && value >= lowest && value <= highest;
}

std::string range(double lowest, double highest) {
  char text[64];
  std::snprintf(text, sizeof text, "%g to %g", lowest, highest);
  return text;
}

// Reads one line with something on it; an empty answer is success.
std::string read_line(const std::string& text, FaultLine& line) {
  std::istringstream words(text);
  std::string at, word, value, more;
  words >> at >> word >> value >> more;
  constexpr double kLongest_s = 1e6;
  if (!number(at, 0, kLongest_s, line.at_s)) {
    return "'" + at + "' is not a time in seconds, " + range(0, kLongest_s) + ": write AT_S KIND [VALUE]";
  }
  const Kind* kind = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& k) { return word == k.word; });
  if (kind == std::end(kKinds)) {
    std::string known;
    for (const Kind& k : kKinds) known += std::string(known.empty() ? "" : ", ") + k.word;
    return "no fault '" + word + "'; known are " + known;
  }
  line.fault = kind->fault;
  line.value = kind->value;
  const bool takes_value = kind->highest > kind->lowest;
  if (!value.empty() && !takes_value) return word + " takes no value";
  if (!more.empty()) return "'" + more + "' is one word too many";
  if (!value.empty() && !number(value, kind->lowest, kind->highest, line.value)) {
    return word + ": '" + value + "' is not a number in the range " + range(kind->lowest, kind->highest);
  }
  return "";
}

}  // namespace

bool parse_fault_script(const std::string& text, std::vector<FaultLine>& lines, std::string& error) {
  std::istringstream input(text);
  std::string row;
  for (int number = 1; std::getline(input, row); ++number) {
    row.erase(std::min(row.find('#'), row.size()));
    if (row.find_first_not_of(" \t\r") == std::string::npos) continue;
    FaultLine line;
    const std::string wrong = read_line(row, line);
    if (!wrong.empty()) {
      error = "line " + std::to_string(number) + ": " + wrong;
      return false;
    }
    lines.push_back(line);
  }
  std::stable_sort(lines.begin(), lines.end(), [](const FaultLine& a, const FaultLine& b) { return a.at_s < b.at_s; });
  return true;
}

std::string fault_script_help() {
  std::string text;
  for (const Kind& kind : kKinds) {
    char row[160];
    std::snprintf(row, sizeof row, "      %-10s %s\n", kind.word, kind.what);
    text += row;
  }
  return text;
}

}  // namespace palpate
