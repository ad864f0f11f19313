#include "sim_host/run/verdict.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <charconv>
#include <iterator>

#include "sim_host/exit_codes.h"

namespace palpate {

namespace {

double share(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

double& limit_named(VerdictLimits& limits, const std::string& name) {
  if (name == "armed") return limits.armed;
  if (name == "stale") return limits.stale;
  if (name == "unconverged") return limits.unconverged;
  if (name == "clamped") return limits.clamped;
  if (name == "work") return limits.work;
  return limits.lost;
}

// "stale=5" into limits; what is wrong, or "".
std::string take_limit(const std::string& text, VerdictLimits& limits, const std::vector<std::string>& names) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  double percent = -1;
  if (equals != std::string::npos) {
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + equals + 1, end, percent);
    if (error != std::errc{} || stop != end) percent = -1;
  }
  if (std::ranges::find(names, name) == names.end() || !(percent >= 0 && percent <= 100)) {
    return fmt::format("'{}': expected NAME=PERCENT, NAME one of {}, PERCENT 0 to 100", text, fmt::join(names, ", "));
  }
  limit_named(limits, name) = 0.01 * percent;
  return "";
}

}  // namespace

RunVerdict judge_unconverged(std::uint64_t unconverged, std::uint64_t ticks, const VerdictLimits& limits) {
  return {"unconverged", share(unconverged, ticks), limits.unconverged, false,
          "of ticks ended a solve above its tolerance"};
}

std::vector<RunVerdict> judge(const RunSummary& summary, const RunFacts& facts, const VerdictLimits& limits) {
  std::vector<RunVerdict> verdicts;
  if (facts.wants_force && !(facts.interrupted && summary.armed_ticks == 0)) {
    verdicts.push_back({"armed", share(summary.armed_ticks, summary.armed_ticks + summary.paused_ticks), limits.armed,
                        true, summary.armed_ticks == 0 ? "of ticks: it never armed" : "of ticks rendered force"});
  }
  verdicts.push_back({"stale", share(summary.armed_stale_ticks, summary.armed_ticks), limits.stale, false,
                      "of rendered ticks had no fresh sample"});
  verdicts.push_back(
      judge_unconverged(summary.status_ticks[std::countr_zero(Status::kNotConverged)], summary.ticks, limits));
  verdicts.push_back({"clamped", share(summary.armed_clamped_ticks, summary.armed_ticks), limits.clamped, false,
                      "of rendered ticks were cut to the device's limit"});
  verdicts.push_back(
      {"lost", share(facts.lost, summary.ticks + facts.lost), limits.lost, false, "of ticks are not in the recording"});
  verdicts.push_back({"work", share(summary.status_ticks[std::countr_zero(Status::kWorkBeyondStated)], summary.ticks),
                      limits.work, false, "of ticks did more work than the image states"});
  return verdicts;
}

bool all_ok(const std::vector<RunVerdict>& verdicts) {
  return std::ranges::all_of(verdicts, [](const RunVerdict& verdict) { return verdict.ok(); });
}

int exit_code_of(const RunResult& result, const std::vector<RunVerdict>& verdicts) {
  const int controller = result.controller_exit;
  if (controller < 0 || controller >= 128) return kExitDied;
  if (controller != kExitOk) return controller;
  if (result.faulted()) return kExitFault;
  if (result.device_died) return kExitDied;
  if (!result.recorder_error.empty()) return kExitNotRecorded;
  return all_ok(verdicts) ? kExitOk : kExitFailed;
}

std::string verdict_text(const std::vector<RunVerdict>& verdicts) {
  std::string text;
  for (const RunVerdict& verdict : verdicts) {
    fmt::format_to(std::back_inserter(text), "verdict {:<4} {:<11} {:5.1f} % {}; {} {:g} %\n",
                   verdict.ok() ? "ok" : "FAIL", verdict.name, 100 * verdict.share, verdict.meaning,
                   verdict.at_least ? "at least" : "at most", 100 * verdict.limit);
  }
  return text;
}

void add_allow_option(CLI::App& command, VerdictLimits& limits, const std::vector<std::string>& names) {
  command
      .add_option_function<std::vector<std::string>>(
          "--allow",
          [&limits, names](const std::vector<std::string>& texts) {
            for (const std::string& text : texts)
              if (const std::string wrong = take_limit(text, limits, names); !wrong.empty())
                throw CLI::ValidationError("--allow", wrong);
          },
          "another limit of a verdict, as " + names.front() + "=5 (percent); repeatable. Verdicts: docs/exit_codes.md")
      ->allow_extra_args(false);
}

}  // namespace palpate
