// Where the time of a tick goes: from a recording of a run, or measured on this machine with a bare 1 kHz loop.
#pragma once

#include <cstdint>
#include <string>

#include "sim_host/latency/cyclictest_format.h"
#include "sim_host/run/run_summary.h"
#include "sim_host/view/plot.h"

namespace palpate {

struct LatencyData {
  std::int64_t period_ns = 1'000'000;
  RunSummary summary;         // of a bare loop only `ticks`, `missed_ticks` and `wake` are filled
  MicrosecondHistogram wake;  // for the cyclictest formats
  bool bare_loop = false;
  std::string damage;  // not empty: the recording is incomplete or damaged, and how
};

void add(LatencyData& data, const TickRecord& record);
// Reads a recording. Throws RecordingError when it cannot be read at all.
LatencyData latency_of_recording(const std::string& path);

struct MeasureOptions {
  double duration_s = 10;
  std::int64_t period_ns = 1'000'000;
  int cpu = -1;
  int priority = 80;
};
// Sleeps to absolute deadlines in a thread set up as the controller's, and measures how late it wakes. `verdicts`
// receives one line per real-time measure. SIGINT ends it early.
LatencyData measure_wake_up(const MeasureOptions& options, std::string& verdicts);

// Table per stage (median, 99.9 %, maximum and its tick), `worst` of the worst ticks with their parts, then a verdict
// in plain words with what to do.
std::string latency_text(const LatencyData& data, int worst = 0);
// `overlay`: other wake-up histograms drawn with ours (cyclictest on the same machine).
Drawing latency_drawing(const LatencyData& data, const std::string& title, std::span<const LatencySeries> overlay = {});

}  // namespace palpate
