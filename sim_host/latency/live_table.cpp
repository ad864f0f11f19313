#include "sim_host/latency/live_table.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "sim_host/status_text.h"

namespace palpate {

namespace {

void row(std::string& text, const char* name, const Histogram& recent, const Histogram& all) {
  const auto us = [](std::int64_t ns) { return 1e-3 * static_cast<double>(ns); };
  fmt::format_to(std::back_inserter(text), "  {:<16}{:>10.1f}{:>10.1f}   {:>10.1f}{:>10.1f}{:>10.1f}{:>12}\n", name,
                 us(percentile_ns(recent, 0.5)), us(recent.max_ns), us(percentile_ns(all, 0.5)),
                 us(percentile_ns(all, 0.999)), us(all.max_ns), all.cycle_of_max);
}

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(std::max(0.0, seconds)));
  if (whole >= 3600) return fmt::format("{}h {:02}m {:02}s", whole / 3600, whole / 60 % 60, whole % 60);
  return whole >= 60 ? fmt::format("{}m {:02}s", whole / 60, whole % 60) : fmt::format("{}s", whole);
}

std::string live_text(const LiveState& state) {
  const RunSummary &all = *state.all, &recent = *state.recent;
  const std::string left =
      state.duration_s > 0 ? ", " + duration_text(state.duration_s - state.elapsed_s) + " left" : "";
  std::string text =
      fmt::format("{} ticks in {}{}; {} missed, {} without a fresh sample, mode {}{}\n", all.ticks,
                  duration_text(state.elapsed_s), left, all.missed_ticks, all.stale_ticks, mode_name(all.last_mode),
                  all.fault != 0 ? ", FAULT " + bit_names(fault_bit_texts(), all.fault) : "");
  text += fmt::format("  {:<16}{:>20}   {:>42}\n  {:<16}{:>10}{:>10}   {:>10}{:>10}{:>10}{:>12}\n", "", "last second",
                      "since the start", "(us)", "p50", "max", "p50", "p99.9", "max", "at tick");
  row(text, "wake-up latency", recent.wake, all.wake);
  row(text, "receive", recent.receive, all.receive);
  row(text, "compute", recent.compute, all.compute);
  for (int i = 0; i < kStageCount; ++i) {
    const std::string name = fmt::format("  {}", stage_name(static_cast<Stage>(i)));
    row(text, name.c_str(), recent.stage[i], all.stage[i]);
  }
  row(text, "transmit", recent.transmit, all.transmit);
  row(text, "deadline to sent", recent.sent, all.sent);
  row(text, "telemetry", recent.publish, all.publish);
  row(text, "whole tick", recent.busy, all.busy);
  return text;
}

LivePrinter::LivePrinter() : terminal_(isatty(STDOUT_FILENO) != 0) {}

void LivePrinter::print(const std::string& text) {
  if (terminal_ && lines_ > 0) fmt::print("\x1b[{}A\x1b[J", lines_);
  fmt::print("{}", text);
  std::fflush(stdout);
  lines_ = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace palpate
