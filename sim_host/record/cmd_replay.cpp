// `palpate replay`: runs a recording again and says whether every bit came out the same.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <memory>

#include "sim_host/build_id.h"
#include "sim_host/cli.h"
#include "sim_host/press/grasp_watch.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/record_csv.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/replay.h"
#include "sim_host/record/state_dump.h"

namespace palpate {

namespace {

struct ReplayOptions {
  std::string recording, image, dump;
  std::int64_t state = -1;  // tick after which to print the state
};

int report(const ReplayResult& result) {
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
int list_only(RecordingReader& recording, RecordCsv* csv) {
  TickRecord record;
  while (recording.next(record)) {
    if (csv != nullptr) csv->add(record);
  }
  fmt::print("listed: {} ticks from number {} on; not verified, the state before them is unknown\n{}",
             recording.records(), recording.first_sequence(),
             recording.error().empty() ? "" : "damaged recording: " + recording.error() + "\n");
  return kExitFailed;
}

int print_state(RecordingReader& recording, const Model& model, std::int64_t tick) {
  const StatePtr state = state_after(recording, model, static_cast<std::uint64_t>(tick));
  for (const auto& [name, value] : list_state(*state)) fmt::print("{:<44} {}\n", name, value);
  return kExitOk;
}

int run_replay(const ReplayOptions& options) {
  const MappedFile file(options.recording);
  RecordingReader recording(file.bytes());
  const RecordingHeader& header = recording.header();
  std::unique_ptr<RecordCsv> csv;
  if (!options.dump.empty()) csv = std::make_unique<RecordCsv>(options.dump);
  if (!recording.state_known()) return list_only(recording, csv.get());
  const RecordedScene scene(recording, options.image);
  if (options.state >= 0) return print_state(recording, scene.model(), options.state);
  if (std::strcmp(header.build_id, kBuildId) != 0) {
    fmt::print("recorded by another build, verifying all the same\n  recorded {}\n  this one {}\n", header.build_id,
               kBuildId);
  }
  GraspWatch grasp(scene.model());
  const int exit_code = report(replay(recording, scene.model(), [&](const TickRecord& recorded, const TickRecord&) {
    if (csv) csv->add(recorded);
    grasp.take(recorded);
  }));
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
  command->add_option("--dump", options->dump, "write one row per recorded tick to this CSV file");
  command->add_option("--state", options->state, "print every field of the state after this tick, and nothing else")
      ->check(CLI::NonNegativeNumber);
  command->footer(
      "Prints `identical: N ticks` and exits with 0, or names the first tick, stage and field that differ and exits\n"
      "with 1. A damaged or incomplete recording is verified as far as it goes, and exits with 1. Black boxes\n"
      "(RECORD.fault-N.plr) are slices of a run: they replay from the state before their first tick.\n"
      "Examples:\n"
      "  palpate replay run.plr\n"
      "  palpate replay run.plr --image mallet.pal --dump run.csv");
  command->callback([options, &exit_code] {
    try {
      exit_code = run_replay(*options);
    } catch (const std::exception& error) {
      throw std::runtime_error(about_file(options->recording, error.what()));
    }
  });
}

}  // namespace palpate
