// `palpate recover`: makes a recording of what a killed run left behind.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "sim_host/cli.h"
#include "sim_host/json_output.h"
#include "sim_host/record/recover.h"

namespace palpate {

namespace {

struct RecoverOptions {
  std::string part, output;
  bool json = false;
};

int run_recover(const RecoverOptions& options, Json& json) {
  const Recovered result = recover_recording(options.part, options.output);
  json.update({{"record", result.path},
               {"ticks", result.records},
               {"crash_file_ticks", result.from_crash},
               {"lost_records", result.lost},
               {"damage", result.damage}});
  fmt::print("recovered {} ticks -> {}\n", result.records, result.path);
  if (result.from_crash > 0) {
    fmt::print("  the last {} of them from {}, which the controller wrote after its host had died\n", result.from_crash,
               result.crash_path);
  }
  if (result.lost > 0) fmt::print("  {} records before the end were lost\n", result.lost);
  if (!result.damage.empty()) fmt::print("  the file ended: {}\n", result.damage);
  return kExitOk;
}

}  // namespace

void add_recover_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RecoverOptions>();
  CLI::App* command = app.add_subcommand("recover", "Make a recording of what a killed run left behind");
  command->add_option("PART", options->part, "RECORD.part of a run that did not end in order")->required();
  command->add_option("-o,--output", options->output, "recording to make; default: the name without .part");
  command->footer(
      "While a run lasts its recording is RECORD.part. When the run is killed it stays, whole up to the last 20 ms; "
      "its\n"
      "controller notices and writes the rest, down to zero force, to RECORD.crash.plr. This joins both.\n"
      "Example:\n"
      "  palpate recover run.plr.part && palpate replay run.plr");
  add_json_flag(*command, options->json);
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "recover", [&](Json& json) { return run_recover(*options, json); });
  });
}

}  // namespace palpate
