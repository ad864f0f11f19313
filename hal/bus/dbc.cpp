#include "hal/bus/dbc.h"

#include <cstdint>
#include <cstdio>

#include "hal/bus/codec.h"

namespace palpate::wire {
namespace {

// Shortest decimal that reads back as the same double.
std::string number(double value) {
  char text[32];
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    double back = 0;
    if (std::sscanf(text, "%lf", &back) == 1 && back == value) break;
  }
  return text;
}

std::string signal_line(const SignalInfo& s, const char* receiver) {
  const double lowest = s.is_signed ? -static_cast<double>(std::int64_t{1} << (s.bits - 1)) : 0;
  const double highest = static_cast<double>((std::int64_t{1} << (s.is_signed ? s.bits - 1 : s.bits)) - 1);
  return " SG_ " + std::string(s.name) + " : " + std::to_string(s.start) + "|" + std::to_string(s.bits) + "@1" +
         (s.is_signed ? "-" : "+") + " (" + number(s.unit_per_count) + ",0) [" + number(lowest * s.unit_per_count) +
         "|" + number(highest * s.unit_per_count) + "] \"" + s.unit + "\" " + receiver + "\n";
}

}  // namespace

std::string dbc_text(int node) {
  std::string text = "VERSION \"" + std::to_string(kVersion) +
                     "\"\n\nNS_ :\n\tCM_\n\tBA_DEF_\n\tBA_\n\tBA_DEF_DEF_\n\nBS_:\n\nBU_: Controller HapticNode\n\n";
  std::string comments, attributes;
  for (const MessageInfo& m : messages()) {
    const std::string id = std::to_string(m.base_id + static_cast<std::uint32_t>(node));
    const bool from_controller = std::string(m.sender) == "Controller";
    const char* receiver = from_controller ? "HapticNode" : "Controller";
    text += "BO_ " + id + " " + m.name + ": " + std::to_string(m.bytes) + " " + m.sender + "\n";
    for (const SignalInfo& s : m.signals) text += signal_line(s, receiver);
    const int bits = m.fd ? 16 : 8;
    text += signal_line({"Checksum", 8 * m.bytes - bits, bits, false, 1, "", ""}, receiver) + "\n";
    comments += "CM_ BO_ " + id + " \"" + m.meaning + "\";\n";
    for (const SignalInfo& s : m.signals) comments += "CM_ SG_ " + id + " " + s.name + " \"" + s.meaning + "\";\n";
    // 14 is StandardCAN_FD in the enumeration below, as the common tools number it.
    attributes += "BA_ \"VFrameFormat\" BO_ " + id + " " + (m.fd ? "14" : "0") + ";\n";
  }
  text += comments;
  text +=
      "BA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\",\"reserved\",\"J1939PG\",\"reserved\","
      "\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\","
      "\"reserved\",\"StandardCAN_FD\",\"ExtendedCAN_FD\";\nBA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN\";\n";
  return text + attributes;
}

}  // namespace palpate::wire
