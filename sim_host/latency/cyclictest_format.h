// Latency histograms in the two formats of cyclictest (rt-tests 2.4): its text file (--histfile) and its JSON
// (--json), so that scripts made for cyclictest read ours. Bins are whole microseconds, as there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rt_core/base.h"

namespace palpate {

inline constexpr std::int32_t kCyclictestBins = 2000;         // one per microsecond
inline constexpr std::int32_t kCyclictestOverflowsKept = 64;  // cycle numbers of the first overflows

// What one cyclictest thread keeps. Plain data; `add` may run in the real-time loop.
struct MicrosecondHistogram {
  std::uint32_t count[kCyclictestBins] = {};
  std::uint64_t cycles = 0, overflows = 0;
  std::uint64_t overflow_cycle[kCyclictestOverflowsKept] = {};
  std::int64_t min_us = 0, max_us = 0, sum_us = 0;
};

inline void add(MicrosecondHistogram& histogram, std::int64_t value_ns) PALPATE_RT {
  const std::int64_t us = value_ns > 0 ? value_ns / 1000 : 0;
  if (us < kCyclictestBins) {
    histogram.count[us] += 1;
  } else {
    if (histogram.overflows < kCyclictestOverflowsKept)
      histogram.overflow_cycle[histogram.overflows] = histogram.cycles;
    histogram.overflows += 1;
  }
  if (histogram.cycles == 0 || us < histogram.min_us) histogram.min_us = us;
  if (histogram.cycles == 0 || us > histogram.max_us) histogram.max_us = us;
  histogram.sum_us += us;
  histogram.cycles += 1;
}

// Facts about the machine and run that the JSON carries; filled by `this_system`.
struct CyclictestRun {
  std::string command_line, start_time, end_time;  // times as "Sat, 21 Nov 2026 04:01:45 +0000"
  std::string sysname, nodename, release, version, machine;
  bool realtime_kernel = false;
  std::int32_t cpu = 0, node = 0;
};
// Names this machine (uname, /sys/kernel/realtime).
CyclictestRun this_system();
// A time in the format above, UTC.
std::string rfc2822_time(std::int64_t seconds_since_1970);

// Text as `cyclictest -h 2000 --histfile` writes it: a row per microsecond, a column per thread, then the totals.
std::string cyclictest_text(const std::vector<MicrosecondHistogram>& threads);
// JSON as `cyclictest --json` writes it.
std::string cyclictest_json(const std::vector<MicrosecondHistogram>& threads, const CyclictestRun& run);

}  // namespace palpate
