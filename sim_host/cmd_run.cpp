// `palpate run`: feel (or let a simulated hand feel) a scene.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "sim_host/cli.h"
#include "sim_host/run_session.h"

namespace palpate {

namespace {

int run(const RunOptions& options) {
  const RunResult result = run_session(options);
  fmt::print("{}", summary_text(result.summary, result.lost));
  if (!options.record.empty() && result.recorder_error.empty()) {
    fmt::print("record  {} ({} ticks){}\n", options.record, result.summary.ticks,
               result.interrupted ? ", stopped by signal" : "");
  }
  if (!result.recorder_error.empty()) fmt::print(stderr, "palpate: recording incomplete: {}\n", result.recorder_error);
  if (result.controller_exit != 0) {
    fmt::print(stderr, "palpate: the controller ended with exit code {}\n", result.controller_exit);
  }
  return result.faulted() || result.controller_exit != 0 || !result.recorder_error.empty() ? kExitFailed : kExitOk;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  auto no_record = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("run", "Render a scene at its full rate on a device or on the simulated hand");
  command->add_option("SCENE", options->scene, "scene (.toml, baked first) or image (.pal)")->required();
  command->add_option("--device", options->device, "auto, loopback (simulated device and hand) or can:IFACE")
      ->capture_default_str();
  command->add_option("--duration", options->duration_s, "seconds")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 86400.0));
  command->add_option("--record", options->record, "recording to write")->capture_default_str();
  command->add_flag("--no-record", *no_record, "write no recording");
  command->add_option("--path", options->path,
                      "motion of the simulated hand, CSV: time_s,x_mm,y_mm,z_mm[,rx_deg,ry_deg,rz_deg]; default: the "
                      "scene's own");
  command->add_option("--image", options->image,
                      "where to write the image of a .toml scene; default: beside the recording");
  command->add_option("--cpu", options->cpu, "CPU of the real-time thread")->check(CLI::Range(-1, 1023));
  command->add_option("--priority", options->priority, "SCHED_FIFO priority of the real-time thread; 0: none")
      ->capture_default_str()
      ->check(CLI::Range(0, 98));
  command->add_flag("--quiet", options->quiet, "no live status line");
  command->footer(
      "Ctrl-C ramps the force to zero and leaves a complete recording. Exits with 1 when a fault was latched.\n"
      "Examples:\n"
      "  palpate run config/scenes/ellipsoid_mallet.toml --duration 10 --record run.plr\n"
      "  palpate run mallet.pal --device can:can0 --cpu 3 --priority 80 --no-record");
  command->callback([options, no_record, &exit_code] {
    if (*no_record) options->record.clear();
    exit_code = run(*options);
  });
}

}  // namespace palpate
