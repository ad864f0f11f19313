// `palpate latency`: how late this machine wakes up, where the time of a recorded run went, the same while it runs, and
// the long run that certifies a machine.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <thread>

#include "hal/system/duration.h"
#include "hal/system/rt_linux.h"
#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/doctor/certify.h"
#include "sim_host/latency/cyclictest_read.h"
#include "sim_host/latency/latency.h"
#include "sim_host/record/recording.h"
#include "sim_host/record/recording_follower.h"
#include "sim_host/run/run_json.h"

namespace palpate {

namespace {

struct LatencyOptions {
  JsonOption json;
  std::string recording, histfile, plot, overlay, live, certify, load = "none";
  MeasureOptions measure;
  CertifyOptions certificate;
  double limit_us = 0;
  int worst = 3;
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

void draw(const LatencyOptions& options, const LatencyData& data, const std::string& title) {
  CyclictestHistogram other;
  std::vector<LatencySeries> overlay;
  if (!options.overlay.empty()) {
    other = read_cyclictest(options.overlay);
    overlay.push_back(
        {other.threads == 1 ? "cyclictest" : fmt::format("cyclictest ({} threads)", other.threads), &other.latency});
  }
  latency_drawing(data, title, overlay).save(options.plot);
  fmt::print("wrote   {}\n", options.plot);
}

// Shows a run that another process records, until it ends or Ctrl-C.
int run_live(const std::string& path, Json& json) {
  constexpr std::chrono::milliseconds kRefresh{1000};
  constexpr int kMostQuiet = 5;  // refreshes without a tick: its recorder must have died
  const std::atomic<bool>& stop = install_stop_signals();
  RecordingFollower follower(path);
  const auto all = std::make_unique<RunSummary>(), recent = std::make_unique<RunSummary>();
  LivePrinter printer;
  for (int quiet = 0; !stop.load(std::memory_order_relaxed) && quiet < kMostQuiet;) {
    *recent = {};
    const std::uint64_t number = follower.read([&](const TickRecord& record) {
      add(*all, record);
      add(*recent, record);
    });
    quiet = number > 0 ? 0 : quiet + 1;
    const double elapsed_s = 1e-9 * static_cast<double>(all->last_deadline_ns - all->first_deadline_ns);
    printer.print(live_text({all.get(), recent.get(), elapsed_s, 0}));
    json["run"] = summary_json(*all, 0);
    if (follower.ended()) return kExitOk;
    std::this_thread::sleep_for(kRefresh);
  }
  if (stop.load()) return kExitOk;
  fmt::print(stderr, "palpate: {}: no new tick for {} s and no footer: the run was killed, or its disk is full\n", path,
             kMostQuiet);
  return kExitFailed;
}

// One line on a terminal, kept up to date; a line a minute in a log.
void print_certify_progress(const LiveState& state) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const auto whole_s = static_cast<long>(state.elapsed_s);
  const bool over = state.elapsed_s >= state.duration_s;
  if (!terminal && whole_s % 60 != 0 && !over) return;
  const auto us = [](std::int64_t ns) { return 1e-3 * static_cast<double>(ns); };
  fmt::print(stderr, "{}{:5.1f} %, {} left; {} ticks, {} missed; latest wake-up {:.1f} us, longest tick {:.1f} us{}",
             terminal ? "\r" : "", 100 * std::min(1.0, state.elapsed_s / state.duration_s),
             duration_text(state.duration_s - state.elapsed_s), state.all->ticks, state.all->missed_ticks,
             us(state.all->wake.max_ns), us(state.all->busy.max_ns), terminal ? "\x1b[K" : "\n");
  if (terminal && over) fmt::print(stderr, "\n");
}

int run_certify(const LatencyOptions& options, Json& json) {
  CertifyOptions certify_options = options.certificate;
  const std::optional<double> duration_s = parse_duration_s(options.certify);
  if (!duration_s) throw std::runtime_error("--certify: '" + options.certify + "' is no duration such as 1h, 10m, 30s");
  certify_options.duration_s = *duration_s;
  certify_options.cpu = options.measure.cpu;
  certify_options.priority = options.measure.priority;
  certify_options.host_load = options.load == "host";
  certify_options.limits.wake_us = options.limit_us;
  certify_options.progress = print_certify_progress;
  if (!certify_options.host_load) fmt::print(stderr, "no load is made here: start the load you expect now\n");
  const auto certificate = std::make_unique<HostCertificate>(certify(certify_options));
  const std::string text = certificate_text(*certificate);
  fmt::print("{}", text);
  write_text(certificate->options.out + ".txt", text);
  const std::string figures = certificate_json(*certificate);
  json.update(Json::parse(figures));
  write_text(certificate->options.out + ".json", figures);
  return certificate->verdict == CertifyVerdict::kPass ? kExitOk : kExitFailed;
}

int run_latency(const LatencyOptions& options, Json& json) {
  CyclictestRun run = this_system();
  run.command_line = command_line(options);
  run.cpu = options.measure.cpu >= 0 ? options.measure.cpu : 0;
  run.start_time = rfc2822_time(std::time(nullptr));
  const bool recorded = !options.recording.empty();
  std::string verdicts;
  const auto data = std::make_unique<LatencyData>(recorded ? latency_of_recording(options.recording)
                                                           : measure_wake_up(options.measure, verdicts));
  run.end_time = rfc2822_time(std::time(nullptr));
  json["bare_loop"] = data->bare_loop;
  json["wake_up"] = stages_json(data->summary)["wake_up"];
  json["damage"] = data->damage;
  if (!data->bare_loop) json["run"] = summary_json(data->summary, 0);
  fmt::print("{}{}", verdicts, latency_text(*data, options.worst));
  const std::vector<MicrosecondHistogram> threads{data->wake};
  if (!options.histfile.empty()) write_text(options.histfile, cyclictest_text(threads));
  if (!options.json.file.empty()) write_text(options.json.file, cyclictest_json(threads, run));
  if (!options.plot.empty()) {
    const std::string machine =
        fmt::format("{} {}{}", run.sysname, run.release, run.realtime_kernel ? " PREEMPT_RT" : "");
    draw(options, *data, fmt::format("{} ticks, {}", data->summary.ticks, machine));
  }
  if (options.limit_us > 0 && static_cast<double>(data->summary.wake.max_ns) > 1e3 * options.limit_us) {
    fmt::print("above the limit: latest wake-up {:.1f} µs, allowed {:g} µs\n",
               1e-3 * static_cast<double>(data->summary.wake.max_ns), options.limit_us);
    return kExitFailed;
  }
  return data->damage.empty() ? kExitOk : kExitFailed;
}

}  // namespace

namespace {

void add_certify_options(CLI::App& command, LatencyOptions& options, CLI::Option* recording, CLI::Option* live) {
  auto* certify =
      command
          .add_option("--certify", options.certify,
                      "run controller and device for this long (1h, 10m, 30s) without force and write a dated "
                      "result with the machine's identity; Ctrl-C keeps what was measured")
          ->excludes(recording)
          ->excludes(live);
  CertifyOptions& c = options.certificate;
  command.add_option("--scene", c.scene, "scene (.toml) or image (.pal) to certify with; default: built in")
      ->needs(certify);
  command.add_option("--path", c.path, "motion of the simulated hand, CSV; default: the scene's own, repeated")
      ->needs(certify);
  command.add_option("--device", c.device, "device to certify with: loopback (simulated), can:IFACE, usb:/dev/hidrawN")
      ->capture_default_str()
      ->needs(certify);
  command.add_option("--profile", c.profile, "of that device, as for palpate run; needed on can: and usb:")
      ->needs(certify);
  command.add_option("--load", options.load, "load made meanwhile: none, or host (memory copies, system calls, files)")
      ->capture_default_str()
      ->check(CLI::IsMember({"none", "host"}))
      ->needs(certify);
  command.add_option("--out", c.out, "prefix of the result files; default: palpate-latency-HOST-DATE")->needs(certify);
}

}  // namespace

void add_latency_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<LatencyOptions>();
  CLI::App* command =
      app.add_subcommand("latency", "Measure wake-up latency, show where a run's time goes or went, certify a machine");
  auto* recording = command->add_option("--recording", options->recording, "recording of `palpate run`");
  auto* live = command
                   ->add_option("--live", options->live,
                                "follow the recording of a run that is still going on; default file: run.plr")
                   ->expected(0, 1)
                   ->excludes(recording);
  command->add_option("--duration", options->measure.duration_s, "how long to measure: seconds, or 10s, 5m, 1h")
      ->capture_default_str()
      ->transform(duration_in(0.01, 604800))
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
  add_json_option(*command, options->json, "write cyclictest's JSON there");
  command->add_option("--plot", options->plot, "draw the histograms to this .svg or .png file")
      ->check(ends_in({".svg", ".png"}));
  command->add_option("--overlay", options->overlay,
                      "histogram text of cyclictest (-h 400 -q) to draw with the wake-up latency; needs --plot");
  command->add_option("--worst", options->worst, "how many of the worst ticks to list with their parts")
      ->capture_default_str()
      ->check(CLI::Range(0, static_cast<int>(kWorstTicksKept)));
  command->add_option("--limit", options->limit_us, "exit with 1 when the latest wake-up exceeds this many µs")
      ->check(above_zero());
  add_certify_options(*command, *options, recording, live);
  command->footer(
      "Without --recording, --live or --certify it sleeps to 1 kHz deadlines as the controller does, and measures how "
      "late it wakes.\n"
      "Examples:\n"
      "  palpate latency --duration 60 --cpu 3 --priority 80 --json latency.json --plot latency.svg\n"
      "  palpate latency --recording run.plr --histfile run.hist --plot run_latency.png\n"
      "  palpate latency --recording run.plr --overlay cyclictest.txt --plot both.svg\n"
      "  palpate latency --live run.plr                       (while `palpate run ... --record run.plr` runs)\n"
      "  palpate latency --certify 1h --cpu 3 --limit 100 --load host\n"
      "docs/latency.md says how each number is made.");
  command->callback([options, live, &exit_code] {
    if (!options->overlay.empty() && options->plot.empty()) throw std::runtime_error("--overlay needs --plot FILE");
    if (live->count() > 0) options->recording = options->live.empty() ? "run.plr" : options->live;
    try {
      exit_code = run_with_json(options->json.wanted(), "latency", [&](Json& json) {
        if (live->count() > 0) return run_live(options->recording, json);
        return options->certify.empty() ? run_latency(*options, json) : run_certify(*options, json);
      });
    } catch (const RecordingError& error) {
      throw std::runtime_error(about_file(options->recording, error.what()));
    }
  });
}

}  // namespace palpate
