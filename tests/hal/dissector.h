// What another program makes of frames: they are written as a capture and read by Wireshark's command line (tshark),
// whose dissectors were written by others from the standards; the program and the package are called tshark.
#pragma once

#include <linux/can.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "hal/bus/transport.h"

namespace palpate::test {

// Of a command; "" where it failed.
inline std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  return ::pclose(pipe) == 0 ? text : "";
}

// pcap, version 2.4, link type 227 (LINKTYPE_CAN_SOCKETCAN): identifier and flags in network order, length, flags of
// FD, two reserved bytes, data. One frame a microsecond: only their order counts.
inline void write_capture(const std::string& file, const std::vector<Frame>& frames) {
  std::ofstream out(file, std::ios::binary);
  const auto little = [&out](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) out.put(static_cast<char>(value >> 8 * i & 0xFF));
  };
  little(0xA1B2C3D4, 4), little(2, 2), little(4, 2), little(0, 4), little(0, 4), little(65535, 4), little(227, 4);
  std::uint32_t time_us = 0;
  for (const Frame& frame : frames) {
    const std::uint32_t bytes = 8u + frame.length;
    little(0, 4), little(++time_us, 4), little(bytes, 4), little(bytes, 4);
    const std::uint32_t id = frame.id | (frame.remote ? CAN_RTR_FLAG : 0);
    for (int i = 3; i >= 0; --i) out.put(static_cast<char>(id >> 8 * i & 0xFF));
    out.put(static_cast<char>(frame.length)).put(static_cast<char>(frame.fd ? 4 : 0)).put(0).put(0);
    out.write(reinterpret_cast<const char*>(frame.data), frame.length);
  }
}

// The log of `candump -L`, which python-can reads.
inline void write_candump(const std::string& file, const std::vector<Frame>& frames) {
  std::ofstream out(file);
  char text[48];
  std::uint32_t time_us = 0;
  for (const Frame& frame : frames) {
    std::snprintf(text, sizeof text, "(0.%06u) can0 %03X#", ++time_us, frame.id);
    out << text << (frame.remote ? "R" : "");
    for (int i = 0; i < frame.length && !frame.remote; ++i) {
      std::snprintf(text, sizeof text, "%02X", static_cast<unsigned>(frame.data[i]));
      out << text;
    }
    out << "\n";
  }
}

// Such a log by a .dbc of the sources, as canmatrix decodes it (decode_log.py, with Debian's own Python).
struct DecodedFrame {
  std::string name;
  std::map<std::string, double> value;
};
inline std::vector<DecodedFrame> decode(const std::string& sources, const std::string& dbc, const std::string& log) {
  const std::string command = "/usr/bin/python3 '" + sources + "/tests/hal/decode_log.py' '" + sources + "/" + dbc +
                              "' '" + log + "' 2> /dev/null";
  std::vector<DecodedFrame> frames;
  std::istringstream lines(output_of(command));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    DecodedFrame& frame = frames.emplace_back();
    words >> frame.name;
    double value = 0;
    for (std::string name; words >> name >> value;) frame.value[name] = value;
  }
  return frames;
}

using Dissected = std::vector<std::vector<std::string>>;  // of each frame, the fields that were asked for; "": has none
inline Dissected dissect(const std::string& file, const std::string& protocol, const std::vector<std::string>& fields) {
  std::string command = "tshark -r '" + file + "' -d can.subdissector," + protocol + " -T fields -E separator='|'";
  for (const std::string& field : fields) command += " -e " + field;
  Dissected rows;
  std::istringstream lines(output_of(command + " 2> /dev/null"));
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> row(1);
    for (const char c : line) c == '|' ? row.emplace_back() : row.back() += c;
    row.resize(fields.size());
    rows.push_back(row);
  }
  return rows;
}

}  // namespace palpate::test
