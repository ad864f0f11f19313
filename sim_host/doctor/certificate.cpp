// The two forms of a certification's result: for people and for programs.
#include <fmt/format.h>

#include <iterator>

#include "sim_host/build_id.h"
#include "sim_host/doctor/certify.h"
#include "sim_host/doctor/doctor_json.h"
#include "sim_host/latency/cyclictest_format.h"
#include "sim_host/run/run_json.h"
#include "sim_host/status_text.h"

namespace palpate {

namespace {

const char* verdict_name(CertifyVerdict verdict) {
  if (verdict == CertifyVerdict::kPass) return "PASS";
  return verdict == CertifyVerdict::kFail ? "FAIL" : "INCOMPLETE";
}

double us(std::int64_t ns) { return 1e-3 * static_cast<double>(ns); }

Json machine_json(const MachineIdentity& m) {
  return {{"host", m.host},
          {"cpu_model", m.cpu_model},
          {"cpus", m.cpus},
          {"microcode", m.microcode},
          {"kernel", m.kernel},
          {"kernel_version", m.kernel_version},
          {"preempt_rt", m.realtime_kernel},
          {"isolated_cpus", m.isolated_cpus},
          {"governor", m.governor},
          {"boot_options", m.boot_options},
          {"checks", items_json(m.checks)}};
}

const char* load_name(const CertifyOptions& options) { return options.host_load ? "host" : "none"; }
std::string scene_name(const CertifyOptions& options) { return options.scene.empty() ? "built in" : options.scene; }

void stage_row(std::string& text, const std::string& name, const Histogram& h) {
  fmt::format_to(std::back_inserter(text), "  {:<16}{:>10.1f}{:>10.1f}{:>10.1f}{:>14}\n", name,
                 us(percentile_ns(h, 0.5)), us(percentile_ns(h, 0.999)), us(h.max_ns), h.cycle_of_max);
}

std::string machine_text(const MachineIdentity& m) {
  std::string text = fmt::format(
      "Machine   {}: {}, {} CPUs{}\nKernel    {} {}\n          PREEMPT_RT {}, isolated CPUs {}, governor {}\n"
      "Boot      {}\n",
      m.host, m.cpu_model, m.cpus, m.microcode.empty() ? "" : ", microcode " + m.microcode, m.kernel, m.kernel_version,
      m.realtime_kernel ? "yes" : "no", m.isolated_cpus.empty() ? "none" : m.isolated_cpus,
      m.governor.empty() ? "unknown" : m.governor, m.boot_options);
  const std::string failing = failing_items(m.checks);
  return text + "Checks    " + (failing.empty() ? "none fails" : "failing: " + failing) + "\n";
}

}  // namespace

std::string certificate_text(const HostCertificate& c) {
  const RunSummary& s = c.run.summary;
  std::string text = fmt::format("Palpate latency certificate: {}\n", verdict_name(c.verdict));
  for (const std::string& reason : c.reasons) text += "  " + reason + "\n";
  if (c.verdict == CertifyVerdict::kIncomplete) text += "  ended early; what was measured is within the limits\n";
  text += fmt::format("Date      {} to {}\nProgram   {}\n", rfc2822_time(c.start_s), rfc2822_time(c.end_s), kBuildId);
  text += machine_text(c.machine);
  text +=
      fmt::format("Run       {:.0f} s of {:.0f} s, scene {}, device {}, CPU {}, priority {}, load: {}, zero force\n",
                  c.run.elapsed_s, c.options.duration_s, scene_name(c.options), c.options.device,
                  c.options.cpu < 0 ? "any" : std::to_string(c.options.cpu), c.options.priority,
                  c.options.host_load ? "host (memory copies, system calls, files)" : "none made here");
  text += fmt::format(
      "Limits    no deadline missed, whole tick at most {:.0f} us{}, no fault, no tick unmeasured\n",
      c.options.limits.busy_share * us(c.period_ns),
      c.options.limits.wake_us > 0 ? fmt::format(", wake-up at most {:g} us", c.options.limits.wake_us) : "");
  text += fmt::format("Ticks     {} at {:.3f} Hz, {} missed, {} without a fresh sample, {} not measured\n\n", s.ticks,
                      rate_Hz(s), s.missed_ticks, s.stale_ticks, c.run.lost);
  text += fmt::format("  {:<16}{:>10}{:>10}{:>10}{:>14}\n", "(us)", "p50", "p99.9", "max", "tick of max");
  stage_row(text, "wake-up latency", s.wake);
  stage_row(text, "receive", s.receive);
  stage_row(text, "compute", s.compute);
  for (int i = 0; i < kStageCount; ++i) {
    stage_row(text, fmt::format("  {}", stage_name(static_cast<Stage>(i))), s.stage[i]);
  }
  stage_row(text, "transmit", s.transmit);
  stage_row(text, "deadline to sent", s.sent);
  stage_row(text, "publish", s.publish);
  stage_row(text, "whole tick", s.busy);
  return text + "\n" + worst_ticks_text(s.worst, kWorstTicksKept);
}

std::string certificate_json(const HostCertificate& c) {
  const RunSummary& s = c.run.summary;
  Json root;
  root["file"] = "palpate latency certificate";
  root["version"] = 1;
  root["verdict"] = verdict_name(c.verdict);
  root["reasons"] = c.reasons;
  root["start"] = rfc2822_time(c.start_s);
  root["end"] = rfc2822_time(c.end_s);
  root["program"] = kBuildId;
  root["machine"] = machine_json(c.machine);
  root["run"] = {
      {"duration_asked_s", c.options.duration_s}, {"duration_s", c.run.elapsed_s}, {"interrupted", c.run.interrupted},
      {"scene", scene_name(c.options)},           {"device", c.options.device},    {"cpu", c.options.cpu},
      {"priority", c.options.priority},           {"load", load_name(c.options)},  {"period_us", us(c.period_ns)}};
  root["limits"] = {{"missed", 0},
                    {"whole_tick_us", c.options.limits.busy_share * us(c.period_ns)},
                    {"wake_up_us", c.options.limits.wake_us > 0 ? Json(c.options.limits.wake_us) : Json(nullptr)},
                    {"faults", 0},
                    {"not_measured", 0}};
  root["ticks"] = {{"count", s.ticks},           {"rate_Hz", rate_Hz(s)},
                   {"missed", s.missed_ticks},   {"without_fresh_sample", s.stale_ticks},
                   {"not_measured", c.run.lost}, {"fault", s.fault == 0 ? "" : bit_names(fault_bit_texts(), s.fault)}};
  root["stages"] = stages_json(s);
  root["worst_ticks"] = worst_json(s.worst);
  return root.dump(2) + '\n';
}

}  // namespace palpate
