#include "sim_host/run/run_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "sim_host/status_text.h"

namespace palpate {

namespace {

void time_row(std::string& text, const char* name, const Histogram& times) {
  if (times.total == 0) return;
  const auto us = [](std::int64_t ns) { return 1e-3 * static_cast<double>(ns); };
  fmt::format_to(std::back_inserter(text), "  {:<16}{:>10.1f}{:>10.1f}{:>10.1f}   tick {}\n", name,
                 us(percentile_ns(times, 0.5)), us(percentile_ns(times, 0.999)), us(times.max_ns), times.cycle_of_max);
}

void times_table(std::string& text, const RunSummary& summary) {
  fmt::format_to(std::back_inserter(text), "times   {:<16}{:>10}{:>10}{:>10}   (us)\n", "", "p50", "p99.9", "max");
  time_row(text, "wake-up latency", summary.wake);
  time_row(text, "receive", summary.receive);
  time_row(text, "compute", summary.compute);
  for (int i = 0; i < kStageCount; ++i) {
    time_row(text, fmt::format("  {}", stage_name(static_cast<Stage>(i))).c_str(), summary.stage[i]);
  }
  time_row(text, "transmit", summary.transmit);
  time_row(text, "deadline to sent", summary.sent);
  time_row(text, "telemetry", summary.publish);
  time_row(text, "whole tick", summary.busy);
}

// What the machine did where a fault is its doing; numbers say more than the fault's general text.
std::string fault_detail(const RunSummary& summary, std::uint32_t fault) {
  const double typical_us = 1e-3 * static_cast<double>(percentile_ns(summary.compute, 0.5));
  const double slow_us = 1e-3 * static_cast<double>(percentile_ns(summary.compute, 0.999));
  const std::string own =
      fmt::format("Palpate's own work took {:.1f} us a tick, {:.1f} us in one of 1000", typical_us, slow_us);
  if (fault == Fault::kStalled) {
    return fmt::format("        this machine stood still {:.1f} ms before tick {}; {}\n",
                       1e-6 * static_cast<double>(summary.fault_gap_ns), summary.fault_tick, own);
  }
  if (fault == Fault::kOverrun) {
    return fmt::format("        {} ticks in a row came late, up to tick {}; {}\n", summary.fault_late_run,
                       summary.fault_tick, own);
  }
  if (fault == Fault::kSamplesSparse) {
    return fmt::format("        you felt {:.0f} % of the force; the device sends {:.0f} samples a second\n",
                       100 * felt_share(summary), samples_Hz(summary));
  }
  return "";
}

void machine_row(std::string& text, const RunSummary& summary) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "machine ");
  if (summary.missed_ticks == 0) {
    fmt::format_to(out, "kept up: no tick missed");
  } else {
    fmt::format_to(out, "missed {} ticks, at most {:.1f} ms at one go, before tick {}", summary.missed_ticks,
                   1e-6 * static_cast<double>(summary.longest_gap_ns), summary.longest_gap_tick);
  }
  if (summary.stalls > 0) {
    fmt::format_to(out, "; {} stalls so long that the force ramped out and in again", summary.stalls);
  }
  fmt::format_to(out, "; Palpate computes {:.1f} us a tick, {:.1f} us in one of 1000\n",
                 1e-3 * static_cast<double>(percentile_ns(summary.compute, 0.5)),
                 1e-3 * static_cast<double>(percentile_ns(summary.compute, 0.999)));
}

void bit_rows(std::string& text, const RunSummary& summary) {
  for (const BitText& bit : status_bit_texts()) {
    const std::uint64_t ticks = summary.status_ticks[bit.bit];
    if (ticks == 0) continue;
    fmt::format_to(std::back_inserter(text), "status  {} in {} ticks: {}\n        remedy: {}\n", bit.name, ticks,
                   bit.meaning, bit.remedy);
  }
  for (const BitText& bit : fault_bit_texts()) {
    if ((summary.fault >> bit.bit & 1u) == 0) continue;
    fmt::format_to(std::back_inserter(text), "FAULT   {}: {}\n        remedy: {}\n", bit.name, bit.meaning, bit.remedy);
    text += fault_detail(summary, 1u << bit.bit);
  }
}

// Deadlines lie on one grid, so a step longer than the period is slots without a tick. Input::overrun_ticks says the
// same, but is cut where a stall is ridden through.
void add_gap(RunSummary& summary, const TickRecord& record) {
  const std::int64_t step_ns = record.timing.deadline_ns - summary.last_deadline_ns;
  const bool follows = summary.ticks > 0 && step_ns > 0;
  if (follows && (summary.period_ns == 0 || step_ns < summary.period_ns)) summary.period_ns = step_ns;
  const bool gap = record.input.overrun_ticks > 0 && follows;
  summary.gap_ns = gap ? step_ns - summary.period_ns : 0;
  summary.late_run = gap ? summary.late_run + 1 : 0;
  if (summary.gap_ns > summary.longest_gap_ns) {
    summary.longest_gap_ns = summary.gap_ns;
    summary.longest_gap_tick = record.tick;
  }
  const std::uint32_t commands = record.input.commands;
  summary.stalls += (commands & Command::kStall) != 0 && (summary.last_commands & Command::kStall) == 0 ? 1 : 0;
  summary.last_commands = commands;
  const auto slots = gap ? static_cast<std::uint64_t>(summary.gap_ns / summary.period_ns) : 0;
  summary.missed_ticks += std::max<std::uint64_t>(record.input.overrun_ticks, slots);
  if (summary.armed_ticks > 0) summary.paused_ticks += slots;
}

Samples together(const Samples& a, const Samples& b) { return {a.ticks + b.ticks, a.stale + b.stale, a.gain + b.gain}; }

void add_samples(RunSummary& summary, const TickRecord& record) {
  if (summary.lately.ticks == Samples::kTicks) {
    summary.before = summary.lately;
    summary.lately = {};
  }
  summary.lately = together(summary.lately, {1, record.input.stale_ticks > 0 ? 1u : 0u, record.output.ramp});
}

void add_felt(RunSummary& summary, const TickRecord& record) {
  const Output& output = record.output;
  const bool riding = (record.input.commands & Command::kStall) != 0;
  const bool ending = (record.input.commands & Command::kStop) != 0;
  if (riding || output.mode == Mode::kIdle || output.mode == Mode::kFault) {
    summary.paused_ticks += summary.armed_ticks > 0 && !ending ? 1 : 0;
    return;
  }
  summary.armed_ticks += 1;
  summary.armed_stale_ticks += record.input.stale_ticks > 0 ? 1 : 0;
  add_samples(summary, record);
  summary.armed_clamped_ticks += (output.status & Status::kForceClamped) != 0 ? 1 : 0;
}

}  // namespace

void add(RunSummary& summary, const TickRecord& record) {
  const TickTiming& timing = record.timing;
  add_gap(summary, record);
  add_felt(summary, record);
  if (summary.ticks == 0) summary.first_deadline_ns = timing.deadline_ns;
  summary.last_deadline_ns = timing.deadline_ns;
  summary.ticks += 1;
  summary.stale_ticks += record.input.stale_ticks > 0 ? 1 : 0;
  add(summary.wake, timing.wake_latency_ns, record.tick);
  add(summary.receive, timing.receive_ns, record.tick);
  add(summary.compute, timing.compute_ns, record.tick);
  add(summary.transmit, timing.transmit_ns, record.tick);
  add(summary.publish, timing.publish_ns, record.tick);
  add(summary.sent, timing.wake_latency_ns + timing.receive_ns + timing.compute_ns + timing.transmit_ns, record.tick);
  for (int i = 0; i < kStageCount; ++i) add(summary.stage[i], timing.stage_ns[i], record.tick);
  add(summary.busy, busy_ns(timing), record.tick);
  add(summary.worst, record);
  const Output& output = record.output;
  summary.device_force_max_N = std::max(summary.device_force_max_N, norm(output.device_w.force_N));
  summary.contact_force_max_N = std::max(summary.contact_force_max_N, norm(output.contact_w.force_N));
  summary.penetration_max_m = std::max(summary.penetration_max_m, output.penetration_m);
  summary.regions_max = std::max(summary.regions_max, output.regions);
  summary.high_water = record.high_water;
  for (int bit = 0; bit < 32; ++bit) summary.status_ticks[bit] += output.status >> bit & 1u;
  if (summary.fault == 0 && output.fault != 0) {
    summary.fault_tick = record.tick;
    summary.fault_gap_ns = summary.gap_ns;
    summary.fault_late_run = summary.late_run;
    summary.fault_samples = together(summary.before, summary.lately);
  }
  summary.fault |= output.fault;
  summary.last_mode = output.mode;
}

bool is_virtual(const RunSummary& summary) {
  return summary.ticks > 0 && summary.busy.max_ns == 0 && summary.publish.max_ns == 0;
}

double samples_Hz(const RunSummary& summary) {
  const Samples& s = summary.fault_samples;
  const double ticks_Hz = summary.period_ns > 0 ? 1e9 / static_cast<double>(summary.period_ns) : 0;
  return s.ticks > 0 ? ticks_Hz * static_cast<double>(s.ticks - s.stale) / static_cast<double>(s.ticks) : 0;
}

double felt_share(const RunSummary& summary) {
  const Samples& s = summary.fault_samples;
  return s.ticks > 0 ? s.gain / static_cast<double>(s.ticks) : 0;
}

double rate_Hz(const RunSummary& summary) {
  const std::int64_t span_ns = summary.last_deadline_ns - summary.first_deadline_ns;
  if (summary.ticks < 2 || span_ns <= 0) return 0;
  return static_cast<double>(summary.ticks - 1) / (1e-9 * static_cast<double>(span_ns));
}

std::string summary_text(const RunSummary& summary, std::uint64_t lost_records, int worst) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "ticks   {} at {:.2f} Hz, {} missed, {} without a fresh device sample, {} records lost\n",
                 summary.ticks, rate_Hz(summary), summary.missed_ticks, summary.stale_ticks, lost_records);
  if (is_virtual(summary)) {
    text += "times   none: in virtual time a tick takes no time; --device loopback measures them\n";
  } else {
    machine_row(text, summary);
    times_table(text, summary);
    text += worst_ticks_text(summary.worst, worst);
  }
  fmt::format_to(out, "force   {:.3f} N largest on the hand, {:.3f} N in contact, {:.3f} mm deepest\n",
                 summary.device_force_max_N, summary.contact_force_max_N, 1e3 * summary.penetration_max_m);
  fmt::format_to(out, "pools   {} contacts, {} regions, {} stack entries, {} support calls at most\n",
                 summary.high_water.contacts, summary.high_water.regions, summary.high_water.traversal_stack,
                 summary.high_water.gjk_support_calls);
  bit_rows(text, summary);
  return text;
}

}  // namespace palpate
