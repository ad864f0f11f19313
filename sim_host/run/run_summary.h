// What a run amounted to: rate, missed ticks, time distributions, extremes of force, status bits seen.
#pragma once

#include <cstdint>
#include <string>

#include "rt_core/record.h"
#include "sim_host/latency/histogram.h"
#include "sim_host/latency/worst_ticks.h"

namespace palpate {

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
  Mode last_mode = Mode::kIdle;
};

void add(RunSummary& summary, const TickRecord& record);
// Whether it ran in virtual time, in which no tick takes any: a real one takes a microsecond or more.
bool is_virtual(const RunSummary& summary);
// Ticks per second over the whole run; 0 for fewer than two ticks.
double rate_Hz(const RunSummary& summary);
// The report printed at the end of a run, several lines; `worst` of the worst ticks are listed with their parts.
std::string summary_text(const RunSummary& summary, std::uint64_t lost_records, int worst = 0);

}  // namespace palpate
