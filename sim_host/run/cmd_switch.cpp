// `palpate switch`: another scene, without letting go of the device.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "sim_host/cli.h"
#include "sim_host/json_output.h"
#include "sim_host/run/settings_port.h"

namespace palpate {

void add_switch_command(CLI::App& app, int& exit_code) {
  struct SwitchOptions {
    pid_t host = 0;
    std::string image;
    bool json = false;
  };
  auto options = std::make_shared<SwitchOptions>();
  CLI::App* command = app.add_subcommand("switch", "Go over to another baked scene while a run goes on");
  command->add_option("PID", options->host, "process id of the `palpate run`, or of its palpate-rt")
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("IMAGE", options->image, "baked scene (.pal), for the same device and period")
      ->required()
      ->check(CLI::ExistingFile);
  add_json_flag(*command, options->json);
  command->footer(
      "The image is checked first, and refused with the reason where it does not fit; then force ramps to zero, the\n"
      "scenes are exchanged, and force comes back as after a start. The recording goes on in NAME.scene-2.plr\n"
      "(docs/live_settings.md).\n"
      "Example:\n"
      "  palpate switch $(pgrep -x palpate) liver.pal");
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "switch", [&](Json& json) {
      const std::string image = std::filesystem::absolute(options->image).string();
      json["image"] = image;
      fmt::print("{}\n", ask_run(options->host, kSceneWord + image));
      return kExitOk;
    });
  });
}

}  // namespace palpate
