#include "sim_host/latency/cyclictest_format.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

namespace palpate {

namespace {

double mean_us(const MicrosecondHistogram& thread) {
  return thread.cycles == 0 ? 0.0 : static_cast<double>(thread.sum_us) / static_cast<double>(thread.cycles);
}

// cyclictest's own key names: two of them end in a colon, which is part of the key.
constexpr const char* kCommandLineKey = "cmdline:";
constexpr const char* kVersionKey = "rt_test_version:";

}  // namespace

CyclictestRun this_system() {
  CyclictestRun run;
  utsname name{};
  if (uname(&name) == 0) {
    run.sysname = name.sysname;
    run.nodename = name.nodename;
    run.release = name.release;
    run.version = name.version;
    run.machine = name.machine;
  }
  int flag = 0;
  std::ifstream file("/sys/kernel/realtime");
  run.realtime_kernel = (file >> flag) && flag == 1;
  return run;
}

std::string rfc2822_time(std::int64_t seconds_since_1970) {
  const std::time_t time = seconds_since_1970;
  std::tm utc{};
  gmtime_r(&time, &utc);
  static constexpr const char* kDay[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  static constexpr const char* kMonth[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                           "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  return fmt::format("{}, {:02} {} {} {:02}:{:02}:{:02} +0000", kDay[utc.tm_wday], utc.tm_mday, kMonth[utc.tm_mon],
                     utc.tm_year + 1900, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

std::string cyclictest_text(const std::vector<MicrosecondHistogram>& threads) {
  std::string text = "# Histogram\n";
  for (std::int32_t row = 0; row < kCyclictestBins; ++row) {
    text += fmt::format("{:06} ", row);
    for (std::size_t t = 0; t < threads.size(); ++t) {
      text += fmt::format("{}{:06}", t == 0 ? "" : "\t", threads[t].count[row]);
    }
    text += '\n';
  }
  const auto line = [&text, &threads](const char* title, auto&& value, int width) {
    text += fmt::format("# {}:", title);
    for (const MicrosecondHistogram& thread : threads) text += fmt::format(" {:0{}}", value(thread), width);
    text += '\n';
  };
  line(
      "Total", [](const auto& thread) { return thread.cycles - thread.overflows; }, 9);
  line(
      "Min Latencies", [](const auto& thread) { return thread.min_us; }, 5);
  line(
      "Avg Latencies", [](const auto& thread) { return std::lround(std::floor(mean_us(thread))); }, 5);
  line(
      "Max Latencies", [](const auto& thread) { return thread.max_us; }, 5);
  line(
      "Histogram Overflows", [](const auto& thread) { return thread.overflows; }, 5);
  text += "# Histogram Overflow at cycle number:\n";
  for (std::size_t t = 0; t < threads.size(); ++t) {
    text += fmt::format("# Thread {}:", t);
    const std::uint64_t kept = std::min<std::uint64_t>(threads[t].overflows, kCyclictestOverflowsKept);
    for (std::uint64_t k = 0; k < kept; ++k) text += fmt::format(" {:05}", threads[t].overflow_cycle[k]);
    if (threads[t].overflows > kept) text += fmt::format(" # {:05} others", threads[t].overflows - kept);
    text += '\n';
  }
  return text + '\n';
}

std::string cyclictest_json(const std::vector<MicrosecondHistogram>& threads, const CyclictestRun& run) {
  using Json = nlohmann::ordered_json;
  Json root;
  root["file_version"] = 1;
  root[kCommandLineKey] = run.command_line;
  root[kVersionKey] = "2.40";
  root["start_time"] = run.start_time;
  root["end_time"] = run.end_time;
  root["return_code"] = 0;
  root["sysinfo"] = {{"sysname", run.sysname}, {"nodename", run.nodename}, {"release", run.release},
                     {"version", run.version}, {"machine", run.machine},   {"realtime", run.realtime_kernel ? 1 : 0}};
  root["num_threads"] = threads.size();
  root["resolution_in_ns"] = 0;  // cyclictest's flag "values are in ns": no
  Json& all = root["thread"] = Json::object();
  for (std::size_t t = 0; t < threads.size(); ++t) {
    const MicrosecondHistogram& thread = threads[t];
    Json bins = Json::object();
    for (std::int32_t us = 0; us < kCyclictestBins; ++us) {
      if (thread.count[us] > 0) bins[std::to_string(us)] = thread.count[us];
    }
    all[std::to_string(t)] = {{"histogram", bins},
                              {"cycles", thread.cycles},
                              {"min", thread.min_us},
                              {"max", thread.max_us},
                              {"avg", std::round(mean_us(thread) * 100.0) / 100.0},
                              {"cpu", run.cpu},
                              {"node", run.node}};
  }
  return root.dump(2) + '\n';
}

}  // namespace palpate
