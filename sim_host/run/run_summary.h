// What a run amounted to: rate, missed ticks, time distributions, extremes of force, status bits seen.
#pragma once

#include <cstdint>
#include <string>

#include "rt_core/record.h"
#include "sim_host/latency/histogram.h"
#include "sim_host/latency/worst_ticks.h"

namespace palpate {

// What came of the device while force was rendered, over so many ticks.
struct Samples {
  static constexpr std::uint64_t kTicks = 256;  // about as many as Fault::kSamplesSparse looks back
  std::uint64_t ticks = 0, stale = 0;
  double gain = 0;  // of the force, summed
};

struct RunSummary {
  std::uint64_t ticks = 0;
  std::int64_t first_deadline_ns = 0, last_deadline_ns = 0;
  std::uint64_t missed_ticks = 0;  // deadlines that passed without a tick
  std::uint64_t stale_ticks = 0;   // ticks without a fresh device sample
  Histogram wake, receive, compute, transmit, publish;
  Histogram sent;  // from the planned wake-up until the command was handed to the bus
  Histogram stage[kStageCount];
  Histogram busy;  // wake-up latency plus all work of a tick: what must stay below the period
  WorstTicks worst;
  double device_force_max_N = 0, contact_force_max_N = 0, penetration_max_m = 0;
  std::int32_t regions_max = 0;
  HighWater high_water;
  std::uint64_t status_ticks[32] = {};  // ticks during which each status bit was set
  std::uint32_t fault = 0;              // every fault bit seen
  // While it rendered force, from arming on; pauses are ticks at rest and slots missed in between, but for the end.
  std::uint64_t armed_ticks = 0, paused_ticks = 0;
  std::uint64_t armed_stale_ticks = 0, armed_clamped_ticks = 0;
  Samples lately, before;  // of these two only `before` is whole
  // How this machine kept up. A gap is time without a tick where there should have been some.
  std::uint32_t stalls = 0;    // ridden through (Command::kStall)
  std::int64_t gap_ns = 0;     // before the last tick
  std::uint32_t late_run = 0;  // gaps in a row, up to the last tick
  std::int64_t longest_gap_ns = 0;
  std::uint64_t longest_gap_tick = 0;  // the tick after it
  // At the tick that latched the first fault.
  std::uint64_t fault_tick = 0;
  std::int64_t fault_gap_ns = 0;
  std::uint32_t fault_late_run = 0;
  Samples fault_samples;
  std::uint32_t last_commands = 0;
  std::int64_t period_ns = 0;  // smallest step between deadlines
  Mode last_mode = Mode::kIdle;
};

void add(RunSummary& summary, const TickRecord& record);
// Whether it ran in virtual time, in which no tick takes any: a real one takes a microsecond or more.
bool is_virtual(const RunSummary& summary);
// Of a run that Fault::kSamplesSparse ended: what the device sent, and how much of the force was felt.
double samples_Hz(const RunSummary& summary);
double felt_share(const RunSummary& summary);
// Ticks per second over the whole run; 0 for fewer than two ticks.
double rate_Hz(const RunSummary& summary);
// The report printed at the end of a run, several lines; `worst` of the worst ticks are listed with their parts.
std::string summary_text(const RunSummary& summary, std::uint64_t lost_records, int worst = 0);

}  // namespace palpate
