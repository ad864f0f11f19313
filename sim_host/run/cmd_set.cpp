// `palpate set`: changes a run that goes on.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "sim_host/cli.h"
#include "sim_host/json_output.h"
#include "sim_host/run/settings_port.h"

namespace palpate {

void add_set_command(CLI::App& app, int& exit_code) {
  struct SetOptions {
    pid_t host = 0;
    std::vector<std::string> words;
    bool json = false;
  };
  auto options = std::make_shared<SetOptions>();
  CLI::App* command = app.add_subcommand("set", "Change stiffness, friction or limits of a run while it goes on");
  command->add_option("PID", options->host, "process id of the `palpate run` or `palpate view`, or of its palpate-rt")
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("SETTING", options->words, "NAME=FACTOR, of what was baked; none: tell what is set");
  add_json_flag(*command, options->json);
  command->footer("Settings:\n" + settings_help() +
                  "The tick follows in steps that move the force by less than 1 % of the device's largest. What was\n"
                  "asked for is recorded with every tick, and replays bit for bit.\n"
                  "Examples:\n"
                  "  palpate set $(pgrep -x palpate) stiffness=0.5 friction=0\n"
                  "  palpate set $(pgrep -x palpate-rt)");
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "set", [&](Json& json) {
      std::string words;
      for (const std::string& word : options->words) words += (words.empty() ? "" : " ") + word;
      const std::string answer = ask_run(options->host, words);
      fmt::print("{}\n", answer);
      LiveSettings now;
      apply_settings(answer, now);
#define PALPATE_FIELD(name, lowest, highest, key, meaning) json[#name] = Json::parse(fmt::format("{:g}", now.name));
      PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
      return kExitOk;
    });
  });
}

}  // namespace palpate
