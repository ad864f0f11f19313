#include "sim_host/latency/worst_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "sim_host/status_text.h"

namespace palpate {

namespace {

double us(std::int64_t ns) { return 1e-3 * static_cast<double>(ns); }

std::string longest_stage(const TickTiming& timing) {
  const auto longest = std::max_element(std::begin(timing.stage_ns), std::end(timing.stage_ns));
  const auto index = longest - std::begin(timing.stage_ns);
  return fmt::format("{} {:.1f}", stage_name(static_cast<Stage>(index)), us(*longest));
}

}  // namespace

std::string worst_ticks_text(const WorstTicks& worst, int number) {
  const int rows = std::min(number, static_cast<int>(worst.count));
  if (rows <= 0) return {};
  std::string text = fmt::format("worst   {:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>8}  {}\n", "tick", "whole",
                                 "wake-up", "receive", "compute", "transmit", "publish", "missed", "longest stage");
  for (int i = 0; i < rows; ++i) {
    const TickRecord& record = worst.record[i];
    const TickTiming& t = record.timing;
    fmt::format_to(std::back_inserter(text),
                   "        {:>10}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>8}  {}\n", record.tick,
                   us(busy_ns(t)), us(t.wake_latency_ns), us(t.receive_ns), us(t.compute_ns), us(t.transmit_ns),
                   us(t.publish_ns), record.input.overrun_ticks, longest_stage(t));
  }
  return text;
}

}  // namespace palpate
