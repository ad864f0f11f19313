// `palpate replay`: runs a recording again and says whether every bit came out the same.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <memory>

#include "hal/bus/wire_table.h"
#include "sim_host/build_id.h"
#include "sim_host/cli.h"
#include "sim_host/json_output.h"
#include "sim_host/press/grasp_watch.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recording_exports.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/replay.h"
#include "sim_host/record/state_dump.h"
#include "sim_host/view/vtu.h"

namespace palpate {

namespace {

struct ReplayOptions {
  std::string recording, image, vtu;
  int every = 20;
  ExportOptions exports;
  std::int64_t state = -1;  // tick after which to print the state
  bool json = false;
};

int report(const ReplayResult& result, Json& json) {
  json.update({{"verified", true},
               {"identical", result.identical()},
               {"identical_ticks", result.ticks},
               {"lost_records", result.lost},
               {"damage", result.damage}});
  if (result.differs)
    json["difference"] = {{"tick", result.tick},
                          {"stage", result.stage},
                          {"field", result.field},
                          {"recorded", result.recorded},
                          {"replayed", result.replayed}};
  if (result.differs) {
    fmt::print(
        "differs at tick {}, stage {}, field {}\n  recorded {}\n  replayed {}\n  {} ticks before it are identical\n",
        result.tick, result.stage, result.field, result.recorded, result.replayed, result.ticks);
  } else if (!result.damage.empty()) {
    fmt::print("damaged recording: {}\n  {} ticks before that are identical\n", result.damage, result.ticks);
  } else if (result.lost > 0) {
    fmt::print("incomplete recording: {} records are missing after tick {}; {} ticks before that are identical\n",
               result.lost, result.ticks, result.ticks);
  } else {
    fmt::print("identical: {} ticks\n", result.ticks);
  }
  return result.identical() ? kExitOk : kExitFailed;
}

// A slice without its initial state: its ticks can be shown, but nothing verified.
int list_only(RecordingReader& recording, RecordingExports& exports, Json& json) {
  TickRecord record;
  while (recording.next(record)) exports.add(record);
  exports.finish();
  json.update({{"verified", false},
               {"listed_ticks", recording.records()},
               {"first_tick", recording.first_sequence()},
               {"damage", recording.error()}});
  fmt::print("listed: {} ticks from number {} on; not verified, the state before them is unknown\n{}",
             recording.records(), recording.first_sequence(),
             recording.error().empty() ? "" : "damaged recording: " + recording.error() + "\n");
  return kExitFailed;
}

int print_state(RecordingReader& recording, const Model& model, std::int64_t tick, Json& json) {
  json["tick"] = tick;
  const StatePtr state = state_after(recording, model, static_cast<std::uint64_t>(tick));
  for (const auto& [name, value] : list_state(*state)) {
    json["state"][name] = value;
    fmt::print("{:<44} {}\n", name, value);
  }
  return kExitOk;
}

// Deformed surface, anchors and regions of every Nth tick, as far as the replay was the same.
void write_surfaces(const ReplayOptions& options, const MappedFile& file, const Model& model, std::uint64_t ticks,
                    Json& json) {
  RecordingReader recording(file.bytes());
  const double period_s = 1e-9 * static_cast<double>(recording.header().period_ns);
  VtuSeries series(options.vtu);
  std::uint64_t done = 0;
  for_each_state(recording, model, [&](const TickRecord& record, const State& state) {
    if (done == ticks) return false;
    if (done++ % static_cast<std::uint64_t>(options.every) == 0)
      series.add(model, state, record, period_s * static_cast<double>(record.tick));
    return true;
  });
  series.finish();
  json["vtu"] = {{"folder", options.vtu}, {"ticks", series.size()}};
  fmt::print("wrote   {}: surface.pvd, anchors.pvd, regions.pvd of {} ticks\n", options.vtu, series.size());
}

int run_replay(const ReplayOptions& options, Json& json) {
  json["recording"] = options.recording;
  const MappedFile file(options.recording);
  RecordingReader recording(file.bytes());
  const RecordingHeader& header = recording.header();
  ExportOptions wanted = options.exports;
  wanted.period_ns = header.period_ns;
  RecordingExports exports(wanted);
  if (!recording.state_known()) return list_only(recording, exports, json);
  const RecordedScene scene(recording, options.image);
  if (options.state >= 0) return print_state(recording, scene.model(), options.state, json);
  if (std::strcmp(header.build_id, kBuildId) != 0) {
    fmt::print("recorded by another build, verifying all the same\n  recorded {}\n  this one {}\n", header.build_id,
               kBuildId);
  }
  GraspWatch grasp(scene.model());
  const ReplayResult result = replay(recording, scene.model(), [&](const TickRecord& recorded, const TickRecord&) {
    exports.add(recorded);
    grasp.take(recorded);
  });
  const int exit_code = report(result, json);
  exports.finish();
  if (!options.vtu.empty()) write_surfaces(options, file, scene.model(), result.ticks, json);
  json["grasp"] = grasp.text();
  fmt::print("{}", grasp.text());
  return exit_code;
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "Run a recording again and compare every tick, bit for bit");
  command->add_option("RECORDING", options->recording, "recording (.plr), written by `palpate run`")->required();
  command->add_option("--image", options->image,
                      "scene image to use; default: the one the recording names, or the one inside it");
  ExportOptions& exports = options->exports;
  command->add_option("--dump", exports.ticks,
                      "write one row per recorded tick to this CSV file, every field (docs/record_format.md)");
  command->add_option("--dump-regions", exports.regions,
                      "write one row per contact region of every tick to this CSV file");
  command->add_option("--npz", exports.npz,
                      "write ticks, regions and period_ns as NumPy arrays to this file, every field (numpy.load)");
  command->add_option("--vtu", options->vtu,
                      "write deformed surfaces, anchors and the regions' forces for ParaView into this folder");
  command->add_option("--every", options->every, "with --vtu: write only every Nth tick")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000000));
  command->add_option(
      "--candump", exports.candump,
      "write the traffic as `candump -L` writes it, encoded again from the recording, as if the handle's "
      "frame were the world's");
  command->add_flag("--classic", exports.classic, "with --candump: frames of classic CAN instead of CAN FD");
  command->add_option("--node", exports.node, "with --candump: node number")
      ->capture_default_str()
      ->check(CLI::Range(1, wire::kMaxNode));
  command->add_option("--state", options->state, "print every field of the state after this tick, and nothing else")
      ->check(CLI::NonNegativeNumber);
  command->footer(
      "Prints `identical: N ticks` and exits with 0, or names the first tick, stage and field that differ and exits\n"
      "with 1. A damaged or incomplete recording is verified as far as it goes, and exits with 1. Black boxes\n"
      "(RECORD.fault-N.plr) are slices of a run: they replay from the state before their first tick.\n"
      "Examples:\n"
      "  palpate replay run.plr\n"
      "  palpate replay run.plr --image mallet.pal --dump run.csv --dump-regions regions.csv\n"
      "  palpate replay run.plr --npz run.npz --vtu surface --every 100\n"
      "  palpate replay run.plr --candump run.log        canplayer vcan0=palpate0 -I run.log");
  add_json_flag(*command, options->json);
  command->callback([options, &exit_code] {
    try {
      exit_code = run_with_json(options->json, "replay", [&](Json& json) { return run_replay(*options, json); });
    } catch (const std::exception& error) {
      throw std::runtime_error(about_file(options->recording, error.what()));
    }
  });
}

}  // namespace palpate
