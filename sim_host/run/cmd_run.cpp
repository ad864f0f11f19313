// `palpate run`: feel (or let a simulated hand feel) a scene.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/doctor/doctor.h"
#include "sim_host/overlay_options.h"
#include "sim_host/run/run_json.h"
#include "sim_host/run/run_session.h"

namespace palpate {

namespace {

struct RunCommand {
  RunOptions run;
  bool no_record = false, no_black_box = false, live = false, virtual_time = false, real_time = false, json = false;
  int worst = 3;
  CLI::Option* record_option = nullptr;
  VerdictLimits limits;
};

// One line about the real-time checklist, when something on it fails.
void print_hint(const RunOptions& options) {
  const std::string failing = failing_items(examine_machine_and_device(options.cpu, options.priority, options.device));
  if (failing.empty()) return;
  fmt::print(stderr,
             "hint: late ticks are likely under load, these checks fail: {}; `palpate doctor` says what to do\n",
             failing);
}

void print_black_box(const RunResult& result) {
  for (const BlackBoxDump& dump : result.dumps) {
    fmt::print("fault   {} at record {}\n        {} ({} ticks, {})\n        {} (their frames, re-encoded)\n",
               dump.cause, dump.sequence, dump.recording, dump.ticks,
               dump.replayable ? "palpate replay verifies it" : "can be listed, not replayed", dump.log);
  }
  if (!result.black_box_error.empty()) {
    fmt::print(stderr, "palpate: black box incomplete: {}\n", result.black_box_error);
  }
}

void fill(Json& json, const RunOptions& options, const RunResult& result, const std::vector<RunVerdict>& verdicts) {
  json["scene"] = options.scene;
  json["virtual_time"] = result.virtual_time;
  json.update(summary_json(result.summary, result.lost));
  json["grasp"] = result.grasp;
  json["record"] = options.record.empty() || !result.recorder_error.empty() ? Json(nullptr) : Json(options.record);
  json["interrupted"] = result.interrupted;
  json["controller_exit_code"] = result.controller_exit;
  json["verdicts"] = verdicts_json(verdicts);
  json["black_boxes"] = Json::array();
  for (const BlackBoxDump& dump : result.dumps)
    json["black_boxes"].push_back({{"cause", dump.cause},
                                   {"recording", dump.recording},
                                   {"log", dump.log},
                                   {"ticks", dump.ticks},
                                   {"replayable", dump.replayable}});
}

void settle_time(RunCommand& command) {
  RunOptions& options = command.run;
  if (command.real_time) options.time = RunTime::kReal;
  if (!command.virtual_time) return;
  options.time = RunTime::kVirtual;
  // Virtual time is asked for: then "auto" is the simulated device, also beside a CAN interface.
  if (options.device.starts_with("auto")) options.device.replace(0, 4, "loopback");
}

int run(RunCommand& command, Json& json) {
  RunOptions& options = command.run;
  if (command.record_option->count() == 0) options.record = free_name(options.record);
  if (command.no_record) options.record.clear();
  if (!command.no_black_box) {
    options.black_box =
        options.record.empty() ? "palpate" : std::filesystem::path(options.record).replace_extension().string();
  }
  LivePrinter printer;
  if (command.live) options.progress = [&](const LiveState& state) { printer.print(live_text(state)); };
  if (settle_time(command); !options.quiet && !runs_in_virtual_time(options)) {
    options.before_start = [&] { print_hint(options); };
  }
  const RunResult result = run_session(options);
  if (result.summary.ticks > 0)
    fmt::print("{}{}", summary_text(result.summary, result.lost, command.worst), result.grasp);
  if (result.summary.ticks == 0) {
    fmt::print("nothing ran, nothing was recorded\n");
  } else if (!options.record.empty() && result.recorder_error.empty()) {
    fmt::print("record  {} ({}{} ticks){}\n", options.record, result.later_recordings.empty() ? "" : "begins a run of ",
               result.summary.ticks, result.interrupted ? ", stopped by signal" : "");
  }
  for (const std::string& recording : result.later_recordings)
    fmt::print("record  {} (the run went over to it)\n", recording);
  print_black_box(result);
  if (!result.recorder_error.empty()) {
    fmt::print(stderr, "palpate: recording incomplete: {}\n         `palpate recover {}{}` keeps what is there\n",
               result.recorder_error, options.record, kPartSuffix);
  }
  if (result.device_died) fmt::print(stderr, "palpate: the simulated device was killed or ended by itself\n");
  if (result.controller_exit != 0) {
    fmt::print(stderr, "palpate: the controller ended with exit code {}\n", result.controller_exit);
  }
  const std::vector<RunVerdict> verdicts =
      judge(result.summary, {result.lost, options.arm, result.interrupted}, command.limits);
  fill(json, options, result, verdicts);
  if (result.summary.ticks > 0) fmt::print("{}", verdict_text(verdicts));
  return exit_code_of(result, verdicts);
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  auto settings = std::make_shared<RunCommand>();
  RunOptions* options = &settings->run;
  CLI::App* command = app.add_subcommand("run", "Render a scene at its full rate on a device or on the simulated hand");
  command->add_option("SCENE", options->scene, "scene (.toml, baked first) or image (.pal)")->required();
  add_overlay_options(*command, options->overlays);
  command
      ->add_option("--device", options->device,
                   "auto, loopback (simulated device and hand), can:IFACE or usb:/dev/hidrawN")
      ->capture_default_str();
  command->add_option("--profile", options->profile,
                      "what the device can do (config/devices/*.toml; docs/devices.md): needed on can: and usb:; the "
                      "simulated device of a .toml scene becomes like it");
  command->add_option("--duration", options->duration_s, "seconds, or 10s, 5m, 1h")
      ->capture_default_str()
      ->transform(duration_in(0.1, 86400));
  CLI::Option* virtual_time =
      command->add_flag("--virtual-time", settings->virtual_time,
                        "controller, simulated device and hand in lock step: as fast as the machine can, the same bits "
                        "every time; default when the simulated device is used without being named");
  command
      ->add_flag("--real-time", settings->real_time,
                 "the simulated device in real time; default with --device loopback")
      ->excludes(virtual_time);
  command->add_flag("--pace", options->pace, "virtual time no faster than real time");
  settings->record_option = command->add_option("--record", options->record,
                                                "recording to write; refused when it exists; default: run.plr, or "
                                                "run-2.plr, run-3.plr ... when that exists");
  command->add_flag("--overwrite", options->overwrite,
                    "replace the recording of that name once the new one is complete");
  command->add_option(
      "--telemetry", options->telemetry,
      "socket on which programs of the same user may come and read every tick while it is made, as many "
      "as like (docs/record_format.md)");
  command->add_flag("--no-record", settings->no_record, "write no recording");
  command->add_option("--path", options->path,
                      "motion of the simulated hand, CSV: time_s,x_mm,y_mm,z_mm[,rx_deg,ry_deg,rz_deg]; default: the "
                      "scene's own");
  command->add_option("--second-device", options->second_device,
                      "device.holds = \"both\": device of the hand that holds the body; default: a simulated one");
  command->add_option("--second-path", options->second_path,
                      "motion of the simulated hand at the body, CSV as --path; default: it holds the body still");
  add_joint_options(*command, options->joints);
  command->add_option("--image", options->image,
                      "where to write the image of a .toml scene; default: beside the recording");
  command->add_option("--cpu", options->cpu, "CPU of the real-time thread")->check(CLI::Range(-1, 1023));
  command->add_option("--priority", options->priority, "SCHED_FIFO priority of the real-time thread; 0: none")
      ->capture_default_str()
      ->check(CLI::Range(0, 98));
  command->add_flag("--allow-no-rt", options->allow_no_rt,
                    "drive a device on can: or usb: although real-time rights were refused");
  command->add_flag("--quiet", options->quiet, "no live status line, no hint about the machine");
  command->add_flag("--live", settings->live, "a table of the times of every stage, refreshed each second");
  command->add_option("--worst", settings->worst, "how many of the worst ticks to list at the end, with their parts")
      ->capture_default_str()
      ->check(CLI::Range(0, static_cast<int>(kWorstTicksKept)));
  add_allow_option(*command, settings->limits, {"stale", "unconverged", "clamped", "armed", "lost", "work"});
  command->add_flag("--no-black-box", settings->no_black_box,
                    "do not write the last seconds (RECORD.fault-N.plr and .log) when a fault latches");
  command->footer(
      "Ctrl-C ramps the force to zero and leaves a complete recording. Exits with 0 only when the hand felt what the "
      "scene\n"
      "says (verdicts and exit codes: docs/exit_codes.md), with 5 when a fault was latched; the last seconds before "
      "it\n"
      "are then in RECORD.fault-1.plr (see palpate replay) and, as CAN frames encoded again from\n"
      "it, in RECORD.fault-1.log (candump -L format: canplayer vcan0=palpate0 -I RECORD.fault-1.log).\n"
      "Examples:\n"
      "  palpate run config/scenes/ellipsoid_mallet.toml --duration 10 --record run.plr\n"
      "  palpate run mallet.pal --device can:can0 --profile arm.toml --cpu 3 --priority 80 --no-record\n"
      "  palpate run mallet.pal --path hand.csv --live --worst 16\n"
      "  palpate run config/scenes/grasp_cylinder_5.toml --close 0.7 --joint index_tip_flexion=20");
  add_json_flag(*command, settings->json);
  command->callback([settings, &exit_code] {
    exit_code = run_with_json(settings->json, "run", [&](Json& json) { return run(*settings, json); });
  });
}

}  // namespace palpate
