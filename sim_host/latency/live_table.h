// The table of tick times that `palpate run --live` and `palpate latency --live` refresh while a controller runs.
#pragma once

#include <string>

#include "sim_host/run/run_summary.h"

namespace palpate {

struct LiveState {
  const RunSummary* all = nullptr;     // since the start
  const RunSummary* recent = nullptr;  // since the last refresh, about a second
  double elapsed_s = 0;
  double duration_s = 0;  // 0: unknown
};

// Several lines: ticks and misses, then a row per part of the tick with the last second's median and maximum beside the
// whole run's median, 99.9 %, maximum and its tick (µs).
std::string live_text(const LiveState& state);

// Prints each text over the one before on a terminal, one after the other elsewhere (a log file).
class LivePrinter {
 public:
  LivePrinter();
  void print(const std::string& text);

 private:
  bool terminal_;
  int lines_ = 0;  // of the text on the screen
};

// "1h 02m 03s", "2m 05s", "7s".
std::string duration_text(double seconds);

}  // namespace palpate
