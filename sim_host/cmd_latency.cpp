// `palpate latency`: how late this machine wakes up, or where the time of a recorded run went.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <ctime>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "sim_host/cli.h"
#include "sim_host/latency.h"
#include "sim_host/recording.h"

namespace palpate {

namespace {

struct LatencyOptions {
  std::string recording, histfile, json, plot;
  MeasureOptions measure;
  double limit_us = 0;
};

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot write");
  fmt::print("wrote   {}\n", path);
}

std::string command_line(const LatencyOptions& options) {
  if (!options.recording.empty()) return "palpate latency --recording " + options.recording;
  return fmt::format("palpate latency --duration {:g} --cpu {} --priority {}", options.measure.duration_s,
                     options.measure.cpu, options.measure.priority);
}

int run_latency(const LatencyOptions& options) {
  CyclictestRun run = this_system();
  run.command_line = command_line(options);
  run.cpu = options.measure.cpu >= 0 ? options.measure.cpu : 0;
  run.start_time = rfc2822_time(std::time(nullptr));
  const bool recorded = !options.recording.empty();
  std::string verdicts;
  const auto data = std::make_unique<LatencyData>(recorded ? latency_of_recording(options.recording)
                                                           : measure_wake_up(options.measure, verdicts));
  run.end_time = rfc2822_time(std::time(nullptr));
  fmt::print("{}{}", verdicts, latency_text(*data));
  const std::vector<MicrosecondHistogram> threads{data->wake};
  if (!options.histfile.empty()) write_text(options.histfile, cyclictest_text(threads));
  if (!options.json.empty()) write_text(options.json, cyclictest_json(threads, run));
  if (!options.plot.empty()) {
    const std::string machine =
        fmt::format("{} {}{}", run.sysname, run.release, run.realtime_kernel ? " PREEMPT_RT" : "");
    latency_drawing(*data, fmt::format("{} ticks, {}", data->summary.ticks, machine)).save(options.plot);
    fmt::print("wrote   {}\n", options.plot);
  }
  if (options.limit_us > 0 && static_cast<double>(data->summary.wake.max_ns) > 1e3 * options.limit_us) {
    fmt::print("above the limit: latest wake-up {:.1f} µs, allowed {:g} µs\n",
               1e-3 * static_cast<double>(data->summary.wake.max_ns), options.limit_us);
    return kExitFailed;
  }
  return data->damage.empty() ? kExitOk : kExitFailed;
}

}  // namespace

void add_latency_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<LatencyOptions>();
  CLI::App* command =
      app.add_subcommand("latency", "Measure wake-up latency, or show where a recorded run's time went");
  auto* recording = command->add_option("--recording", options->recording, "recording of `palpate run`");
  command->add_option("--duration", options->measure.duration_s, "seconds to measure")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 604800.0))
      ->excludes(recording);
  command->add_option("--cpu", options->measure.cpu, "CPU to measure on; -1: any")
      ->capture_default_str()
      ->check(CLI::Range(-1, 1023))
      ->excludes(recording);
  command->add_option("--priority", options->measure.priority, "SCHED_FIFO priority; 0: none")
      ->capture_default_str()
      ->check(CLI::Range(0, 98))
      ->excludes(recording);
  command->add_option("--histfile", options->histfile, "write cyclictest's histogram text to this file");
  command->add_option("--json", options->json, "write cyclictest's JSON to this file");
  command->add_option("--plot", options->plot, "draw the histograms to this .svg or .png file");
  command->add_option("--limit", options->limit_us, "exit with 1 when the latest wake-up exceeds this many µs")
      ->check(CLI::PositiveNumber);
  command->footer(
      "Without --recording it sleeps to 1 kHz deadlines as the controller does, and measures how late it wakes.\n"
      "Examples:\n"
      "  palpate latency --duration 60 --cpu 3 --priority 80 --json latency.json --plot latency.svg\n"
      "  palpate latency --recording run.plr --histfile run.hist --plot run_latency.png");
  command->callback([options, &exit_code] {
    try {
      exit_code = run_latency(*options);
    } catch (const RecordingError& error) {
      const std::string what = error.what();
      throw std::runtime_error(what.starts_with(options->recording) ? what : options->recording + ": " + what);
    }
  });
}

}  // namespace palpate
