// What a run amounted to, as JSON (docs/json.md): parts that several commands tell.
#pragma once

#include <vector>

#include "sim_host/json_output.h"
#include "sim_host/run/run_summary.h"
#include "sim_host/run/verdict.h"
#include "sim_host/status_text.h"

namespace palpate {

// Of each part of a tick: p50, p99.9 and the largest, us.
Json stages_json(const RunSummary& summary);
Json worst_json(const WorstTicks& worst);
Json verdicts_json(const std::vector<RunVerdict>& verdicts);
// One bit of rt_core/status.h: name, meaning and remedy.
Json bit_json(const BitText& bit);
Json faults_json(std::uint32_t fault);
// Ticks, rate, extremes, status bits seen and faults; times only where they were measured.
Json summary_json(const RunSummary& summary, std::uint64_t lost_records);

}  // namespace palpate
